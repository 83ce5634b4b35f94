#include "studio/server/glimpse.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace ctpm::server {
namespace {

bool is_cut_alike(const State& a, const State& b) {
  return a.axial_severed == b.axial_severed && a.constraint_severed == b.constraint_severed &&
         a.angle_severed == b.angle_severed && a.swept.size() == b.swept.size();
}

}  // namespace

State glimpse_between(const State& before, const State& after, double share, const recordings::TickRecord& record) {
  State state = share < 0.5 ? before : after;
  if (is_cut_alike(before, after))
    for (std::size_t i = 0; i < state.position.size(); ++i)
      state.position.set(i, (1 - share) * before.position[i] + share * after.position[i]);
  state.last_inputs = record.inputs;
  return state;
}

/// A place with its State, which may have to be read.
Result<Moments::Place> Glimpses::read(const Moments::Place& place) {
  constexpr std::size_t kMostKnown = 8;
  if (place.second) return place;
  if (const auto known = known_.find(place.first); known != known_.end()) return Moments::Place(*known);
  const Result<Moments::Place> found = moments_.read(place, reader_);
  if (!found) return found.errors();
  if (known_.size() >= kMostKnown) known_.clear();
  known_.insert(*found);
  return *found;
}

Result<Glimpses::Glimpse> Glimpses::of(std::int64_t tick) {
  const Result<std::vector<recordings::TickRecord>> records = reader_.ticks(tick - 1, tick);
  if (!records) return records.errors();
  const Result<Moments::Place> from = read(moments_.before(tick));
  if (!from) return from.errors();
  const std::optional<Moments::Place> after = moments_.after(tick);
  const Result<Moments::Place> to = after ? read(*after) : from;
  if (!to) return to.errors();
  const std::int64_t ticks = to->first - from->first;
  const double share = ticks > 0 ? double(tick - from->first) / double(ticks) : 0;
  return Glimpse{glimpse_between(from->second->state, to->second->state, share, records->front()), records->front()};
}

}  // namespace ctpm::server
