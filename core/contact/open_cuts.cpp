#include "core/contact/open_cuts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cutting/swept_surface.h"

namespace ctpm::contact {
namespace {

/// Rows of the swept surface that the blade has left: all of them, unless the last row is where the front is now.
/// Then those before the sheet that it goes on with, which begins with a row to which nothing was swept.
std::size_t rows_left_behind(const State& state, bool cuts) {
  const std::size_t rows = cutting::swept_rows(state);
  if (!cuts || rows == 0) return rows;
  const std::size_t last = (rows - 1) * kEdgeNodes;
  const auto is_swept = [&](std::size_t at) { return state.swept_organ[at] != 0; };
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    if (!is_swept(last + n) && (n == 0 || !is_swept(last + n - 1))) continue;
    if (!(state.swept[last + n] == cutting::stored_place(state.blade_trail[n]))) return rows;
  }
  std::size_t begin = rows;
  while (begin > 0) {
    const auto row = state.swept_organ.begin() + std::ptrdiff_t((--begin) * kEdgeNodes);
    if (std::all_of(row, row + std::ptrdiff_t(kEdgeNodes), [](std::uint8_t organ) { return organ == 0; })) break;
  }
  return begin;
}

}  // namespace

void follow_open_cuts(const Model& model, bool cuts, State& state) {
  if (state.opening_cuts_at > state.tick) return;
  if (state.opening_cuts_at > 0) state.open_cuts = std::exchange(state.opening_cuts, {}), state.opening_cuts_at = 0;
  const TouchedCuts& open = state.open_cuts;
  const auto rows = std::int32_t(rows_left_behind(state, cuts));
  // What a blade that still cuts has severed is not told from what was severed before it.
  const bool is_all = rows > 0 && std::size_t(rows) == cutting::swept_rows(state);
  if (rows < open.rows || (rows == open.rows && !(is_all && open.axial_severed != state.axial_severed))) return;
  state.opening_cuts.rows = rows;
  if (is_all) state.opening_cuts.axial_severed = state.axial_severed;
  state.opening_cuts_at = state.tick + std::max<std::int64_t>(1, std::llround(kOpensAfter / model.tick));
}

}  // namespace ctpm::contact
