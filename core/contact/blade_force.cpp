#include "core/contact/blade_force.h"

#include <cmath>

namespace ctpm::contact {
namespace {

Vec3 across(Vec3 way, Vec3 v) { return v - dot(way, v) * way; }

}  // namespace

void BladeForce::find(const StateView& state, const Tool& tool, const cutting::CutFront& front,
                      const cutting::BladeEdge& edge, double h, bool is_predicted, std::size_t hand,
                      PointContacts& contacts) const {
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    const cutting::CutFront::Node& node = front.nodes()[n];
    if (node.length == 0) continue;
    const auto count = std::size_t(node.place.count);
    const Carriers carriers{{node.place.sphere.data(), count}, {node.place.weight.data(), count}};
    const Vec3 velocity = weighted(carriers, state.velocity), apart = at_node(edge, n) - node.place.at(state.position);
    const Vec3 expected = is_predicted ? apart : apart - h * velocity;
    const double distance = norm(expected);
    if (!(distance > 0)) continue;
    const Vec3 way = expected / distance;
    if (!cutting::leads(edge, n, way)) continue;
    const double most = front.hold(n, tool, state, along_node(edge, n), way);
    if (most == 0) continue;
    PointContact contact{.axis = way, .hand = std::int32_t(hand)};
    const double k = most / tool.trail_distance;
    if (distance > tool.trail_distance) {
      // The front goes on, and pulls with the same force however far, but not so that light tissue would overtake the
      // blade. Only its direction may still turn.
      contact.force = most * way;
      contact.apart = apart, contact.near_k = k;
      contact.drag = h * most / distance;
      if (!is_predicted) contact.force += contact.drag * across(way, h * velocity) / h;
    } else {
      contact.force = k * apart, contact.k = k, contact.drag = h * k;
    }
    // The drag stands for a stiffness: the tissue's velocity so far has nothing to do with it.
    if (is_predicted) contact.force += contact.drag * across(way, velocity);
    contacts.add(contact, carriers);
  }
}

}  // namespace ctpm::contact
