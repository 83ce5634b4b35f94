#include "studio/render/cut_surface.h"

#include <algorithm>
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
  Parts(const Model& model, std::size_t organ)
      : whole(model.surfaces[organ]),
        is_layered(model.organs[organ].layer_count > 1),
        layer(std::span(model.layer).subspan(std::size_t(model.organs[organ].first))) {
    if (model.has_scalpel() && !whole.triangle.empty()) body.emplace(model, organ);
  }

  void find_lips();
  void find_rind();
  void find_shading();

  const Surface& whole;
  const bool is_layered;
  std::span<const std::int32_t> layer;  ///< of the organ's spheres
  std::optional<cutbody::CutBody> body;
  std::vector<std::uint8_t> is_lip;
  std::vector<float> rind;
  Shading of_whole, at_rest;
  std::uint64_t changes = 0;
};

/// Outer vertices at whose place the wall has one too.
void CutSurface::Parts::find_lips() {
  const Surface& surface = body->surface();
  const std::size_t outer = body->outer_vertex_count();
  std::set<std::tuple<double, double, double>> of_wall;
  for (std::size_t v = outer; v < surface.vertex.size(); ++v)
    of_wall.insert({surface.vertex[v].x, surface.vertex[v].y, surface.vertex[v].z});
  is_lip.assign(outer, 0);
  for (std::size_t v = 0; v < outer; ++v)
    is_lip[v] = of_wall.contains({surface.vertex[v].x, surface.vertex[v].y, surface.vertex[v].z});
}

void CutSurface::Parts::find_rind() {
  const Surface& surface = body->surface();
  const SurfaceBinding& b = surface.binding;
  rind.assign(surface.vertex.size(), 0.0f);
  if (!is_layered) return;
  for (std::size_t v = body->outer_vertex_count(); v < rind.size(); ++v) {
    double at = 0;
    for (std::size_t e = std::size_t(b.first[v]); e < std::size_t(b.first[v + 1]); ++e)
      at += b.weight[e] * layer[std::size_t(b.sphere[e])];
    rind[v] = rind_of_layer(at);
  }
}

void CutSurface::Parts::find_shading() {
  if (of_whole.normal.empty()) {
    find_normals(whole, whole.vertex, of_whole);
    find_crevices(whole, whole.vertex, count_neighbours(whole), of_whole);
  }
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
}

CutSurface::CutSurface(const Model& model, std::size_t organ) : parts_(std::make_unique<Parts>(model, organ)) {}
CutSurface::~CutSurface() = default;
CutSurface::CutSurface(CutSurface&&) noexcept = default;

bool CutSurface::update(const State& state) {
  Parts& parts = *parts_;
  if (!parts.body || !parts.body->update(state)) return false;
  ++parts.changes;
  parts.is_lip.clear(), parts.rind.clear(), parts.at_rest = {};
  if (parts.body->is_cut()) parts.find_lips(), parts.find_rind(), parts.find_shading();
  return true;
}

std::uint64_t CutSurface::changes() const { return parts_->changes; }
const Surface& CutSurface::surface() const { return parts_->body ? parts_->body->surface() : parts_->whole; }
std::size_t CutSurface::outer_triangle_count() const {
  return parts_->body ? parts_->body->outer_triangle_count() : parts_->whole.triangle.size();
}
const std::vector<std::uint8_t>& CutSurface::is_lip() const { return parts_->is_lip; }
const std::vector<float>& CutSurface::rind() const { return parts_->rind; }
const Shading& CutSurface::at_rest() const { return parts_->at_rest; }
std::size_t CutSurface::outer_vertex_count() const {
  return parts_->body ? parts_->body->outer_vertex_count() : parts_->whole.vertex.size();
}

}  // namespace ctpm::render
