#include "core/surface/body_overlaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/surface/line_hit.h"

namespace ctpm::surface {
namespace {

/// How deep surfaces may overlap and still be found, in spacings (our choice): tissue at 10 m/s comes so far in a tick.
constexpr double kReach = 1;

/// The same where nothing touched before, besides the way that surfaces may have come (our choice), and how many times
/// the way of the fastest sphere that is: a surface may run ahead of its spheres.
constexpr double kNewReach = 0.1, kAhead = 2;

/// An organ meets parts of itself that were at rest this many spacings away, and this many times the overlap's depth
/// (our choice).
constexpr double kApartAtRest = 2, kApartOverDepth = 4;

/// Patches of one organ that are nearer than this at rest do not meet, in spacings: a fold so sharp is beyond the
/// spheres.
constexpr double kPatchesApart = 1;

double fastest(const OrganRange& organ, const Vec3Array& velocity) {
  double squared = 0;
  for (std::int32_t i = organ.first; i < organ.first + organ.count; ++i) {
    const Vec3 v = velocity[std::size_t(i)];
    squared = std::max(squared, dot(v, v));
  }
  return std::sqrt(squared);
}

}  // namespace

BodyOverlaps::BodyOverlaps(const Model& model, std::vector<Body>& bodies) : model_(model), bodies_(bodies) {
  bool meets = false;
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = 0; b < bodies.size(); ++b) meets = meets || may_meet(a, b);
  if (!meets) return;
  std::size_t most_vertices = 0, most_patches = 0;
  for (const Body& body : bodies) {
    patches_.emplace_back(body.surface);
    PatchFacets& facets = facets_.emplace_back();
    for (std::size_t p = 0; p < body.surface.patches().size(); ++p) {
      std::set<std::int32_t> touching;
      for (const std::int32_t vertex : patches_.back().vertices(std::int32_t(p)))
        touching.insert(body.facets.facet_of(vertex));
      facets.facet.insert(facets.facet.end(), touching.begin(), touching.end());
      facets.first.push_back(std::int32_t(facets.facet.size()));
    }
    Placed& placed = placed_.emplace_back();
    placed.round.resize(body.surface.patches().size()), placed.patch.resize(placed.round.size(), Box(Vec3{}));
    placed.triangle.resize(body.surface.triangles().size(), Box(Vec3{}));
    most_vertices = std::max(most_vertices, body.surface.vertex_count());
    most_patches = std::max(most_patches, body.surface.patches().size());
    is_touched_.resize(std::size_t(body.first_vertex) + body.surface.vertex_count());
  }
  lines_.resize(most_patches), hits_.resize(most_vertices), hit_vertices_.reserve(most_vertices);
  way_.resize(bodies.size()), was_touched_.resize(bodies.size());
  touched_.reserve(is_touched_.size()), reach_.reserve(most_patches),
      triangles_.reserve(NearSurface::kTrianglesPerPatch);
}

bool BodyOverlaps::may_meet(std::size_t body, std::size_t other) const {
  return body == other ? model_.organs[std::size_t(bodies_[body].organ)].meets_itself : model_.organs_meet;
}

void BodyOverlaps::begin() {
  reaches_far_ = true, ++placing_;
  for (NearPatches& patches : patches_) patches.begin();
}

void BodyOverlaps::begin(const StateView& state, double h) {
  begin();
  reaches_far_ = false;
  velocity_ = &state.velocity, h_ = h;
  std::fill(way_.begin(), way_.end(), std::nullopt);
  std::fill(was_touched_.begin(), was_touched_.end(), std::uint8_t(0));
  for (const std::int32_t facet : touched_) is_touched_[std::size_t(facet)] = 0;
  touched_.clear();
  const auto points = std::int32_t(model_.touchable_count());
  for (const std::int32_t point : state.touched) {
    if (point < points || point >= points + std::int32_t(is_touched_.size())) continue;
    touched_.push_back(point - points);
    is_touched_[std::size_t(point - points)] = 1;
    was_touched_[body_of(point - points)] = 1;
  }
}

/// The body to whose surface a facet belongs.
std::size_t BodyOverlaps::body_of(std::int32_t facet) const {
  const auto next = std::upper_bound(bodies_.begin(), bodies_.end(), facet,
                                     [](std::int32_t f, const Body& body) { return f < body.first_vertex; });
  return std::size_t(next - bodies_.begin()) - 1;
}

/// How far a body may have come in the step [m].
double BodyOverlaps::way_of(std::size_t body) {
  if (!way_[body]) way_[body] = h_ * fastest(model_.organs[std::size_t(bodies_[body].organ)], *velocity_);
  return *way_[body];
}

/// The smaller of two bodies' spacings [m].
double BodyOverlaps::finer_spacing(std::size_t body, std::size_t other) const {
  return std::min(model_.organs[std::size_t(bodies_[body].organ)].spacing,
                  model_.organs[std::size_t(bodies_[other].organ)].spacing);
}

