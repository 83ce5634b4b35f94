#include "core/contact/obstacle_contact.h"

#include <algorithm>
#include <span>

#include "core/contact/contact_law.h"

namespace ctpm::contact {
ObstacleContact::ObstacleContact(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts)
    : model_(model), bodies_(bodies), cuts_(cuts), press_(model) {
  if (model.obstacles.empty()) return;
  for (const Obstacle& obstacle : model.obstacles) shapes_.emplace_back(obstacle);
  for (const surface::ObstacleShape& shape : shapes_)
    for (surface::Body& body : bodies) near_.emplace_back(model, body, shape, cuts);
  for (const Surface& surface : model.surfaces) vertex_count_ += std::int32_t(surface.vertex.size());
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
    for (surface::Body& body : bodies_) find_on_surface(state, step, o, body, contacts);
    find_on_spheres(state, step, shapes_[o], first_point + vertex_count_, contacts);
  }
}

void ObstacleContact::find_on_surface(const StateView& state, const PressStep& step, std::size_t obstacle,
                                      surface::Body& body, PointContacts& contacts) {
  NearObstacle& near = near_[obstacle * bodies_.size() + std::size_t(&body - bodies_.data())];
  std::size_t own = 0;
  double area = 0;
  const std::vector<NearObstacle::Found>& found = near.find(state.position);
  for (auto begin = found.begin(); begin != found.end();) {
    const auto end = std::find_if(begin, found.end(), [&](const auto& f) { return f.part != begin->part; });
    const NearObstacle::Part& part = near.parts()[std::size_t(begin->part)];
    const std::size_t first = overlaps_.size();
    for (; begin != end; ++begin)
      overlaps_.push_back(
          {part.body->facets.facet_of(begin->vertex), begin->vertex, begin->inside.depth, begin->inside.outward});
    area += area_of(*part.body, std::span(overlaps_).subspan(first));
    if (part.patch == nullptr)
      own = overlaps_.size();
    else
      patches_.push_back({part.patch, first, overlaps_.size()});
  }
  const std::span<surface::Overlap> all(overlaps_);
  const double radius = radius_of(area);
  const auto kind = std::int32_t(2 + obstacle);
  press_.add(state, step, body, kind * std::int32_t(model_.touchable_count()) + body.first_vertex, all.first(own),
             radius, contacts);
  for (const auto& [patch, first, last] : patches_)
    press_.add(state, step, patch->body, cuts_.first_point(kind, *patch), all.subspan(first, last - first), radius,
               contacts);
  overlaps_.clear(), patches_.clear();
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
