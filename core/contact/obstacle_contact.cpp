#include "core/contact/obstacle_contact.h"

#include <algorithm>

#include "core/contact/contact_law.h"

namespace ctpm::contact {
ObstacleContact::ObstacleContact(const Model& model, std::vector<surface::Body>& bodies)
    : model_(model), bodies_(bodies), press_(model) {
  if (model.obstacles.empty()) return;
  for (const Obstacle& obstacle : model.obstacles) shapes_.emplace_back(obstacle);
  for (const Surface& surface : model.surfaces) vertex_count_ += std::int32_t(surface.vertex.size());
  seen_in_.assign(std::size_t(vertex_count_), 0);
  overlaps_.reserve(std::size_t(vertex_count_));
  for (std::size_t i = 0; i < model.organs.size(); ++i) {
    if (i < model.surfaces.size() && !model.surfaces[i].triangle.empty()) continue;
    for (std::int32_t s = 0; s < model.organs[i].count; ++s) bare_.push_back(model.organs[i].first + s);
  }
  capacity_ = {bare_.size(), bare_.size()};
  for (const surface::Body& body : bodies) {
    const auto [contacts, entries] = FacetPress::capacity(body, {});
    capacity_.first += contacts, capacity_.second += entries;
  }
  capacity_.first *= model.obstacles.size(), capacity_.second *= model.obstacles.size();
}

void ObstacleContact::find(const StateView& state, const PressStep& step, PointContacts& contacts) {
  const auto points = std::int32_t(model_.touchable_count());
  for (std::size_t o = 0; o < shapes_.size(); ++o) {
    const auto first_point = std::int32_t(2 + o) * points;
    for (surface::Body& body : bodies_)
      find_on_surface(state, step, shapes_[o], first_point + body.first_vertex, body, contacts);
    find_on_spheres(state, step, shapes_[o], first_point + vertex_count_, contacts);
  }
}

void ObstacleContact::find_on_surface(const StateView& state, const PressStep& step,
                                      const surface::ObstacleShape& shape, std::int32_t first_point,
                                      surface::Body& body, PointContacts& contacts) {
  ++round_;
  const auto look_at = [&](const surface::NearSurface::Triangle& triangle, const Vec3* corners) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t vertex = triangle.corner[c];
      std::uint32_t& seen_in = seen_in_[std::size_t(body.first_vertex + vertex)];
      if (seen_in == round_) continue;
      seen_in = round_;
      const surface::Inside inside = shape.inside(corners[c]);
      if (inside.depth > 0) overlaps_.push_back({body.facets.facet_of(vertex), vertex, inside.depth, inside.outward});
    }
  };
  body.surface.near(shape, look_at);
  press_.add(state, step, body, first_point, overlaps_, contacts);
}

void ObstacleContact::find_on_spheres(const StateView& state, const PressStep& step,
                                      const surface::ObstacleShape& shape, std::int32_t first_point,
                                      PointContacts& contacts) const {
  for (const std::int32_t sphere : bare_) {
    const auto i = std::size_t(sphere);
    if (model_.held_axes[i] == kAnchored) continue;
    const surface::Inside inside = shape.inside(state.position[i]);
    const double depth = inside.depth + model_.contact_radius[i], whole = 1;
    if (depth <= 0) continue;
    PointContact contact{.axis = inside.outward, .point = first_point + sphere, .dent = depth};
    contact.foundation.k = model_.contact_k;
    contact.damping = contact_damping(model_.contact_damping, model_.contact_k, model_.mass[i], depth);
    press(state, model_.contact_friction, 1 / model_.mass[i],
          {.place = state.position[i],
           .start = step.from_velocity ? state.velocity[i] : Vec3{},
           .slip_guess = step.from_velocity ? Vec3{} : state.velocity[i]},
          step, contact);
    contacts.add(contact, {{&sphere, 1}, {&whole, 1}});
  }
}

}  // namespace ctpm::contact
