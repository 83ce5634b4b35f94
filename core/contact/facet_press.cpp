#include "core/contact/facet_press.h"

#include <algorithm>
#include <cmath>

#include "core/contact/contact_law.h"
#include "core/surface/surface.h"

namespace ctpm::contact {
namespace {

using surface::Body, surface::Overlap;

constexpr double kPi = 3.14159265358979323846;

std::size_t most_followed(const Body& body) {
  std::size_t most = 0;
  for (std::size_t v = 0; v < body.surface.vertex_count(); ++v)
    most = std::max(most, body.surface.follower(std::int32_t(v)).sphere.size());
  return most;
}

}  // namespace

std::pair<std::size_t, std::size_t> FacetPress::capacity(const Body& body, const std::vector<Body>& bodies) {
  std::size_t facets = 0, entries = 0, others = 0;
  for (const Body& other : bodies) others = std::max(others, most_followed(other));
  for (std::size_t v = 0; v < body.surface.vertex_count(); ++v) {
    const auto vertex = std::int32_t(v);
    facets += body.facets.facet_of(vertex) == vertex;
    entries += body.surface.follower(vertex).sphere.size() + 3 * others;
  }
  return {facets, entries};
}

void FacetPress::add(const StateView& state, const PressStep& step, const Body& body, std::int32_t first_point,
                     std::vector<Overlap>& overlaps, PointContacts& contacts) {
  std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
    return a.facet != b.facet ? a.facet < b.facet : a.vertex < b.vertex;
  });
  double area = 0;
  for (const Overlap& overlap : overlaps) area += body.facets.area(overlap.vertex);
  const double radius = std::sqrt(area / kPi);
  for (std::size_t begin = 0; begin < overlaps.size();) {
    std::size_t end = begin + 1;
    while (end < overlaps.size() && overlaps[end].facet == overlaps[begin].facet) ++end;
    add_facet(state, step, body, first_point + overlaps[begin].facet, radius,
              std::span(overlaps).subspan(begin, end - begin), contacts);
    begin = end;
  }
  overlaps.clear();
}

/// Pressure per depth of a dent in a body [Pa/m]; see dent_stiffness().
double FacetPress::stiffness(const Body& body, double radius) const {
  const OrganRange& organ = model_.organs[std::size_t(body.organ)];
  return dent_stiffness(organ.modulus, radius, surface::kUnresolvedLength * organ.spacing);
}

void FacetPress::add_facet(const StateView& state, const PressStep& step, const Body& body, std::int32_t point,
                           double radius, std::span<const Overlap> overlaps, PointContacts& contacts) {
  double area = 0, total = 0;
  Vec3 volume;
  for (const Overlap& overlap : overlaps) {
    const double own = body.facets.area(overlap.vertex);
    area += own, total += own * overlap.depth, volume += own * overlap.depth * overlap.axis;
  }
  const double pushed = norm(volume);
  if (!(pushed > 0)) return;
  // Of several other bodies, the one at the first vertex counts.
  const Body* other = overlaps.front().other;
  carriers_.clear();
  for (const Overlap& overlap : overlaps) {
    const double share = body.facets.area(overlap.vertex) * overlap.depth / total;
    carriers_.add(body.surface.follower(overlap.vertex), share);
    if (overlap.other == nullptr) continue;
    const auto& corner = overlap.other->surface.triangles()[std::size_t(overlap.triangle)].corner;
    for (std::size_t c = 0; c < 3; ++c)
      carriers_.add(overlap.other->surface.follower(corner[c]), -share * overlap.at[c]);
  }
  const Carriers carriers = carriers_.get();
  const double mobility = contacts.mobility(carriers);
  if (!(mobility > 0)) return;
  PointContact contact{.axis = volume / pushed, .point = point, .dent = pushed / area};
  const double own = stiffness(body, radius);
  if (other == nullptr) {
    contact.foundation = Foundation(model_.organs[std::size_t(body.organ)], own * area, step.elapsed);
  } else {
    const double others = stiffness(*other, radius);
    contact.foundation.k = 0.5 * area * own * others / (own + others);
  }
  contact.damping = contact_damping(model_.contact_damping, contact.foundation.k, 1 / mobility, contact.dent);
  const Vec3 velocity = weighted(carriers, state.velocity);
  press(state, model_.contact_friction, mobility,
        {.place = weighted(carriers, state.position),
         .start = step.from_velocity ? velocity : Vec3{},
         .slip_guess = step.from_velocity ? Vec3{} : velocity},
        step, contact);
  contacts.add(contact, carriers);
}

}  // namespace ctpm::contact
