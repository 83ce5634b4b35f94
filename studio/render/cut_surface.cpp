#include "studio/render/cut_surface.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "core/cutbody/cut_body.h"

namespace ctpm::render {
namespace {

constexpr double kRindEnds = 2.0;  // in layers: the middle of the second

}  // namespace

float rind_of_layer(double layer) { return float(std::clamp((kRindEnds - layer) / (kRindEnds - 1), 0.0, 1.0)); }

struct CutSurface::Parts {
  /// The surface at one moment.
  struct Shape {
    Surface copy;            ///< empty if `surface` is that of `body`
    const Surface* surface;  ///< what is drawn
    std::size_t outer_triangles, outer_vertices;
    bool is_cut;
    std::vector<std::uint8_t> is_lip;
    std::vector<float> rind;
    Shading at_rest;
  };
  /// Of a swept surface that update() has not asked for yet; the first may be the one that it asked for last.
  struct Ahead {
    Vec3Array swept;
    std::vector<std::uint8_t> swept_organ;
    std::shared_ptr<const Shape> shape;
    bool is_of(const State& state) const { return swept == state.swept && swept_organ == state.swept_organ; }
  };

  Parts(const Model& model, std::size_t organ)
      : whole(model.surfaces[organ]),
        is_layered(model.organs[organ].layer_count > 1),
        layer(std::span(model.layer).subspan(std::size_t(model.organs[organ].first))) {
    if (model.has_scalpel() && !whole.triangle.empty()) body.emplace(model, organ);
  }

  std::shared_ptr<const Shape> make_shape(bool is_copied);
  std::shared_ptr<const Shape> found_ahead(const State& state);
  std::vector<std::uint8_t> find_lips() const;
  std::vector<float> find_rind() const;
  Shading find_shading();

