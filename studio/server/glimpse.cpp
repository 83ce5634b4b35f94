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

Result<Glimpses::Glimpse> Glimpses::of(std::int64_t tick) {
  const Result<std::vector<recordings::TickRecord>> records = reader_.ticks(tick - 1, tick);
  if (!records) return records.errors();
  const Result<Moment> from = moments_.read(moments_.before(tick), reader_);
  if (!from) return from.errors();
  const std::optional<Moments::Place> after = moments_.after(tick);
  const Result<Moment> to = after ? moments_.read(*after, reader_) : from;
  if (!to) return to.errors();
  const std::int64_t ticks = to->tick - from->tick;
  const double share = ticks > 0 ? double(tick - from->tick) / double(ticks) : 0;
  return Glimpse{glimpse_between(from->state, to->state, share, records->front()), records->front()};
}

}  // namespace ctpm::server
