#include "core/contact/body_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ctpm::contact {
namespace {

/// How deep surfaces may overlap and still be found, in spacings (our choice): tissue at 10 m/s comes so far in a tick.
constexpr double kReach = 1;

/// An organ meets parts of itself that were at rest this many spacings away, and this many times the overlap's depth
/// (our choice).
constexpr double kApartAtRest = 2, kApartOverDepth = 4;

/// Patches of one organ that are nearer than this at rest do not meet, in spacings: a fold so sharp is beyond the
/// spheres.
constexpr double kPatchesApart = 1;

}  // namespace

BodyContact::BodyContact(const Model& model, std::vector<Body>& bodies)
    : model_(model), bodies_(bodies), press_(model) {
  bool meets = false;
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = 0; b < bodies.size(); ++b) meets = meets || may_meet(a, b);
  if (!meets) return;
  std::size_t most_vertices = 0;
  for (const Body& body : bodies) {
    patches_.emplace_back(body.surface);
    most_vertices = std::max(most_vertices, body.surface.vertex_count());
    const auto [contacts, entries] = FacetPress::capacity(body, bodies);
    capacity_.first += contacts, capacity_.second += entries;
  }
  hits_.resize(most_vertices), hit_vertices_.reserve(most_vertices), overlaps_.reserve(most_vertices);
}

bool BodyContact::may_meet(std::size_t body, std::size_t other) const {
  return body == other ? model_.organs[std::size_t(bodies_[body].organ)].meets_itself : model_.organs_meet;
}

/// Greatest depth of an overlap that is found [m].
double BodyContact::reach_of(std::size_t body, std::size_t other) const {
  return kReach * std::min(model_.organs[std::size_t(bodies_[body].organ)].spacing,
                           model_.organs[std::size_t(bodies_[other].organ)].spacing);
}

void BodyContact::find(const StateView& state, const PressStep& step, PointContacts& contacts) {
  if (patches_.empty()) return;
  const auto points = std::int32_t(model_.touchable_count());
  begin(state.position);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    find_overlaps(state.position, b);
    press_.add(state, step, bodies_[b], points + bodies_[b].first_vertex, overlaps_, contacts);
  }
}

std::optional<BodyContact::Deepest> BodyContact::deepest(const Vec3Array& position) {
  std::optional<Deepest> deepest;
  if (patches_.empty()) return deepest;
  begin(position);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    find_overlaps(position, b);
    for (const Overlap& overlap : overlaps_)
      if (!deepest || overlap.depth > deepest->depth)
        deepest = Deepest{bodies_[b].organ, overlap.other->organ, overlap.depth,
                          bodies_[b].surface.place(overlap.vertex, position)};
    overlaps_.clear();
  }
  return deepest;
}

void BodyContact::begin(const Vec3Array& position) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b].surface.begin(), patches_[b].begin(position);
}

/// Finds the overlaps of one body.
void BodyContact::find_overlaps(const Vec3Array& position, std::size_t body) {
  const Body& own = bodies_[body];
  ++round_;
  hit_vertices_.clear();
  for (std::size_t other = 0; other < bodies_.size(); ++other)
    if (may_meet(body, other)) look(position, body, other);
  for (const std::int32_t vertex : hit_vertices_) {
    const Hit& hit = hits_[std::size_t(vertex)];
    if (hit.body == nullptr || !hit.is_exit || !is_far_at_rest(own, vertex, hit)) continue;
    overlaps_.push_back({own.facets.facet_of(vertex),
                         vertex,
                         hit.distance,
                         hit.inwards,
                         hit.body,
                         hit.triangle,
                         {hit.at[0], hit.at[1], hit.at[2]}});
  }
}

/// Looks where the vertices of a body are inside another one, or inside itself.
void BodyContact::look(const Vec3Array& position, std::size_t body, std::size_t other) {
  const double apart = kPatchesApart * model_.organs[std::size_t(bodies_[body].organ)].spacing;
  const auto &own = bodies_[body].surface.patches(), &others = bodies_[other].surface.patches();
  patches_[body].for_each_near(patches_[other], reach_of(body, other), [&](std::int32_t p, std::int32_t q) {
    if (body == other && gap(own[std::size_t(p)].rest, others[std::size_t(q)].rest) < apart) return;
    look_at_patches(position, body, p, other, q);
  });
}

void BodyContact::look_at_patches(const Vec3Array& position, std::size_t body, std::int32_t patch, std::size_t other,
                                  std::int32_t other_patch) {
  Body& own = bodies_[body];
  const auto place = [&](std::int32_t vertex) { return own.surface.place(vertex, position); };
  const double reach = reach_of(body, other);
  const Box box = patches_[other].patch(other_patch);
  const surface::NearSurface::Bound& bound = bodies_[other].surface.patches()[std::size_t(other_patch)];
  for (const std::int32_t vertex : patches_[body].vertices(patch)) {
    const Vec3 from = place(vertex);
    if (!Box(from).grown(reach).meets(box)) continue;
    Hit& hit = hits_[std::size_t(vertex)];
    if (hit.round != round_) {
      hit.round = round_, hit.body = nullptr, hit.distance = std::numeric_limits<double>::infinity();
      hit.inwards = -own.facets.normal(vertex, place);
      hit_vertices_.push_back(vertex);
    }
    if (!Box(from, from + reach * hit.inwards).meets(box)) continue;
    for (std::int32_t t = bound.first; t < bound.last; ++t) meet(position, from, reach, bodies_[other], t, hit);
  }
}

/// Updates `hit` if the line from `from` [m] meets a triangle nearer than before and nearer than `reach` [m] (Moller &
/// Trumbore, "Fast, minimum storage ray/triangle intersection", 1997).
void BodyContact::meet(const Vec3Array& position, Vec3 from, double reach, Body& other, std::int32_t triangle,
                       Hit& hit) {
  surface::NearSurface& surface = other.surface;
  const auto& corner = surface.triangles()[std::size_t(triangle)].corner;
  const Vec3 a = surface.place(corner[0], position), b = surface.place(corner[1], position),
             c = surface.place(corner[2], position);
  if (!Box(from, from + reach * hit.inwards).meets(Box(a, b, c))) return;
  const Vec3 ab = b - a, ac = c - a, p = cross(hit.inwards, ac);
  const double facing = dot(ab, p);
  if (facing == 0) return;
  const Vec3 t = from - a, q = cross(t, ab);
  const double v = dot(t, p) / facing, w = dot(hit.inwards, q) / facing, distance = dot(ac, q) / facing;
  if (v < 0 || w < 0 || v + w > 1 || distance <= 0 || distance > reach || distance >= hit.distance) return;
  hit.distance = distance, hit.body = &other, hit.triangle = triangle;
  hit.at[0] = 1 - v - w, hit.at[1] = v, hit.at[2] = w;
  hit.is_exit = facing < 0;
}

/// Whether what a vertex meets is no part of its own surroundings or of its organ's far side.
bool BodyContact::is_far_at_rest(const Body& body, std::int32_t vertex, const Hit& hit) const {
  if (hit.body != &body) return true;
  const auto& corner = body.surface.triangles()[std::size_t(hit.triangle)].corner;
  Vec3 met;
  for (std::size_t c = 0; c < 3; ++c) met += hit.at[c] * body.surface.rest(corner[c]);
  const double apart = norm(met - body.surface.rest(vertex));
  return apart >=
         std::max(kApartAtRest * model_.organs[std::size_t(body.organ)].spacing, kApartOverDepth * hit.distance);
}

}  // namespace ctpm::contact
