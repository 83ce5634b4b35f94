#include "core/contact/cut_surfaces.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/cutting/swept_surface.h"

namespace ctpm::contact {
namespace {

/// Of the length of the organs: twice it, and some more for spheres outside of their surface.
constexpr double kTurned = 2.5;

/// A blade that cut nothing for so many ticks has probably done its cut.
constexpr int kRests = 50;

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

/// Elements that a surface of the first `rows` rows of that of `state` knows to be severed: in front of a blade that
/// still cuts it knows none.
static const std::vector<std::uint8_t>& known_severed(const State& state, std::size_t rows) {
  static const std::vector<std::uint8_t> none;
  return rows == cutting::swept_rows(state) ? state.axial_severed : none;
}

/// Whether a surface is the first `rows` rows of that of `state`. Two that agree in their last rows agree in those
/// before them.
static bool is_same(const State& surface, const State& state, std::size_t rows) {
  const std::size_t points = rows * kEdgeNodes;
  if (surface.swept.size() != points || surface.axial_severed != known_severed(state, rows)) return false;
  for (std::size_t n = points - std::min(points, 2 * kEdgeNodes); n < points; ++n)
    if (!(surface.swept[n] == state.swept[n]) || surface.swept_organ[n] != state.swept_organ[n]) return false;
  return true;
}

CutSurfaces::CutSurfaces(const Model& model, StageWatch* watch) : model_(model), watch_(watch), points_(model) {
  if (!model.has_tool(ToolKind::ball) && !model.has_meeting_bodies()) return;
  for (std::size_t organ = 0; organ < model.organs.size(); ++organ) {
    organs_.emplace_back();
    if (points_.has(organ)) organs_.back().emplace(model, organ, watch);
  }
}

void CutSurfaces::prepare() {
  wait();
  for (auto& organ : organs_)
    if (organ) organ->prepare();
}

void CutSurfaces::begin_tick(const State& state, bool cuts) {
  if (organs_.empty()) return;
  // Nothing but tissue, obstacles and a ball in the other hand touches cuts while a blade is held. Without them the
  // worker begins when the blade rests or is out of the tissue, so that the ball that is taken next need not wait.
  const bool is_touched = !cuts || model_.has_meeting_bodies() || model_.hands > 1;
  if (!is_touched && !rests(state)) return;
  const std::size_t rows = rows_left_behind(state, cuts && is_touched);
  if (followed_ ? !is_same(*followed_, state, rows) : rows > 0) start(state, rows);
  if (model_.has_meeting_bodies()) wait();
}

/// Whether nothing was cut in the last ticks.
bool CutSurfaces::rests(const State& state) {
  const std::size_t points = state.swept.size();
  if (points == 0) return false;
  bool is_known = points == seen_points_;
  for (std::size_t n = 0; n < kEdgeNodes; ++n)
    is_known = seen_[n] == std::exchange(seen_[n], state.swept[points - kEdgeNodes + n]) && is_known;
  seen_points_ = points, rested_ = is_known ? rested_ + 1 : 0;
  return rested_ >= kRests;
}

/// Has the worker follow the first `rows` rows of the swept surface of `state`.
void CutSurfaces::start(const State& state, std::size_t rows) {
  const auto surface = std::make_shared<State>();
  surface->swept = state.swept, surface->swept.resize(rows * kEdgeNodes);
  surface->swept_organ.assign(state.swept_organ.begin(),
                              state.swept_organ.begin() + std::ptrdiff_t(surface->swept.size()));
  surface->axial_severed = known_severed(state, rows);
  followed_ = surface, is_cut_ = false, ++version_;

  std::promise<std::vector<std::uint8_t>> hidden;
  follows_ = hidden.get_future();
  worker_.request_stop();
  worker_ = std::jthread(
      [this, surface, before = std::move(worker_), hidden = std::move(hidden)](const std::stop_token& stop) mutable {
        if (before.joinable()) before.join();
        try {
          for (auto& organ : organs_)
            if (organ) organ->follow(surface);
          hidden.set_value(find_hidden());
        } catch (...) {
          hidden.set_exception(std::current_exception());
          return;
        }
        try {
          for (auto& organ : organs_)
            if (organ) organ->make_all(stop);
        } catch (const std::bad_alloc&) {  // the tick that needs the patch makes it
        }
      });
}

bool CutSurfaces::wait_near(const Box& region, const StateView& state, const surface::NearSurface& organs) {
  if (!follows_.valid()) return false;
  const Box &displacements = organs.displacements(), &rest = organs.rest_box();
  // Weights near a cut may be negative; and what turns with a sphere may be as far from it as the organs are long, on
  // either side.
  const Vec3 size = displacements.high - displacements.low;
  const Box by = Box(displacements.low - size, displacements.high + size).grown(kTurned * norm(rest.high - rest.low));
  if (!region.meets(rest.moved(by)) && std::none_of(state.touched.begin(), state.touched.end(),
                                                    [&](std::int32_t point) { return points_.contains(point); }))
    return false;
  wait();
  return true;
}

/// Takes organs_ over from the worker, which goes on with their patches.
void CutSurfaces::wait() {
  if (!follows_.valid()) return;
  const InStage waiting(watch_, Stage::cut_surface);
  try {
    hidden_ = follows_.get();
  } catch (...) {
    followed_ = nullptr;
    throw;
  }
  ++version_, is_cut_ = !hidden_.empty();
  if (position_ != nullptr) begin(*position_);
}

std::vector<std::uint8_t> CutSurfaces::find_hidden() const {
  std::vector<std::uint8_t> hidden;
  if (std::none_of(organs_.begin(), organs_.end(), [](const auto& organ) { return organ && organ->is_cut(); }))
    return hidden;
  for (std::size_t organ = 0; organ < model_.surfaces.size(); ++organ)
    for (const Vec3& vertex : model_.surfaces[organ].vertex) hidden.push_back(covers(organ, vertex));
  return hidden;
}

void CutSurfaces::begin(const Vec3Array& position) {
  position_ = &position;
  if (!is_cut_) return;
  for (auto& organ : organs_)
    if (organ) organ->begin(position);
}

cutbody::CutPatch* CutSurfaces::patch(const cutbody::CutPoints::Place& place) {
  return organs_[place.organ] ? organs_[place.organ]->patch(place.block, place.vertex) : nullptr;
}

}  // namespace ctpm::contact
