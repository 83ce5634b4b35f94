#include "studio/server/moments.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

namespace ctpm::server {
namespace {

std::size_t bytes_of(const State& s) {
  std::size_t bytes = sizeof s;
  for (const Vec3Array* a : {&s.position, &s.velocity, &s.acceleration, &s.grip}) bytes += 24 * a->size();
  bytes += 8 * (s.kelvin_elongation.size() + s.kelvin_dent.size()) + 4 * s.touched.size();
  return bytes + s.axial_severed.size() + s.constraint_severed.size() + s.angle_severed.size() +
         s.axial_crossing.size();
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
  return std::unique_ptr<Moments>(new Moments(std::move(*reader), *keyframes));
}

Moments::Moments(recordings::SessionReader reader, std::vector<std::int64_t> keyframes)
    : reader_(std::move(reader)), keyframes_(std::move(keyframes)), is_done_(keyframes_.size()) {
  const std::int64_t ticks = reader_.tick_count();
  const std::size_t state_bytes = bytes_of(reader_.start().initial_state);
  spacing_ = std::max(kSpacing, std::int64_t(double(ticks) * double(state_bytes) / double(memory_for_states())) + 1);
  moments_.resize(std::size_t(ticks / spacing_) + 1);
  thread_ = std::thread([this] { work(); });
}

Moments::~Moments() {
  ends_ = true;
  thread_.join();
}

Moments::Place Moments::before(std::int64_t tick) const {
  const auto next = std::upper_bound(keyframes_.begin(), keyframes_.end(), tick);
  const std::int64_t least = next == keyframes_.begin() ? 0 : *std::prev(next);
  const std::lock_guard lock(mutex_);
  for (std::int64_t i = tick / spacing_; i >= 0 && i * spacing_ > least; --i)
    if (const auto& moment = moments_[std::size_t(i)]) return {i * spacing_, moment};
  return {least, nullptr};
}

std::optional<Moments::Place> Moments::after(std::int64_t tick) const {
  const auto next = std::upper_bound(keyframes_.begin(), keyframes_.end(), tick);
  const std::int64_t most = next == keyframes_.end() ? reader_.tick_count() + 1 : *next;
  const std::lock_guard lock(mutex_);
  for (std::int64_t i = tick / spacing_ + 1; i * spacing_ < most && std::size_t(i) < moments_.size(); ++i)
    if (const auto& moment = moments_[std::size_t(i)]) return Place{i * spacing_, moment};
  if (next == keyframes_.end()) return std::nullopt;
  return Place{most, nullptr};
}

Result<Moments::Place> Moments::read(const Place& place, recordings::SessionReader& reader) const {
  if (place.second) return place;
  Result<recordings::Keyframe> keyframe = reader.keyframe_at_or_before(place.first);
  if (keyframe) return Place{keyframe->tick, std::make_shared<const Moment>(Moment{std::move(keyframe->state)})};
  if (place.first == 0) return keyframe.errors();
  return read(before(place.first - 1), reader);
}

void Moments::keep(std::int64_t tick, const State& state, bool is_same) {
  if (tick % spacing_ != 0) return;
  {
    const std::lock_guard lock(mutex_);
    if (std::size_t(tick / spacing_) >= moments_.size() || moments_[std::size_t(tick / spacing_)]) return;
  }
  auto moment = std::make_shared<const Moment>(Moment{state, is_same});
  const std::lock_guard lock(mutex_);
  moments_[std::size_t(tick / spacing_)] = std::move(moment);
}

double Moments::share() const {
  const std::lock_guard lock(mutex_);
  return is_done_.empty() ? 1 : double(std::count(is_done_.begin(), is_done_.end(), true)) / double(is_done_.size());
}

/// The nearest interval that is not done; their number if all are.
std::size_t Moments::next_interval() const {
  const std::int64_t aim = aim_;
  std::size_t best = keyframes_.size();
  std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    const std::int64_t middle = keyframes_[i] + 500, away = middle > aim ? middle - aim : aim - middle;
    if (!is_done_[i] && away < nearest) best = i, nearest = away;
  }
  return best;
}

std::int64_t Moments::end_of(std::size_t interval) const {
  return interval + 1 < keyframes_.size() ? keyframes_[interval + 1] : reader_.tick_count();
}

/// Replays one interval, from the last State that it has. False: another one is needed first, or nothing more.
bool Moments::fill(recordings::ReplayCursor& cursor, std::size_t interval) {
  const std::int64_t end = end_of(interval);
  const auto [from, kept] = before(std::max(keyframes_[interval], end - 1));
  if (kept)
    cursor.resume(from, kept->state);
  else if (!cursor.seek(from))
    return true;  // a damaged part has no moments
  const bool was_same = !kept || kept->is_same;
  while (cursor.tick() < end) {
    if (ends_) return false;
    if (const Result<bool> went_on = cursor.step(); !went_on || !*went_on) break;
    if (cursor.tick() % spacing_ != 0 || cursor.tick() >= end) continue;
    keep(cursor.tick(), cursor.state(), was_same && cursor.same_so_far());
    if (next_interval() != interval) return false;
  }
  return true;
}

void Moments::work() {
  setpriority(PRIO_PROCESS, id_t(gettid()), 15);
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(reader_);
  if (!cursor) return;
  for (std::size_t next; !ends_ && (next = next_interval()) < keyframes_.size();) {
    if (!fill(*cursor, next)) continue;
    const std::lock_guard lock(mutex_);
    is_done_[next] = true;
  }
}

}  // namespace ctpm::server
