#include "studio/server/moments.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdlib>

#include "studio/server/cut_key.h"
#include "studio/server/idle_pause.h"
#include "studio/session/urgency.h"

namespace ctpm::server {
namespace {

/// Of a State without its swept surface.
std::size_t bytes_of(const State& s) {
  std::size_t bytes = sizeof s;
  for (const Vec3Array* a : {&s.position, &s.velocity, &s.acceleration, &s.grip}) bytes += 24 * a->size();
  bytes += 8 * (s.kelvin_elongation.size() + s.kelvin_dent.size()) + 4 * s.touched.size();
  return bytes + s.axial_severed.size() + s.constraint_severed.size() + s.angle_severed.size() +
         s.axial_crossing.size() + s.open_cuts.axial_severed.size() + s.opening_cuts.axial_severed.size();
}

std::size_t memory_for_states() {
  const double installed = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  return std::max(Moments::kLeastMemory, std::size_t(std::max(0.0, installed / 16)));
}

}  // namespace

Result<std::unique_ptr<Moments>> Moments::open(const std::string& file) {
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(file);
  if (!reader) return reader.errors();
  const Result<std::vector<std::int64_t>> keyframes = reader->keyframe_ticks();
  if (!keyframes) return keyframes.errors();
  Result<recordings::Keyframe> last = reader->keyframe_at_or_before(keyframes->back());
  std::optional<State> longest;
  if (last) longest = std::move(last->state);  // a damaged one has no sweep to share
  return std::unique_ptr<Moments>(new Moments(std::move(*reader), *keyframes, std::move(longest)));
}

Moments::Moments(recordings::SessionReader reader, std::vector<std::int64_t> keyframes, std::optional<State> last)
    : reader_(std::move(reader)), keyframes_(std::move(keyframes)), last_(std::move(last)), filled_(keyframes_) {
  const std::int64_t ticks = reader_.tick_count();
  const std::size_t state_bytes = bytes_of(reader_.start().initial_state);
  const double keyframes_bytes = double(keyframes_.size()) * double(state_bytes), memory = double(memory_for_states());
  keeps_keyframes_ = keyframes_bytes < memory / 2;
  const double left = memory - (keeps_keyframes_ ? keyframes_bytes : 0);
  spacing_ = std::max(kSpacing, std::int64_t(double(ticks) * double(state_bytes) / left) + 1);
  moments_.resize(std::size_t(ticks / spacing_) + 1);
  keyframe_states_.resize(keyframes_.size());
  thread_ = std::thread([this] { work(); });
}

Moments::~Moments() {
  ends_ = true;
  thread_.join();
}

Moments::Place Moments::before(std::int64_t tick) const {
  const auto next = std::upper_bound(keyframes_.begin(), keyframes_.end(), tick);
  const std::size_t keyframe = std::size_t(std::max<std::ptrdiff_t>(0, next - keyframes_.begin() - 1));
  const std::int64_t least = next == keyframes_.begin() ? 0 : keyframes_[keyframe];
  const std::lock_guard lock(mutex_);
  for (std::int64_t i = tick / spacing_; i >= 0 && i * spacing_ > least; --i)
    if (const auto& moment = moments_[std::size_t(i)]) return {i * spacing_, moment};
  return {least, keyframe_states_[keyframe]};
}

std::optional<Moments::Place> Moments::after(std::int64_t tick) const {
  const auto next = std::upper_bound(keyframes_.begin(), keyframes_.end(), tick);
  const std::int64_t most = next == keyframes_.end() ? reader_.tick_count() + 1 : *next;
  const std::lock_guard lock(mutex_);
  for (std::int64_t i = tick / spacing_ + 1; i * spacing_ < most && std::size_t(i) < moments_.size(); ++i)
    if (const auto& moment = moments_[std::size_t(i)]) return Place{i * spacing_, moment};
  if (next == keyframes_.end()) return std::nullopt;
  return Place{most, keyframe_states_[std::size_t(next - keyframes_.begin())]};
}

std::shared_ptr<const KeptState> Moments::without_sweep(State state, bool is_same) const {
  std::size_t shared = 0;
  if (state.swept.size() > kEdgeNodes && last_ && CutKey(state).is_part_of(*last_)) {
    shared = state.swept.size() - kEdgeNodes;
    const auto leave = [&](auto& from) { from = {from.begin() + std::ptrdiff_t(shared), from.end()}; };
    leave(state.swept.x), leave(state.swept.y), leave(state.swept.z), leave(state.swept_organ);
  }
  return std::make_shared<const KeptState>(KeptState{std::move(state), shared, is_same});
}

State Moments::with_sweep(const KeptState& kept) const {
  State state = kept.state;
  if (kept.shared_points == 0) return state;
  const auto take = [&](const auto& from, auto& to) {
    to.insert(to.begin(), from.begin(), from.begin() + std::ptrdiff_t(kept.shared_points));
  };
  take(last_->swept.x, state.swept.x), take(last_->swept.y, state.swept.y), take(last_->swept.z, state.swept.z);
  take(last_->swept_organ, state.swept_organ);
  return state;
}

Result<Moment> Moments::read(const Place& place, recordings::SessionReader& reader) {
  if (place.second) return Moment{place.first, with_sweep(*place.second), place.second->is_same};
  Result<recordings::Keyframe> keyframe = reader.keyframe_at_or_before(place.first);
  if (!keyframe && place.first == 0) return keyframe.errors();
  if (!keyframe) return read(before(place.first - 1), reader);
  const auto at = std::lower_bound(keyframes_.begin(), keyframes_.end(), keyframe->tick);
  if (keeps_keyframes_ && at != keyframes_.end() && *at == keyframe->tick) {
    auto kept = without_sweep(keyframe->state, true);
    const std::lock_guard lock(mutex_);
    keyframe_states_[std::size_t(at - keyframes_.begin())] = std::move(kept);
  }
  return Moment{keyframe->tick, std::move(keyframe->state)};
}

void Moments::keep(std::int64_t tick, const State& state, bool is_same) {
  if (tick % spacing_ != 0) return;
  {
    const std::lock_guard lock(mutex_);
    if (std::size_t(tick / spacing_) >= moments_.size() || moments_[std::size_t(tick / spacing_)]) return;
  }
  auto moment = without_sweep(state, is_same);
  const std::lock_guard lock(mutex_);
  moments_[std::size_t(tick / spacing_)] = std::move(moment);
}

double Moments::share() const {
  const std::lock_guard lock(mutex_);
  std::int64_t filled = 0;
  for (std::size_t i = 0; i < keyframes_.size(); ++i) filled += (is_done(i) ? end_of(i) : filled_[i]) - keyframes_[i];
  return keyframes_.empty() ? 1 : double(filled) / double(std::max<std::int64_t>(1, reader_.tick_count()));
}

/// Whether an interval has all of its States; mutex_ is locked.
bool Moments::is_done(std::size_t interval) const {
  return (filled_[interval] / spacing_ + 1) * spacing_ >= end_of(interval);
}

/// That of aim(), else of those with the longest way, to a power of two, the nearest one; the number of intervals if
/// all are done.
std::size_t Moments::next_interval() const {
  const std::int64_t aim = aim_;
  std::size_t best = keyframes_.size();
  std::pair<int, std::int64_t> most{-1, 0};  // way, nearness
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    if (is_done(i)) continue;
    const std::int64_t end = end_of(i), middle = keyframes_[i] + (end - keyframes_[i]) / 2;
    if (keyframes_[i] <= aim && aim < end) return i;
    const std::pair way{int(std::bit_width(std::uint64_t(end - filled_[i]))), -std::abs(middle - aim)};
    if (way > most) most = way, best = i;
  }
  return best;
}

