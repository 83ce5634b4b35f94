#include "core/contact/blade_force.h"

#include <algorithm>
#include <cmath>

#include "core/cutting/blade_geometry.h"

namespace ctpm::contact {
namespace {

Vec3 unit(Vec3 v) {
  const double length = norm(v);
  return length > 0 ? v / length : Vec3{};
}

Vec3 between(Vec3 tip, Vec3 heel, double across) { return tip + across * (heel - tip); }

/// Share of an element's resistance that the blade meets at `across` (0 to 1) of an edge of `length` that extends past
/// both ends of the blade by `beyond`. It falls linearly to 0 over twice `beyond`, so that tissue that slips past the
/// tip is released gently.
double held_share(double across, double length, double beyond) {
  return std::clamp(std::min(across, 1 - across) * length / (2 * beyond), 0.0, 1.0);
}

}  // namespace

struct BladeForce::Element {
  std::size_t a, b;
  double rest_length, k, energy, friction;

  /// Energy that a blade must supply [J] to open the `share` of the element's area that faces it, while the element is
  /// `length` long. The energy stored by tension contributes to the opening.
  double to_open(double share, double length) const {
    const double stretch = std::max(0.0, length - rest_length);
    return std::max(0.0, share * energy - 0.5 * k * stretch * stretch);
  }
};

BladeForce::BladeForce(const Model& model) : model_(model) {
  for (const OrganRange& organ : model.organs) widest_spacing_ = std::max(widest_spacing_, organ.spacing);
}

double BladeForce::reach(const Tool& tool) const {
  return std::max(tool.blade_reach, tool.blade_reach_spacings * widest_spacing_);
}

BladeForce::Element BladeForce::element(std::size_t index) const {
  const AxialElements& axial = model_.axial;
  return {std::size_t(axial.a[index]), std::size_t(axial.b[index]),         axial.rest_length[index],
          axial.slow_k(index),         model_.cut_resistance.energy[index], model_.cut_resistance.friction[index]};
}

cutting::Box BladeForce::around(const Tool& tool, const BladeMotion& motion) const {
  const double reach = this->reach(tool);
  return cutting::Box(motion.from.tip, motion.from.heel, motion.to.tip, motion.to.heel)
      .grown(0.5 * reach + std::max(reach, tool.flank_height));
}

void BladeForce::find(const StateView& state, const cutting::NearElements& near, const Tool& tool,
                      const BladeMotion& motion, PointContacts& contacts) const {
  const double reach = this->reach(tool);
  const Vec3 beyond = 0.5 * reach * unit(motion.to.heel - motion.to.tip);
  const Vec3 tip = motion.to.tip - beyond, heel = motion.to.heel + beyond, ht = unit(motion.heading_tip),
             hh = unit(motion.heading_heel);
  const double certainty = std::max(norm(motion.heading_tip), norm(motion.heading_heel));
  if (certainty == 0) return;
  const Vec3 tip_ahead = tip + reach * ht, heel_ahead = heel + reach * hh, tip_behind = tip - tool.flank_height * ht,
             heel_behind = heel - tool.flank_height * hh;
  const cutting::Box ahead(tip, heel, tip_ahead, heel_ahead), behind(tip, heel, tip_behind, heel_behind);
  for (const std::int32_t index : near.elements()) {
    const auto i = std::size_t(index);
    const bool severed = state.axial_severed[i] != 0;
    const Element e = element(i);
    const Vec3 p = state.position[e.a], q = state.position[e.b];
    if (!(severed ? behind : ahead).meets(cutting::Box(p, q))) continue;
    const auto hit = severed ? cutting::meet_sweep(p, q, tip, heel, tip_behind, heel_behind)
                             : cutting::meet_sweep(p, q, tip, heel, tip_ahead, heel_ahead);
    if (!hit) continue;
    const Vec3 heading = unit(between(ht, hh, hit->across));
    const Vec3 normal = unit(cross(heel - tip, heading));
    const double length = norm(q - p);
    const double facing = length > 0 ? std::abs(dot(normal, q - p)) / length : 0.0;
    const double held = facing * held_share(hit->across, norm(heel - tip), 0.5 * reach);
    const Vec3 point_velocity = (1 - hit->along) * state.velocity[e.a] + hit->along * state.velocity[e.b];
    PointContact contact{.is_tool = true};
    const Vec3 path = between(motion.to.tip - motion.from.tip, motion.to.heel - motion.from.heel, hit->across);
    if (severed) {
      const double on_flank = std::clamp(1 - (length - e.rest_length) / tool.blade_thickness, 0.0, 1.0);
      const Vec3 blade = path / model_.tick;
      const Vec3 slip = blade - point_velocity;
      const double speed = norm(slip - dot(slip, normal) * normal);
      contact.axis = normal;
      contact.drag = e.friction * held * on_flank / std::max(speed, tool.slowest_slip);
      contact.force = contact.drag * (blade - dot(blade, normal) * normal);
      if (contact.drag == 0) continue;
    } else {
      // The energy is G p^2 with p = 1 - distance / reach. The force is its growth over the advance in the tick; for a
      // short advance it is 2 G p / reach.
      const double energy = e.to_open(held * certainty, length), p = 1 - hit->share;
      const double advance = std::max(0.0, dot(path, heading)) / reach, p_before = std::max(0.0, p - advance);
      const double entered = advance > p ? p / advance : 1.0;
      contact.axis = heading, contact.only_pushes = true;
      contact.k = 2 * energy / (reach * reach), contact.force = energy / reach * (p + p_before) * entered * heading;
      // Tissue that moves away faster than the blade follows would be dropped later, at the cost of a second solve.
      if (dot(heading, contact.force - model_.tick * contact.k * point_velocity) <= 0) continue;
    }
    contacts.add(contact, std::int32_t(e.a), std::int32_t(e.b), 1 - hit->along, hit->along);
  }
}

void BladeForce::add_severed(const StateView& state, const Tool& tool, const BladeMotion& motion,
                             std::span<const cutting::Crossing> crossings, PointContacts& contacts) const {
  const double reach = this->reach(tool);
  for (const cutting::Crossing& crossing : crossings) {
    const Element e = element(std::size_t(crossing.element));
    const Vec3 path = between(motion.to.tip - motion.from.tip, motion.to.heel - motion.from.heel, crossing.across);
    const double length = norm(path), apart = norm(state.position[e.b] - state.position[e.a]);
    if (length == 0 || apart == 0) continue;
    const Vec3 edge = between(motion.from.heel - motion.from.tip, motion.to.heel - motion.to.tip, crossing.share);
    const double facing = std::abs(dot(unit(cross(edge, path)), state.position[e.b] - state.position[e.a])) / apart;
    const double resisted = std::max(0.0, 1 - crossing.share * length / reach);
    const double blade = norm(edge) + reach, across = (crossing.across * norm(edge) + 0.5 * reach) / blade;
    const double held = facing * held_share(across, blade, 0.5 * reach);
    const double remaining = e.to_open(held, apart) * (1 - resisted * resisted);
    if (remaining == 0) continue;
    contacts.add({.axis = path / length, .force = remaining / (length * length) * path, .is_tool = true},
                 std::int32_t(e.a), std::int32_t(e.b), 1 - crossing.along, crossing.along);
  }
}

}  // namespace ctpm::contact
