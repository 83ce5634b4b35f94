#include "recordings/replay.h"

#include <time.h>

#include <algorithm>
#include <chrono>

#include "core/stepping/step.h"
#include "recordings/state_hash.h"

namespace ctpm::recordings {

namespace {
constexpr std::int64_t read_ahead = 1000;  // ticks read at a time

// Computing time that a replay may take: `free_time`, and for each tick `patience` times its length or the computing
// time that the session states for it.
constexpr double free_time = 5, patience = 10, longest_stated = 1;  // [s], [1], [s]

/// Computing time of this thread [s].
double computing_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}
}  // namespace

struct ReplayCursor::Impl {
  explicit Impl(SessionReader& reader_)
      : reader(reader_), stepper(reader_.start().model), state(reader_.start().initial_state) {}

  SessionReader& reader;
  stepping::Stepper stepper;
  State state;
  std::int64_t tick = 0;
  std::vector<TickRecord> ahead;
  std::int64_t ahead_first = 0;
  TickRecord record;
  stepping::StepReport report;
  bool same = true;
  double spent = 0, allowed = free_time;  ///< computing time of all ticks [s]
  double tick_time = 0;                   ///< of the last tick [s]

  Result<Keyframe> keyframe_for(std::int64_t target);
};

ReplayCursor::ReplayCursor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ReplayCursor::ReplayCursor(ReplayCursor&&) noexcept = default;
ReplayCursor& ReplayCursor::operator=(ReplayCursor&&) noexcept = default;
ReplayCursor::~ReplayCursor() = default;

Result<ReplayCursor> ReplayCursor::create(SessionReader& reader) {
  return ReplayCursor(std::make_unique<Impl>(reader));
}

/// The nearest undamaged keyframe at or before `target`; open() has verified keyframe 0.
Result<Keyframe> ReplayCursor::Impl::keyframe_for(std::int64_t target) {
  auto nearest = reader.keyframe_at_or_before(target);
  if (nearest) return nearest;
  const auto ticks = reader.keyframe_ticks();
  if (!ticks) return ticks.errors();
  for (auto t = ticks->rbegin(); t != ticks->rend(); ++t) {
    if (*t > target) continue;
    if (auto earlier = reader.keyframe_at_or_before(*t)) return earlier;
  }
  return reader.keyframe_at_or_before(0);
}

Result<Done> ReplayCursor::seek(std::int64_t tick) {
  Impl& impl = *impl_;
  if (tick < 0 || tick > impl.reader.tick_count())
    return Error{impl.reader.path(),
                 "has no tick " + std::to_string(tick) + ", it has " + std::to_string(impl.reader.tick_count()), ""};
  auto keyframe = impl.keyframe_for(tick);
  if (!keyframe) return keyframe.errors();
  if (tick < impl.tick || keyframe->tick > impl.tick) {
    impl.state = std::move(keyframe->state);
    impl.tick = keyframe->tick;
    impl.same = true;
  }
  while (impl.tick < tick)
    if (auto stepped = step(); !stepped) return stepped.errors();
  return Done{};
}

void ReplayCursor::resume(std::int64_t tick, const State& state) {
  impl_->state = state;
  impl_->tick = tick;
  impl_->same = true;
}

void ReplayCursor::prepare() {
  State trial = impl_->state;
  impl_->stepper.step(trial, trial.last_inputs);
}

Result<bool> ReplayCursor::step() {
  Impl& impl = *impl_;
  const std::int64_t count = impl.reader.tick_count();
  if (impl.tick >= count) return false;
  const bool is_ahead =
      impl.tick >= impl.ahead_first && impl.tick < impl.ahead_first + static_cast<std::int64_t>(impl.ahead.size());
  if (!is_ahead) {
    auto records = impl.reader.ticks(impl.tick, std::min(impl.tick + read_ahead, count));
    // Damage in later ticks does not affect this tick.
    if (!records) records = impl.reader.ticks(impl.tick, impl.tick + 1);
    if (!records) return records.errors();
    impl.ahead = std::move(*records);
    impl.ahead_first = impl.tick;
  }
  impl.record = impl.ahead[impl.tick - impl.ahead_first];
  const double before = computing_time();
  const auto start = std::chrono::steady_clock::now();
  impl.report = impl.stepper.step(impl.state, impl.record.inputs);
  impl.tick_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  impl.spent += computing_time() - before;
  impl.allowed += patience * std::max(impl.reader.start().model.tick, std::min(impl.record.tick_time, longest_stated));
  if (impl.spent > impl.allowed)
    return Error{impl.reader.path(),
                 "tick " + std::to_string(impl.tick) + ": the replay takes " + std::to_string(int(patience)) +
                     " times as long as the session was lived or states that it computed",
                 "its model or its inputs ask for work that no session needs"};
  impl.same = impl.same && state_hash(impl.state) == impl.record.state_hash;
  ++impl.tick;
  return true;
}

std::int64_t ReplayCursor::tick() const { return impl_->tick; }
const State& ReplayCursor::state() const { return impl_->state; }
const TickRecord& ReplayCursor::record() const { return impl_->record; }
const stepping::StepReport& ReplayCursor::report() const { return impl_->report; }
double ReplayCursor::tick_time() const { return impl_->tick_time; }
bool ReplayCursor::same_so_far() const { return impl_->same; }

Result<SessionStart> continue_session(SessionReader& parent, std::int64_t tick) {
  auto cursor = ReplayCursor::create(parent);
  if (!cursor) return cursor.errors();
  if (auto r = cursor->seek(tick); !r) return r.errors();
  if (!cursor->same_so_far()) {
    const std::string remark = physics_remark(parent.start().physics_revision);
    return Error{parent.path(), "does not replay to tick " + std::to_string(tick) + " as it was recorded",
                 remark.empty() ? "verify it" : remark};
  }
  SessionStart start = parent.start();
  start.physics_revision = kPhysicsRevision;
  start.initial_state = cursor->state();
  start.metadata[parent_session_key] = parent.session_id();
  start.metadata[parent_tick_key] = std::to_string(tick);
  return start;
}

}  // namespace ctpm::recordings