  const Surface& whole;
  const bool is_layered;
  std::span<const std::int32_t> layer;  ///< of the organ's spheres
  std::mutex body_mutex;                ///< for `body` and `of_whole`
  std::optional<cutbody::CutBody> body;
  Shading of_whole;
  std::shared_ptr<const Shape> shown;  ///< null: the whole organ
  std::uint64_t changes = 0;
  std::mutex ahead_mutex;
  std::deque<Ahead> ahead;
};

std::shared_ptr<const CutSurface::Parts::Shape> CutSurface::Parts::make_shape(bool is_copied) {
  auto shape = std::make_shared<Shape>();
  if (is_copied) shape->copy = body->surface();
  shape->surface = is_copied ? &shape->copy : &body->surface();
  shape->outer_triangles = body->outer_triangle_count(), shape->outer_vertices = body->outer_vertex_count();
  shape->is_cut = body->is_cut();
  if (shape->is_cut) shape->is_lip = find_lips(), shape->rind = find_rind(), shape->at_rest = find_shading();
  return shape;
}

/// None if that State was not followed ahead: then nor will those after it have been.
std::shared_ptr<const CutSurface::Parts::Shape> CutSurface::Parts::found_ahead(const State& state) {
  const std::lock_guard lock(ahead_mutex);
  const auto found = std::ranges::find_if(ahead, [&](const Ahead& known) { return known.is_of(state); });
  ahead.erase(ahead.begin(), found);
  return ahead.empty() ? nullptr : ahead.front().shape;
}

/// Outer vertices at whose place the wall has one too.
std::vector<std::uint8_t> CutSurface::Parts::find_lips() const {
  const Surface& surface = body->surface();
  const std::size_t outer = body->outer_vertex_count();
  std::set<std::tuple<double, double, double>> of_wall;
  for (std::size_t v = outer; v < surface.vertex.size(); ++v)
    of_wall.insert({surface.vertex[v].x, surface.vertex[v].y, surface.vertex[v].z});
  std::vector<std::uint8_t> is_lip(outer, 0);
  for (std::size_t v = 0; v < outer; ++v)
    is_lip[v] = of_wall.contains({surface.vertex[v].x, surface.vertex[v].y, surface.vertex[v].z});
  return is_lip;
}

std::vector<float> CutSurface::Parts::find_rind() const {
  const Surface& surface = body->surface();
  const SurfaceBinding& b = surface.binding;
  std::vector<float> rind(surface.vertex.size(), 0.0f);
  if (!is_layered) return rind;
  for (std::size_t v = body->outer_vertex_count(); v < rind.size(); ++v) {
    double at = 0;
    for (std::size_t e = std::size_t(b.first[v]); e < std::size_t(b.first[v + 1]); ++e)
      at += b.weight[e] * layer[std::size_t(b.sphere[e])];
    rind[v] = rind_of_layer(at);
  }
  return rind;
}

Shading CutSurface::Parts::find_shading() {
  if (of_whole.normal.empty()) {
    find_normals(whole, whole.vertex, of_whole);
    find_crevices(whole, whole.vertex, count_neighbours(whole), of_whole);
  }
  Shading at_rest;
  at_rest.normal.assign(body->outer_vertex_count(), Vec3{}), at_rest.crevice.assign(body->outer_vertex_count(), 0.0f);
  for (std::size_t v = 0; v < at_rest.normal.size(); ++v) {
    const cutbody::CutBody::Origin& origin = body->origin()[v];
    if (origin.triangle < 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = std::size_t(whole.triangle[std::size_t(origin.triangle)][i]);
      at_rest.normal[v] += origin.weight[i] * of_whole.normal[corner];
      at_rest.crevice[v] += float(origin.weight[i]) * of_whole.crevice[corner];
    }
    at_rest.normal[v] = at_rest.normal[v] / norm(at_rest.normal[v]);
  }
  return at_rest;
}

CutSurface::CutSurface(const Model& model, std::size_t organ) : parts_(std::make_unique<Parts>(model, organ)) {}
CutSurface::~CutSurface() = default;
CutSurface::CutSurface(CutSurface&&) noexcept = default;

void CutSurface::follow_ahead(const State& state) {
  constexpr std::size_t kMost = 16;
  Parts& parts = *parts_;
  if (!parts.body) return;
  std::shared_ptr<const Parts::Shape> shape;
  {
    const std::lock_guard lock(parts.ahead_mutex);
    if (parts.ahead.size() == kMost) parts.ahead.clear();  // nobody asks for them
    if (!parts.ahead.empty()) shape = parts.ahead.back().shape;
    if (shape && parts.ahead.back().is_of(state)) return;
  }
  const std::lock_guard of_body(parts.body_mutex);
  if (parts.body->update(state) || !shape) shape = parts.make_shape(true);
  const std::lock_guard lock(parts.ahead_mutex);
  parts.ahead.push_back({state.swept, state.swept_organ, std::move(shape)});
}

bool CutSurface::update(const State& state) {
  Parts& parts = *parts_;
  if (!parts.body) return false;
  std::shared_ptr<const Parts::Shape> shape = parts.found_ahead(state);
  if (!shape) {
    const std::lock_guard of_body(parts.body_mutex);
    const bool is_as_before = !parts.body->update(state) && (!parts.shown || parts.shown->copy.vertex.empty());
    if (is_as_before) return false;
    shape = parts.make_shape(false);
  }
  const bool is_new = parts.shown ? shape != parts.shown : shape->is_cut;
  parts.shown = std::move(shape), parts.changes += is_new;
  return is_new;
}

std::uint64_t CutSurface::changes() const { return parts_->changes; }
const Surface& CutSurface::surface() const { return parts_->shown ? *parts_->shown->surface : parts_->whole; }
std::size_t CutSurface::outer_triangle_count() const {
  return parts_->shown ? parts_->shown->outer_triangles : parts_->whole.triangle.size();
}
std::size_t CutSurface::outer_vertex_count() const {
  return parts_->shown ? parts_->shown->outer_vertices : parts_->whole.vertex.size();
}
const std::vector<std::uint8_t>& CutSurface::is_lip() const {
  static const std::vector<std::uint8_t> none;
  return parts_->shown ? parts_->shown->is_lip : none;
}
const std::vector<float>& CutSurface::rind() const {
  static const std::vector<float> none;
  return parts_->shown ? parts_->shown->rind : none;
}
const Shading& CutSurface::at_rest() const {
  static const Shading none;
  return parts_->shown ? parts_->shown->at_rest : none;
}

}  // namespace ctpm::render
