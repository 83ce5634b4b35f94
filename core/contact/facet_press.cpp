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

/// Pressure per depth of a dent in a body [Pa/m]; see dent_stiffness().
double stiffness(const Model& model, const Body& body, double radius) {
  const OrganRange& organ = model.organs[std::size_t(body.organ)];
  return dent_stiffness(organ.modulus, radius, surface::kUnresolvedLength * organ.spacing);
}

}  // namespace

double area_of(const Body& body, std::span<const Overlap> overlaps) {
  double area = 0;
  for (const Overlap& overlap : overlaps) area += body.facets.area(overlap.vertex);
  return area;
}

double radius_of(double area) { return std::sqrt(area / kPi); }
double radius_of(const Body& body, std::span<const Overlap> overlaps) { return radius_of(area_of(body, overlaps)); }

double share_of_dent(const Model& model, const Body& body, const Body& other, double radius) {
  const double own = stiffness(model, body, radius), others = stiffness(model, other, radius);
  return own + others > 0 ? others / (own + others) : 0.5;
}

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
                     std::span<Overlap> overlaps, double radius, PointContacts& contacts) {
  std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
    return a.facet != b.facet ? a.facet < b.facet : a.vertex < b.vertex;
  });
  for (std::size_t begin = 0; begin < overlaps.size();) {
    std::size_t end = begin + 1;
    while (end < overlaps.size() && overlaps[end].facet == overlaps[begin].facet) ++end;
    add_facet(state, step, body, first_point + overlaps[begin].facet, radius, overlaps.subspan(begin, end - begin),
              contacts);
    begin = end;
  }
}

/// Gathers what carries the contact of a facet: the mean of its vertices' places, weighted with volumes, minus that of
/// the places that they meet. Both are moved to where the two dents meet, so that forces have no moment.
void FacetPress::add_carriers(const StateView& state, double radius, const Body& body,
                              std::span<const Overlap> overlaps) {
  double total = 0;
  for (const Overlap& overlap : overlaps) total += body.facets.area(overlap.vertex) * overlap.depth;
  carriers_.clear();
  for (const Overlap& overlap : overlaps)
    carriers_.add(body.surface.follower(overlap.vertex), body.facets.area(overlap.vertex) * overlap.depth / total);
  if (overlaps.front().other == nullptr) return;
  others_.clear();
  for (const Overlap& overlap : overlaps) {
    const double share = body.facets.area(overlap.vertex) * overlap.depth / total;
    const auto& corner = overlap.other->surface.triangles()[std::size_t(overlap.triangle)].corner;
    for (std::size_t c = 0; c < 3; ++c) others_.add(overlap.other->surface.follower(corner[c]), share * overlap.at[c]);
  }
  const Vec3 apart = weighted(others_.get(), state.position) - weighted(carriers_.get(), state.position);
  const double share = share_of_dent(model_, body, *overlaps.front().other, radius);
  carriers_.move(state.position, share * apart), others_.move(state.position, (share - 1) * apart);
  carriers_.add(others_.get(), -1);
}

void FacetPress::add_facet(const StateView& state, const PressStep& step, const Body& body, std::int32_t point,
                           double radius, std::span<const Overlap> overlaps, PointContacts& contacts) {
  double area = 0;
  Vec3 volume;
  for (const Overlap& overlap : overlaps) {
    const double own = body.facets.area(overlap.vertex);
    area += own, volume += own * overlap.depth * overlap.axis;
  }
  const double pushed = norm(volume);
  if (!(pushed > 0)) return;
  add_carriers(state, radius, body, overlaps);
  const Carriers carriers = carriers_.get();
  const double mobility = contacts.mobility(carriers);
  if (!(mobility > 0)) return;
  PointContact contact{.axis = volume / pushed, .point = point, .dent = pushed / area};
  // Of several other bodies, the one at the first vertex counts.
  const Body* const other = overlaps.front().other;
  const double own = stiffness(model_, body, radius);
  if (other == nullptr)
    contact.foundation = Foundation(model_.organs[std::size_t(body.organ)], own * area, step.elapsed);
  else
    contact.foundation.k = 0.5 * area * own * share_of_dent(model_, body, *other, radius);
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