std::int64_t Moments::end_of(std::size_t interval) const {
  return interval + 1 < keyframes_.size() ? keyframes_[interval + 1] : reader_.tick_count();
}

/// Whoever waits for a picture, or trains, has the processor for himself.
void Moments::wait_while_replaying_rests() const {
  while ((rest_ != Rest::none || IdlePause::is_on()) && !ends_)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

/// Replays an interval from the last State that it has, until another one is needed first.
void Moments::fill(recordings::ReplayCursor& cursor, std::size_t interval) {
  const std::int64_t end = end_of(interval);
  const auto is_filled_to = [&](std::int64_t tick) {
    const std::lock_guard lock(mutex_);
    filled_[interval] = tick;
  };
  const auto [from, kept] = before(std::max(keyframes_[interval], end - 1));
  if (kept)
    cursor.resume(from, with_sweep(*kept));
  else if (!cursor.seek(from))
    return is_filled_to(end);  // a damaged part has no moments
  is_filled_to(from);
  const bool was_same = !kept || kept->is_same;
  while (next_interval() == interval) {
    do {
      wait_while_replaying_rests();
      if (ends_) return;
      if (const Result<bool> went_on = cursor.step(); !went_on || !*went_on) return is_filled_to(end);
    } while (cursor.tick() % spacing_ != 0);
    keep(cursor.tick(), cursor.state(), was_same && cursor.same_so_far());
    is_filled_to(cursor.tick());
  }
}

void Moments::work() {
  // Whoever scrubs needs keyframes that are not in memory yet, so they are not read at low priority.
  for (std::size_t i = 0; i < keyframes_.size() && keeps_keyframes_ && !ends_; ++i) {
    while (rest_ == Rest::all && !ends_) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (const Place place = before(keyframes_[i]); !place.second) (void)read(place, reader_);
  }
  session::become(session::Urgency::idle);
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(reader_);
  if (!cursor) return;
  for (std::size_t next; !ends_ && (next = next_interval()) < keyframes_.size();) fill(*cursor, next);
}

}  // namespace ctpm::server
