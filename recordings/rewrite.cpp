#include "recordings/rewrite.h"

#include <algorithm>
#include <filesystem>

#include "recordings/internal/whole_writer.h"

namespace ctpm::recordings {

using namespace session_file;

namespace {

constexpr std::int64_t chunk_ticks = 100;

Result<Done> write_all(SessionReader& session, const std::string& path, const RewrittenSession& as) {
  SessionIdentity identity = new_identity(as.start);
  identity.id = as.id, identity.created_unix_s = as.created_unix_s;
  auto writer = WholeWriter::create(path, as.start, identity);
  if (!writer) return writer.errors();
  for (std::int64_t next = 0; next < session.tick_count(); next += chunk_ticks) {
    const auto records = session.ticks(next, std::min(next + chunk_ticks, session.tick_count()));
    if (!records) return records.errors();
    if (auto r = writer->add_ticks(*records); !r) return r;
  }
  const auto ticks = session.keyframe_ticks();
  if (!ticks) return ticks.errors();
  for (const std::int64_t tick : *ticks) {
    if (tick == 0) continue;
    const auto keyframe = session.keyframe_at_or_before(tick);
    if (!keyframe) return keyframe.errors();
    if (auto r = writer->add_keyframe(*keyframe); !r) return r;
  }
  auto events = session.events();
  if (!events) return events.errors();
  if (as.change_event)
    for (Event& event : *events) as.change_event(event);
  if (auto r = writer->add_events(*events); !r) return r;
  if (session.ended_cleanly()) {
    const auto statistics = session.statistics();
    if (!statistics) return statistics.errors();
    if (auto r = writer->add_end(as.keeps_values ? statistics->values : std::vector<NamedValue>()); !r) return r;
  }
  return writer->close();
}

/// Reads the new file back: every block, and every tick beside that of the old one.
Result<Done> check_same(SessionReader& session, const std::string& path) {
  auto written = SessionReader::open(path);
  if (!written) return written.errors();
  if (auto r = written->check_all(); !r) return r;
  for (std::int64_t next = 0; next < session.tick_count(); next += chunk_ticks) {
    const std::int64_t end = std::min(next + chunk_ticks, session.tick_count());
    const auto before = session.ticks(next, end), after = written->ticks(next, end);
    if (!before) return before.errors();
    if (!after) return after.errors();
    if (*before != *after) return Error{path, "was not written as it was read", ""};
  }
  return Done{};
}

}  // namespace

Result<Done> rewrite_session(SessionReader& session, const std::string& out, const RewrittenSession& as) {
  if (auto r = session.check_all(); !r) return r;
  std::error_code failure;
  if (std::filesystem::exists(out, failure)) return Error{out, "exists already", "choose another name"};
  const std::string unfinished = out + ".unfinished";
  remove_with_companions(unfinished);
  Result<Done> done = write_all(session, unfinished, as);
  if (done) done = check_same(session, unfinished);
  if (done) {
    std::filesystem::rename(unfinished, out, failure);
    if (!failure) return done;
    done = Error{out, "cannot be created: " + failure.message(), ""};
  }
  remove_with_companions(unfinished);
  Errors errors = done.errors();
  for (Error& error : errors)
    if (error.where == unfinished) error.where = out;
  return errors;
}

}  // namespace ctpm::recordings
