#include "recordings/internal/whole_writer.h"

#include "recordings/internal/field_codec.h"
#include "recordings/internal/tick_codec.h"

namespace ctpm::recordings::session_file {
namespace {
constexpr int level = 3;  // zstd
}

Result<WholeWriter> WholeWriter::create(const std::string& path, const SessionStart& start,
                                        const SessionIdentity& identity) {
  if (auto r = create_session_file(path, start, identity, false, level); !r) return r.errors();
  auto tables = SessionTables::open_for_writing(path);
  if (!tables) return tables.errors();
  if (auto r = tables->begin(); !r) return r.errors();
  return WholeWriter(std::move(*tables), identity.seed, start.model.hands);
}

Result<Done> WholeWriter::add_ticks(const std::vector<TickRecord>& records) {
  const auto count = static_cast<std::int64_t>(records.size());
  Bytes content;
  put_records(content, records, hands_);
  auto written = tables_.insert_chunk(next_, count, pack(chunk_name(next_, count), content, seed_, level));
  for (const TickRecord& record : records) counter_.add(record);
  next_ += count;
  return written;
}

Result<Done> WholeWriter::add_keyframe(const Keyframe& keyframe) {
  Bytes content;
  put_fields(content, keyframe.state);
  counter_.add_keyframe();
  return tables_.insert_keyframe(keyframe.tick, pack(keyframe_name(keyframe.tick), content, seed_, level));
}

Result<Done> WholeWriter::add_events(const std::vector<Event>& events) {
  if (events.empty()) return Done{};
  Bytes content;
  put_field_set(content, [&](FieldWriter& writer) { writer("events", events); });
  const auto count = static_cast<std::int64_t>(events.size());
  for (const Event& event : events) counter_.add(event);
  return tables_.insert_events(0, count, pack(event_name(0, count), content, seed_, level));
}

Result<Done> WholeWriter::add_end(const std::vector<NamedValue>& values) {
  SessionStatistics statistics = counter_.result();
  statistics.values = values;
  Bytes content;
  put_finish(content, statistics);
  return tables_.insert_part("finish", pack(part_name("finish"), content, seed_, level));
}

Result<Done> WholeWriter::close() {
  if (auto r = tables_.commit(); !r) return r;
  return tables_.close();
}

}  // namespace ctpm::recordings::session_file