void BodyOverlaps::find(std::size_t body, std::vector<Overlap>& overlaps) {
  const Body& own = bodies_[body];
  ++round_;
  hit_vertices_.clear();
  for (std::size_t other = 0; other < bodies_.size(); ++other)
    if (may_meet(body, other)) look(body, other);
  for (const std::int32_t vertex : hit_vertices_) {
    const Hit& hit = hits_[std::size_t(vertex)];
    if (hit.body == nullptr || !hit.is_exit || !is_far_at_rest(own, vertex, hit) || is_hidden(own, vertex)) continue;
    const auto& met = hit.body->surface.triangles()[std::size_t(hit.triangle)].corner;
    if (std::all_of(std::begin(met), std::end(met), [&](std::int32_t v) { return is_hidden(*hit.body, v); })) continue;
    overlaps.push_back({own.facets.facet_of(vertex),
                        vertex,
                        hit.distance,
                        hit.inwards,
                        hit.body,
                        hit.triangle,
                        {hit.at[0], hit.at[1], hit.at[2]}});
  }
}

/// Sets how deep overlaps of each patch of `body` with `other` are looked for [m].
void BodyOverlaps::set_reach(std::size_t body, std::size_t other) {
  const Body& own = bodies_[body];
  const double spacing = finer_spacing(body, other), far = kReach * spacing;
  const double near = reaches_far_ ? far : std::min(far, kNewReach * spacing + kAhead * (way_of(body) + way_of(other)));
  const auto was_touched = [&](std::int32_t facet) { return is_touched_[std::size_t(own.first_vertex + facet)] != 0; };
  const PatchFacets& facets = facets_[body];
  reach_.clear();
  for (std::size_t p = 0; p < own.surface.patches().size(); ++p) {
    const auto first = facets.facet.begin() + facets.first[p], last = facets.facet.begin() + facets.first[p + 1];
    reach_.push_back(was_touched_[body] != 0 && std::any_of(first, last, was_touched) ? far : near);
  }
}

/// Looks where the vertices of a body are inside another one, or inside itself.
void BodyOverlaps::look(std::size_t body, std::size_t other) {
  if (!patches_[body].all().grown(kReach * finer_spacing(body, other)).meets(patches_[other].all())) return;
  set_reach(body, other);
  ++look_;
  const double apart = kPatchesApart * model_.organs[std::size_t(bodies_[body].organ)].spacing;
  const auto &own = bodies_[body].surface.patches(), &others = bodies_[other].surface.patches();
  patches_[body].for_each_near(patches_[other], reach_, [&](std::int32_t p, std::int32_t q) {
    if (body == other && gap(own[std::size_t(p)].rest, others[std::size_t(q)].rest) < apart) return;
    look_at_patches(body, p, other, q);
  });
}

/// Where tissue is crushed its patches bound little at rest, so what the line from a vertex crosses is looked for among
/// triangles as they are. They are placed only for vertices that may be near some.
void BodyOverlaps::look_at_patches(std::size_t body, std::int32_t patch, std::size_t other, std::int32_t other_patch) {
  NearSurface& own = bodies_[body].surface;
  const double reach = reach_[std::size_t(patch)];
  Lines& lines = lines_[std::size_t(patch)];
  if (lines.look == look_ && !placed(other, other_patch).patch[std::size_t(other_patch)].meets(lines.box)) return;
  bool is_sought = false, has_all = true;
  for (const std::int32_t vertex : patches_[body].vertices(patch)) {
    if (hits_[std::size_t(vertex)].round != round_) {
      if (!std::exchange(is_sought, true)) seek_triangles(body, patch, other, other_patch);
      if (!may_be_near(body, patch, vertex)) {
        has_all = false;
        continue;
      }
    }
    Hit& hit = hit_of(body, vertex);
    const Vec3 from = own.place(vertex);
    const Box line(from, from + reach * hit.inwards);
    if (vertex == patches_[body].vertices(patch).front()) lines.box = line;
    lines.box.add(line.low), lines.box.add(line.high);
    const Placed& there = placed(other, other_patch);
    if (!there.patch[std::size_t(other_patch)].meets(line)) continue;
    const NearSurface::Bound& bound = bodies_[other].surface.patches()[std::size_t(other_patch)];
    for (std::int32_t t = bound.first; t < bound.last; ++t)
      if (there.triangle[std::size_t(t)].meets(line)) meet(from, reach, bodies_[other], t, hit);
  }
  if (has_all) lines.look = look_;
}

