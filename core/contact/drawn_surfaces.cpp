#include "core/contact/drawn_surfaces.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include "core/contact/drawn_dent.h"
#include "core/contact/facet_press.h"
#include "core/surface/stretch.h"
#include "core/surface/surface.h"

namespace ctpm::contact {

namespace {

/// Whether a surface is the organ's own, which nothing has cut.
bool is_whole(const Surface& surface, const Surface& own) {
  return surface.vertex.size() == own.vertex.size() && surface.vertex == own.vertex;
}

/// The vertex of a cut surface at each vertex of the organ's own; -1: near the cut there is none.
std::vector<std::int32_t> find_own_vertices(const Surface& surface, const Surface& own) {
  std::map<std::array<double, 3>, std::int32_t> at;
  for (std::size_t v = surface.vertex.size(); v-- > 0;)
    at[{surface.vertex[v].x, surface.vertex[v].y, surface.vertex[v].z}] = std::int32_t(v);
  std::vector<std::int32_t> found;
  for (const Vec3& p : own.vertex) {
    const auto same = at.find({p.x, p.y, p.z});
    found.push_back(same == at.end() ? -1 : same->second);
  }
  return found;
}

}  // namespace

DrawnSurfaces::DrawnSurfaces(const Model& model)
    : model_(model),
      bodies_(surface::bodies_of(model)),
      obstacles_(model.obstacles.begin(), model.obstacles.end()),
      overlaps_(model, bodies_),
      cut_points_(model) {}

void DrawnSurfaces::place(std::size_t organ, const Surface& surface, const State& state, std::vector<Vec3>& vertex) {
  surface::deform_surface(surface, state.position, model_.organs[organ].first, vertex);
  const bool is_cut = !is_whole(surface, model_.surfaces[organ]);
  if (is_cut) surface::spread_stretch(surface, model_.organs[organ].spacing, vertex);
  put_between_organs(organ, surface, is_cut, state, vertex);
  for (std::size_t hand = 0; hand < kMostHands; ++hand) put_on_ball(hand, organ, surface, is_cut, state, vertex);
  for (const surface::ObstacleShape& obstacle : obstacles_)
    for (Vec3& v : vertex)
      if (obstacle.meets(Box(v)))
        if (const surface::Inside inside = obstacle.inside(v); inside.depth > 0) v += inside.depth * inside.outward;
}

/// Moves the vertices that other tissue dents.
void DrawnSurfaces::put_between_organs(std::size_t organ, const Surface& surface, bool is_cut, const State& state,
                                       std::vector<Vec3>& vertex) {
  if (overlaps_.empty()) return;
  const Surface& own = model_.surfaces[organ];
  std::vector<std::int32_t> own_vertex;
  if (is_cut) own_vertex = find_own_vertices(surface, own);
  for (surface::Body& body : bodies_) body.surface.begin(state.position);
  overlaps_.begin(state, model_.tick);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].organ != std::int32_t(organ)) continue;
    found_.clear();
    overlaps_.find(b, found_);
    const double radius = radius_of(bodies_[b], found_);
    for (const surface::Overlap& overlap : found_) {
      const std::int32_t v = own_vertex.empty() ? overlap.vertex : own_vertex[std::size_t(overlap.vertex)];
      if (v < 0) continue;
      vertex[std::size_t(v)] +=
          share_of_dent(model_, bodies_[b], *overlap.other, radius) * overlap.depth * overlap.axis;
    }
  }
}

/// Moves the vertices that the ball in a hand dents onto the ball.
void DrawnSurfaces::put_on_ball(std::size_t hand, std::size_t organ, const Surface& surface, bool is_cut,
                                const State& state, std::vector<Vec3>& vertex) const {
  const Hand& inputs = state.last_inputs.hand(hand);
  if (state.touched.empty() || inputs.tool < 0) return;
  const Tool& tool = model_.tools[std::size_t(inputs.tool)];
  if (tool.kind != ToolKind::ball || organ >= model_.surfaces.size()) return;
  std::int64_t first = std::int64_t(model_.touchable_count()) * cut_points_.kind_of_ball(hand);
  for (std::size_t i = 0; i < organ; ++i) first += std::int64_t(model_.surfaces[i].vertex.size());
  const std::int64_t last = first + std::int64_t(model_.surfaces[organ].vertex.size());
  const auto is_of_organ = [&](std::int32_t point) {
    return (point >= first && point < last) ||
           (cut_points_.is_of_ball(point, hand) && cut_points_.place(point).organ == organ);
  };
  // A cut surface has vertices of its own, of which the ball dents those in it.
  std::vector<char> is_touched(vertex.size(), 0);
  if (!is_cut) {
    for (const std::int32_t point : state.touched)
      if (is_of_organ(point)) is_touched[std::size_t(point - first)] = 1;
  } else if (std::any_of(state.touched.begin(), state.touched.end(), is_of_organ)) {
    for (std::size_t v = 0; v < vertex.size(); ++v) is_touched[v] = norm(vertex[v] - inputs.position) < tool.radius;
  }
  draw_dent(surface, inputs.position, tool.radius, is_touched, vertex);
}

}  // namespace ctpm::contact
