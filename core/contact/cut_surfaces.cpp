#include "core/contact/cut_surfaces.h"

#include <algorithm>

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

CutSurfaces::CutSurfaces(const Model& model) : model_(model), points_(model) {
  if (!model.has_tool(ToolKind::ball) && !model.has_meeting_bodies()) return;
  for (std::size_t organ = 0; organ < model.organs.size(); ++organ) {
    organs_.emplace_back();
    if (points_.has(organ)) organs_.back().emplace(model, organ);
  }
}

void CutSurfaces::prepare() {
  for (auto& organ : organs_)
    if (organ) organ->prepare();
}

void CutSurfaces::begin_tick(const State& state, bool cuts) {
  // Nothing but tissue, obstacles and a ball in the other hand touches cuts while a blade is held.
  const bool follows = !cuts || model_.has_meeting_bodies() || model_.hands > 1;
  const std::size_t rows = rows_left_behind(state, cuts);
  bool changed = false;
  if (cuts) prepare();
  for (auto& organ : organs_) {
    if (!organ) continue;
    if (follows && organ->follow(state, rows)) changed = true;
  }
  if (!changed) return;
  ++version_;
  is_cut_ = std::any_of(organs_.begin(), organs_.end(), [](const auto& organ) { return organ && organ->is_cut(); });
  find_hidden();
}

void CutSurfaces::find_hidden() {
  hidden_.clear();
  if (!is_cut_) return;
  for (std::size_t organ = 0; organ < model_.surfaces.size(); ++organ)
    for (const Vec3& vertex : model_.surfaces[organ].vertex) hidden_.push_back(covers(organ, vertex));
}

void CutSurfaces::begin(const Vec3Array& position) {
  if (!is_cut_) return;
  for (auto& organ : organs_)
    if (organ) organ->begin(position);
}

cutbody::CutPatch* CutSurfaces::patch(const cutbody::CutPoints::Place& place) {
  return organs_[place.organ] ? organs_[place.organ]->patch(place.block, place.vertex) : nullptr;
}

}  // namespace ctpm::contact
