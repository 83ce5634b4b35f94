#include "studio/server/glimpse.h"

#include <cstddef>

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

}  // namespace ctpm::server
