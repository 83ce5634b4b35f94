#include "core/contact/body_contact.h"

#include <algorithm>

namespace ctpm::contact {
namespace {

const std::vector<std::uint8_t> kNoneHidden;

}  // namespace

BodyContact::BodyContact(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts)
    : model_(model),
      bodies_(bodies),
      press_(model),
      cuts_(cuts),
      overlaps_(model, bodies),
      cut_overlaps_(model, bodies, cuts) {
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
  const bool is_cut = cut_overlaps_.any();
  if (is_cut) cut_overlaps_.begin();
  overlaps_.hide(is_cut && cut_overlaps_.replaces() ? cuts_.hidden() : kNoneHidden);
  overlaps_.begin(state, step.h);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    overlaps_.find(b, found_);
    double area = area_of(bodies_[b], found_);
    if (is_cut) {
      cut_overlaps_.find_on_body(b, found_);
      area = area_of(bodies_[b], found_);
      for (const auto& [patch, first, last] :
           cut_overlaps_.find_on_patches(std::size_t(bodies_[b].organ), found_on_patches_))
        area += area_of(patch->body, std::span(found_on_patches_).subspan(first, last - first));
    }
    const double radius = radius_of(area);
    press_.add(state, step, bodies_[b], points + bodies_[b].first_vertex, found_, radius, contacts);
    if (is_cut)
      for (const auto& [patch, first, last] : cut_overlaps_.on_patches())
        press_.add(state, step, patch->body, cuts_.first_point(1, *patch),
                   std::span(found_on_patches_).subspan(first, last - first), radius, contacts);
    found_.clear(), found_on_patches_.clear();
  }
}

}  // namespace ctpm::contact
