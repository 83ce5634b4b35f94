#include "core/contact/obstacle_contact.h"

#include <algorithm>
#include <utility>

#include "core/contact/contact_law.h"

namespace ctpm::contact {
ObstacleContact::ObstacleContact(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts)
    : model_(model), bodies_(bodies), cuts_(cuts), press_(model) {
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
    for (surface::Body& body : bodies_) find_on_surface(state, step, o, body, contacts);
    find_on_spheres(state, step, shapes_[o], first_point + vertex_count_, contacts);
  }
}

void ObstacleContact::find_on_surface(const StateView& state, const PressStep& step, std::size_t obstacle,
                                      surface::Body& body, PointContacts& contacts) {
  const surface::ObstacleShape& shape = shapes_[obstacle];
  const auto look_at = [&](surface::Body& part, const auto& is_new) {
    part.surface.near(shape, [&](const surface::NearSurface::Triangle& triangle, const Vec3* corners) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int32_t vertex = triangle.corner[c];
        if (!is_new(vertex)) continue;
        const surface::Inside inside = shape.inside(corners[c]);
        if (inside.depth > 0) overlaps_.push_back({part.facets.facet_of(vertex), vertex, inside.depth, inside.outward});
      }
    });
  };
  ++round_;
  look_at(body, [&](std::int32_t vertex) {
    return std::exchange(seen_in_[std::size_t(body.first_vertex + vertex)], round_) != round_ &&
           !cuts_.hides(body.first_vertex + vertex);
  });
  const std::size_t own = overlaps_.size();
  double area = area_of(body, overlaps_);
  cuts_.near(std::size_t(body.organ), shape, [&](cutbody::CutPatch& patch) {
    const std::size_t first = overlaps_.size();
    is_seen_.assign(patch.body.surface.vertex_count(), 0);
    look_at(patch.body, [&](std::int32_t vertex) { return !std::exchange(is_seen_[std::size_t(vertex)], 1); });
    area += area_of(patch.body, std::span(overlaps_).subspan(first));
    patches_.push_back({&patch, first, overlaps_.size()});
  });
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