/// Finds the triangles of a patch to which vertices of another one may be near, at rest, moved by what the patches have
/// moved by at most.
void BodyOverlaps::seek_triangles(std::size_t body, std::int32_t patch, std::size_t other, std::int32_t other_patch) {
  NearPatches& others = patches_[other];
  const Box& others_by = others.displacements(other_patch);
  back_ = Box(-others_by.high, -others_by.low);
  triangles_.clear();
  others.for_each_triangle(other_patch, patches_[body].box(patch).grown(reach_[std::size_t(patch)]).moved(back_),
                           [&](std::int32_t t) { triangles_.push_back(others.rest_of_triangle(t)); });
  if (triangles_.empty()) return;
  all_triangles_ = triangles_.front();
  for (const Box& triangle : triangles_) all_triangles_.add(triangle.low), all_triangles_.add(triangle.high);
}

/// Whether a vertex of a patch may be near one of those triangles.
bool BodyOverlaps::may_be_near(std::size_t body, std::int32_t patch, std::int32_t vertex) {
  if (triangles_.empty()) return false;
  const Box rest(bodies_[body].surface.rest(vertex));
  const Box around = rest.moved(patches_[body].displacements(patch)).grown(reach_[std::size_t(patch)]).moved(back_);
  return around.meets(all_triangles_) &&
         std::any_of(triangles_.begin(), triangles_.end(), [&](const Box& triangle) { return triangle.meets(around); });
}

/// The boxes of a surface, with those of the patch in this round.
const BodyOverlaps::Placed& BodyOverlaps::placed(std::size_t body, std::int32_t patch) {
  Placed& placed = placed_[body];
  if (std::exchange(placed.round[std::size_t(patch)], placing_) == placing_) return placed;
  NearSurface& surface = bodies_[body].surface;
  const NearSurface::Bound& bound = surface.patches()[std::size_t(patch)];
  Box& all = placed.patch[std::size_t(patch)];
  for (std::int32_t t = bound.first; t < bound.last; ++t) {
    const auto& corner = surface.triangles()[std::size_t(t)].corner;
    Box& box = placed.triangle[std::size_t(t)];
    box = Box(surface.place(corner[0]), surface.place(corner[1]), surface.place(corner[2]));
    if (t == bound.first) all = box;
    all.add(box.low), all.add(box.high);
  }
  return placed;
}

/// The hit of a vertex in this round, whose search begins here if it has not begun.
BodyOverlaps::Hit& BodyOverlaps::hit_of(std::size_t body, std::int32_t vertex) {
  Hit& hit = hits_[std::size_t(vertex)];
  if (hit.round == round_) return hit;
  Body& own = bodies_[body];
  hit.round = round_, hit.body = nullptr, hit.distance = std::numeric_limits<double>::infinity();
  hit.inwards = -own.facets.normal(vertex, [&](std::int32_t v) { return own.surface.place(v); });
  hit_vertices_.push_back(vertex);
  return hit;
}

/// Updates `hit` if the line from `from` [m] meets a triangle nearer than before and nearer than `reach` [m]. Its box
/// meets that of the line.
void BodyOverlaps::meet(Vec3 from, double reach, Body& other, std::int32_t triangle, Hit& hit) const {
  NearSurface& surface = other.surface;
  const auto& corner = surface.triangles()[std::size_t(triangle)].corner;
  const Vec3 a = surface.place(corner[0]), b = surface.place(corner[1]), c = surface.place(corner[2]);
  const std::optional<LineHit> met = meet_line(from, hit.inwards, reach, a, b, c);
  if (!met || met->distance >= hit.distance) return;
  hit.distance = met->distance, hit.body = &other, hit.triangle = triangle, hit.is_exit = met->is_exit;
  std::copy(std::begin(met->at), std::end(met->at), std::begin(hit.at));
}

/// Whether what a vertex meets is no part of its own surroundings or of its organ's far side.
bool BodyOverlaps::is_far_at_rest(const Body& body, std::int32_t vertex, const Hit& hit) const {
  if (hit.body != &body) return true;
  const auto& corner = body.surface.triangles()[std::size_t(hit.triangle)].corner;
  Vec3 met;
  for (std::size_t c = 0; c < 3; ++c) met += hit.at[c] * body.surface.rest(corner[c]);
  const double apart = norm(met - body.surface.rest(vertex));
  return apart >=
         std::max(kApartAtRest * model_.organs[std::size_t(body.organ)].spacing, kApartOverDepth * hit.distance);
}

std::optional<DeepestOverlap> deepest_overlap(const Model& model, const Vec3Array& position) {
  std::vector<Body> bodies = bodies_of(model);
  BodyOverlaps overlaps(model, bodies);
  std::optional<DeepestOverlap> deepest;
  if (overlaps.empty()) return deepest;
  for (Body& body : bodies) body.surface.begin(position);
  overlaps.begin();
  std::vector<Overlap> found;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    found.clear();
    overlaps.find(b, found);
    for (const Overlap& overlap : found)
      if (!deepest || overlap.depth > deepest->depth)
        deepest = DeepestOverlap{bodies[b].organ, overlap.other->organ, overlap.depth,
                                 bodies[b].surface.place(overlap.vertex)};
  }
  return deepest;
}

}  // namespace ctpm::surface
