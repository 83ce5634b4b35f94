#include "studio/server/seeker.h"

#include <algorithm>
#include <utility>

#include "studio/server/cut_key.h"

namespace ctpm::server {
namespace {

constexpr std::int64_t kFar = 50;                  ///< ticks
constexpr std::size_t kLittle = 200 * kEdgeNodes;  ///< points of a swept surface
constexpr std::size_t kMostCursors = 8;            ///< before the first cut, after those that stay, and one between

}  // namespace

bool Seeker::is_far(std::int64_t tick) const {
  const auto is_near = [&](const Cursor& cursor) {
    return cursor.replay.tick() <= tick && tick - cursor.replay.tick() <= kFar;
  };
  if (std::any_of(cursors_.begin(), cursors_.end(), is_near)) return false;
  const Moments::Place before = moments_.before(tick);
  const auto is_at_its_cut = [&](const Cursor& cursor) {
    return cursor.replay.state().swept.size() == before.second->swept_points();
  };
  return tick - before.first > kFar || !before.second || std::none_of(cursors_.begin(), cursors_.end(), is_at_its_cut);
}

/// Takes the cursor that is nearest before `tick`, if no kept State is nearer.
bool Seeker::goes_on(std::int64_t tick) {
  std::int64_t nearest = moments_.before(tick).first - 1;
  const std::size_t none = cursors_.size();
  std::size_t found = none;
  for (std::size_t i = 0; i < cursors_.size(); ++i)
    if (const std::int64_t at = cursors_[i].replay.tick(); at <= tick && at > nearest) nearest = at, found = i;
  if (found == none) return false;
  last_ = found;
  return true;
}

/// The cursor whose cut is the most of that of `state`, and lacks little of it; their number if there is none.
std::size_t Seeker::find_at_cut_of(const State& state) const {
  std::size_t best = cursors_.size(), lacks = kLittle + 1;
  for (std::size_t i = 0; i < cursors_.size(); ++i) {
    const CutKey key(cursors_[i].replay.state());
    const bool is_begun = key.is_whole() ? state.swept.size() == 0 : key.is_part_of(state);
    if (is_begun && state.swept.size() - key.points() < lacks) best = i, lacks = state.swept.size() - key.points();
  }
  return best;
}

/// Takes a cursor in, in place of that of which the last use is longest ago.
void Seeker::put(recordings::ReplayCursor cursor) {
  if (cursors_.size() < kMostCursors) {
    last_ = cursors_.size();
    return cursors_.push_back({std::move(cursor)});
  }
  const auto oldest = std::min_element(cursors_.begin(), cursors_.end(),
                                       [](const Cursor& a, const Cursor& b) { return a.used < b.used; });
  last_ = std::size_t(oldest - cursors_.begin());
  oldest->replay = std::move(cursor);
}

/// Puts a cursor at a kept State: one that is at the same cut, or a little before its end, else one that was made ready
/// there, else a new one.
Result<Done> Seeker::begin_at(const Moments::Place& place) {
  const Result<Moment> start = moments_.read(place, reader_);
  if (!start) return start.errors();
  last_ = find_at_cut_of(start->state);
  if (last_ == cursors_.size()) {
    if (std::optional<recordings::ReplayCursor> spare = spares_.take(start->state)) {
      put(std::move(*spare));
    } else {
      Result<recordings::ReplayCursor> made = recordings::ReplayCursor::create(reader_);
      if (!made) return made.errors();
      put(std::move(*made));
    }
  }
  cursors_[last_].replay.resume(start->tick, start->state);
  cursors_[last_].was_same = start->is_same;
  return Done{};
}

Result<bool> Seeker::go_to(std::int64_t tick, const std::function<bool()>& should_stop) {
  if (is_there(tick)) return true;
  has_report_ = false;
  // The last tick is simulated in any case, because its report belongs to the picture.
  const std::int64_t before = std::max<std::int64_t>(0, tick - 1);
  if (!goes_on(before))
    if (const Result<Done> begun = begin_at(moments_.before(before)); !begun) return begun.errors();
  Cursor& cursor = cursors_[last_];
  cursor.used = ++uses_;
  while (cursor.replay.tick() < tick) {
    if (should_stop()) return false;
    const Result<bool> stepped = cursor.replay.step();
    if (!stepped) return stepped.errors();
    if (!*stepped) break;
    moments_.keep(cursor.replay.tick(), cursor.replay.state(), is_same(cursor));
  }
  has_report_ = true;
  return true;
}

}  // namespace ctpm::server
