#include "recordings/session_reader.h"

#include <limits>

#include "core/model/errors.h"
#include "recordings/internal/session_check.h"
#include "recordings/internal/session_store.h"
#include "recordings/internal/statistics.h"

namespace ctpm::recordings {

using namespace session_file;

namespace {
constexpr std::int64_t last_key = std::numeric_limits<std::int64_t>::max();
}

struct SessionReader::Impl {
  std::string path;
  SessionStore store;
  SessionStart start;
  std::vector<std::string> remarks;
  std::int64_t tick_count = 0, event_count = 0;
  std::optional<SessionStatistics> finish;
  Run<TickRecord> cached;  ///< the last chunk read

  Error error(const std::string& message) const { return {path, message, ""}; }
  Result<Done> read_start();
  Result<Done> read_ends();
  Result<Done> load_chunk(std::int64_t tick);
};

SessionReader::SessionReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader& SessionReader::operator=(SessionReader&&) noexcept = default;
SessionReader::~SessionReader() = default;

Result<SessionReader> SessionReader::open(const std::string& path) {
  auto store = SessionStore::open(path, false);
  if (!store) return store.errors();
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->store = std::move(*store);
  if (auto r = impl->read_start(); !r) return r.errors();
  if (auto r = impl->read_ends(); !r) return r.errors();
  impl->remarks = impl->store.remarks();
  if (impl->store.lacks_log() && !impl->finish)
    impl->remarks.push_back("has no clean end, and its log " + path +
                            "-wal is not beside it: the ticks in it are missing");
  return SessionReader(std::move(impl));
}

/// Reports all damaged parts together.
Result<Done> SessionReader::Impl::read_start() {
  Errors errors;
  const auto take = [&](auto result, auto& place) {
    if (result)
      place = std::move(*result);
    else
      append(errors, result);
  };
  take(store.scene(), start.scene_text);
  take(store.look(), start.look);
  take(store.metadata(), start.metadata);
  take(store.finish(), finish);
  start.build_fingerprint = store.identity().build;
  start.physics_revision = store.identity().physics_revision;
  Done columns;
  take(store.read_columns(), columns);
  const std::size_t before_model = errors.size();
  take(store.model(), start.model);
  if (errors.size() == before_model) {
    take(store.surfaces(start.model), start.model.surfaces);
    std::optional<Keyframe> first;
    const std::size_t before_state = errors.size();
    take(store.keyframe_at(0, start.model), first);
    if (first)
      start.initial_state = std::move(first->state);
    else if (errors.size() == before_state)
      errors.push_back(error("keyframe 0: is missing"));
  }
  if (!errors.empty()) return errors;
  return Done{};
}

/// Finds the end of the session from its last chunk and last events. A clean end must agree.
Result<Done> SessionReader::Impl::read_ends() {
  auto last_chunk = store.chunk_at(last_key);
  if (!last_chunk) return last_chunk.errors();
  if (*last_chunk) tick_count = (*last_chunk)->end(), cached = std::move(**last_chunk);
  const auto last_events = store.events_at(last_key);
  if (!last_events) return last_events.errors();
  if (*last_events) event_count = (*last_events)->end();
  if (static_cast<std::uint64_t>(event_count) > store.memory_limit() / sizeof(Event))
    return error("has more events than its size explains");
  if (!finish) return Done{};
  if (finish->ticks != tick_count)
    return error("is cut short: " + std::to_string(tick_count) + " of " + std::to_string(finish->ticks) +
                 " ticks are left");
  if (finish->events != event_count)
    return error("is cut short: " + std::to_string(event_count) + " of " + std::to_string(finish->events) +
                 " events are left");
  return Done{};
}

const std::string& SessionReader::path() const { return impl_->path; }
const SessionStart& SessionReader::start() const { return impl_->start; }
const std::string& SessionReader::session_id() const { return impl_->store.identity().id; }
double SessionReader::created_unix_s() const { return impl_->store.identity().created_unix_s; }
int SessionReader::format_version() const { return impl_->store.version(); }
const std::vector<std::string>& SessionReader::remarks() const { return impl_->remarks; }
std::int64_t SessionReader::tick_count() const { return impl_->tick_count; }
bool SessionReader::ended_cleanly() const { return impl_->finish.has_value(); }

/// Loads the chunk that holds `tick` into `cached`.
Result<Done> SessionReader::Impl::load_chunk(std::int64_t tick) {
  if (tick >= cached.first && tick < cached.end()) return Done{};
  auto chunk = store.chunk_at(tick);
  if (!chunk) return chunk.errors();
  if (!*chunk || (*chunk)->end() <= tick) return error("the chunk of tick " + std::to_string(tick) + " is missing");
  cached = std::move(**chunk);
  return Done{};
}

Result<std::vector<TickRecord>> SessionReader::ticks(std::int64_t from, std::int64_t to) {
  if (from < 0 || to < from || to > tick_count())
    return impl_->error("ticks " + std::to_string(from) + " to " + std::to_string(to) + " are asked for, it has " +
                        std::to_string(tick_count()));
  std::vector<TickRecord> records;
  for (std::int64_t tick = from; tick < to;) {
    if (auto r = impl_->load_chunk(tick); !r) return r.errors();
    const Run<TickRecord>& chunk = impl_->cached;
    const std::int64_t end = std::min(to, chunk.end());
    records.insert(records.end(), chunk.items.begin() + (tick - chunk.first),
                   chunk.items.begin() + (end - chunk.first));
    tick = end;
  }
  return records;
}

Result<Keyframe> SessionReader::keyframe_at_or_before(std::int64_t tick) {
  if (tick <= 0) return Keyframe{0, impl_->start.initial_state};
  auto keyframe = impl_->store.keyframe_at(tick, impl_->start.model);
  if (!keyframe) return keyframe.errors();
  if (!*keyframe) return impl_->error("keyframe 0: is missing");
  return std::move(**keyframe);
}

Result<std::vector<std::int64_t>> SessionReader::keyframe_ticks() { return impl_->store.keys("keyframe"); }

Result<std::vector<Event>> SessionReader::events() {
  std::vector<Event> events;
  while (static_cast<std::int64_t>(events.size()) < impl_->event_count) {
    const auto next = static_cast<std::int64_t>(events.size());
    auto run = impl_->store.events_at(next);
    if (!run) return run.errors();
    if (!*run || (*run)->first != next) return impl_->error("the run of event " + std::to_string(next) + " is missing");
    for (Event& event : (*run)->items) events.push_back(std::move(event));
  }
  return events;
}

Result<SessionStatistics> SessionReader::statistics() {
  if (impl_->finish) return *impl_->finish;
  StatisticsCounter counter;
  for (std::int64_t tick = 0; tick < tick_count(); tick = impl_->cached.end()) {
    if (auto r = impl_->load_chunk(tick); !r) return r.errors();
    for (const TickRecord& record : impl_->cached.items) counter.add(record);
  }
  const auto all_events = events();
  if (!all_events) return all_events.errors();
  for (const Event& event : *all_events) counter.add(event);
  const auto keyframes = keyframe_ticks();
  if (!keyframes) return keyframes.errors();
  for (std::size_t i = 1; i < keyframes->size(); ++i) counter.add_keyframe();
  return counter.result();
}

Result<Done> SessionReader::check_all() {
  return check_session(impl_->store, {impl_->path, impl_->start.model, impl_->finish, impl_->tick_count});
}

}  // namespace ctpm::recordings
