#include "core/contact/cut_surfaces.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/cutting/swept_surface.h"

namespace ctpm::contact {
namespace {

/// Of the length of the organs: twice it, and some more for spheres outside of their surface.
constexpr double kTurned = 2.5;

}  // namespace

/// Whether a surface is that of some cuts of `state`. Two that agree in their last rows agree in those before them.
static bool is_same(const State* surface, const State& state, const TouchedCuts& cuts) {
  if (surface == nullptr) return cuts.rows == 0;
  const std::size_t points = std::size_t(cuts.rows) * kEdgeNodes;
  if (surface->swept.size() != points || surface->axial_severed != cuts.axial_severed) return false;
  for (std::size_t n = points - std::min(points, 2 * kEdgeNodes); n < points; ++n)
    if (!(surface->swept[n] == state.swept[n]) || surface->swept_organ[n] != state.swept_organ[n]) return false;
  return true;
}

CutSurfaces::CutSurfaces(const Model& model, StageWatch* watch) : model_(model), watch_(watch), points_(model) {
  if (!model.has_tool(ToolKind::ball) && !model.has_meeting_bodies()) return;
  std::vector<std::size_t> touched;
  for (std::size_t organ = 0; organ < model.organs.size(); ++organ)
    if (points_.has(organ)) touched.push_back(organ);
  if (touched.empty()) return;
  for (auto* followed : {&open_, &opening_}) {
    *followed = std::make_unique<Followed>();
    (*followed)->organs.resize(model.organs.size());
    for (const std::size_t organ : touched) (*followed)->organs[organ].emplace(model, organ, watch);
  }
}

CutSurfaces::~CutSurfaces() {
  for (auto* followed : {&open_, &opening_})
    if (*followed) (*followed)->stop.request_stop();
}

void CutSurfaces::prepare() {
  if (!opening_) return;
  if (worker_.joinable()) worker_.join();
  is_prepared_ = true;
  for (auto& organ : opening_->organs)
    if (organ) organ->prepare();
}

void CutSurfaces::begin_tick(State& state, bool cuts) {
  if (!open_) return;
  follow_open_cuts(model_, cuts, state);
  if (!is_same(open_->of.get(), state, state.open_cuts)) {
    if (is_same(opening_->of.get(), state, state.open_cuts))
      std::swap(open_, opening_);
    else
      start(*open_, state, state.open_cuts);
    ++version_;
  }
  if (state.opening_cuts_at > 0 && !is_same(opening_->of.get(), state, state.opening_cuts))
    start(*opening_, state, state.opening_cuts);
  if (model_.has_meeting_bodies()) wait();
}

/// Has the worker follow some cuts of `state`.
void CutSurfaces::start(Followed& followed, const State& state, const TouchedCuts& cuts) {
  const auto surface = std::make_shared<State>();
  surface->swept = state.swept, surface->swept.resize(std::size_t(cuts.rows) * kEdgeNodes);
  surface->swept_organ.assign(state.swept_organ.begin(),
                              state.swept_organ.begin() + std::ptrdiff_t(surface->swept.size()));
  surface->axial_severed = cuts.axial_severed;
  followed.is_cut = false;
  followed.stop.request_stop(), followed.stop = {};

  std::promise<std::vector<std::uint8_t>> hidden;
  followed.follows = hidden.get_future();
  Followed& other = &followed == open_.get() ? *opening_ : *open_;
  worker_ = std::jthread([this, surface, before = std::move(worker_), hidden = std::move(hidden), &followed, &other,
                          stop = followed.stop.get_token()]() mutable {
    if (before.joinable()) before.join();
    if (stop.stop_requested()) return;  // nobody waits for it any more
    try {
      for (auto& organ : followed.organs)
        if (organ) organ->follow(surface);
      hidden.set_value(find_hidden(followed));
    } catch (...) {
      hidden.set_exception(std::current_exception());
      return;
    }
    try {
      for (auto& organ : followed.organs)
        if (organ) organ->make_all(stop);
      for (auto& organ : other.organs)
        if (organ && is_prepared_ && !stop.stop_requested()) organ->prepare();
    } catch (const std::bad_alloc&) {  // the tick that needs it makes it
    }
  });
  followed.of = surface;
}

bool CutSurfaces::wait_near(const Box& region, const StateView& state, const surface::NearSurface& organs) {
  if (!open_ || !open_->follows.valid()) return false;
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

/// Takes the open cuts over from the worker, which goes on with their patches.
void CutSurfaces::wait() {
  if (!open_->follows.valid()) return;
  const InStage waiting(watch_, Stage::cut_surface);
  try {
    open_->hidden = open_->follows.get();
  } catch (...) {
    open_->of = nullptr;
    throw;
  }
  ++version_, open_->is_cut = !open_->hidden.empty();
  if (position_ != nullptr) begin(*position_);
}

/// For each vertex through all organs, whether patches stand there for the organ's own surface; empty: nothing is cut.
std::vector<std::uint8_t> CutSurfaces::find_hidden(const Followed& followed) const {
  std::vector<std::uint8_t> hidden;
  if (std::none_of(followed.organs.begin(), followed.organs.end(),
                   [](const auto& organ) { return organ && organ->is_cut(); }))
    return hidden;
  for (std::size_t organ = 0; organ < model_.surfaces.size(); ++organ)
    for (const Vec3& vertex : model_.surfaces[organ].vertex)
      hidden.push_back(followed.organs[organ] && followed.organs[organ]->covers(vertex));
  return hidden;
}

void CutSurfaces::begin(const Vec3Array& position) {
  position_ = &position;
  if (!any()) return;
  for (auto& organ : open_->organs)
    if (organ) organ->begin(position);
}

cutbody::CutPatch* CutSurfaces::patch(const cutbody::CutPoints::Place& place) {
  auto& organ = open_->organs[place.organ];
  return organ ? organ->patch(place.block, place.vertex) : nullptr;
}

}  // namespace ctpm::contact
