#include "core/contact/open_cuts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/cutting/swept_surface.h"

namespace ctpm::contact {
namespace {

/// Rows of the swept surface that the blade has left: all of them, unless the last row is where the front is now.
/// Then those before the sheet that it goes on with, which begins with a row to which nothing was swept.
std::size_t rows_left_behind(const State& state, bool cuts) {
  const std::size_t rows = cutting::swept_rows(state);
  if (!cuts || rows == 0 || state.edge_organ.size() != kEdgeNodes || state.blade_trail.size() != kEdgeNodes)
    return rows;
  const std::size_t last = (rows - 1) * kEdgeNodes;
  const auto is_swept = [&](std::size_t at) { return state.swept_organ[at] != 0; };
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    if (!is_swept(last + n) && (n == 0 || !is_swept(last + n - 1))) continue;
    // Away from all organs the front stays where it was.
    if (state.edge_organ[n] < 0 || !(state.swept[last + n] == cutting::stored_place(state.blade_trail[n]))) return rows;
  }
  std::size_t begin = rows;
  while (begin > 0) {
    const auto row = state.swept_organ.begin() + std::ptrdiff_t((--begin) * kEdgeNodes);
    if (std::all_of(row, row + std::ptrdiff_t(kEdgeNodes), [](std::uint8_t organ) { return organ == 0; })) break;
  }
  return begin;
}

/// What the blade has left that is not open; none: all of it is.
std::optional<TouchedCuts> find_opening(const State& state, bool cuts) {
  const TouchedCuts& open = state.open_cuts;
  const auto rows = std::int32_t(rows_left_behind(state, cuts));
  // What a blade that still cuts has severed is not told from what was severed before it.
  const bool is_all = rows > 0 && std::size_t(rows) == cutting::swept_rows(state);
  if (rows < open.rows || (rows == open.rows && !(is_all && open.axial_severed != state.axial_severed))) return {};
  return TouchedCuts{rows, is_all ? state.axial_severed : std::vector<std::uint8_t>{}};
}

bool is_due(const State& state) { return state.opening_cuts_at > 0 && state.opening_cuts_at <= state.tick; }

}  // namespace

std::int64_t ticks_until_open(const Model& model) {
  return std::max<std::int64_t>(1, std::llround(kOpensAfter / model.tick));
}

bool changes_open_cuts(bool cuts, const State& state) {
  return is_due(state) || (state.opening_cuts_at == 0 && find_opening(state, cuts));
}

void follow_open_cuts(const Model& model, bool cuts, State& state) {
  if (is_due(state)) state.open_cuts = std::exchange(state.opening_cuts, {}), state.opening_cuts_at = 0;
  if (state.opening_cuts_at > 0) return;
  if (std::optional<TouchedCuts> opening = find_opening(state, cuts))
    state.opening_cuts = *std::move(opening), state.opening_cuts_at = state.tick + ticks_until_open(model);
}

}  // namespace ctpm::contact
