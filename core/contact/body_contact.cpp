#include "core/contact/body_contact.h"

#include <algorithm>

namespace ctpm::contact {

BodyContact::BodyContact(const Model& model, std::vector<surface::Body>& bodies)
    : model_(model), bodies_(bodies), press_(model), overlaps_(model, bodies) {
  if (overlaps_.empty()) return;
  std::size_t most_vertices = 0;
  for (const surface::Body& body : bodies) {
    most_vertices = std::max(most_vertices, body.surface.vertex_count());
    const auto [contacts, entries] = FacetPress::capacity(body, bodies);
    capacity_.first += contacts, capacity_.second += entries;
  }
  found_.reserve(most_vertices);
}

void BodyContact::find(const StateView& state, const PressStep& step, PointContacts& contacts) {
  if (overlaps_.empty()) return;
  const auto points = std::int32_t(model_.touchable_count());
  overlaps_.begin(state, step.h);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    overlaps_.find(b, found_);
    press_.add(state, step, bodies_[b], points + bodies_[b].first_vertex, found_, radius_of(bodies_[b], found_),
               contacts);
    found_.clear();
  }
}

}  // namespace ctpm::contact
