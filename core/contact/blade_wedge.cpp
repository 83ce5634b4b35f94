#include "core/contact/blade_wedge.h"

#include <algorithm>
#include <cmath>

namespace ctpm::contact {
namespace {

/// Where they press with the tissue's modulus, the springs yield by so much (our choice): so little that tissue closes
/// the blade's width by some percent on any lattice, and not so little that the solve suffers [m].
constexpr double kYields = 0.06e-3;

/// Pressure of tissue that opens, in moduli per opening in spacings (our choice): about what the elements of a lattice
/// show, so that the energy of springs that are softer rises evenly on a blade's way in.
constexpr double kTissue = 40;

/// Faces that pass through each other farther than this are pushed apart no harder (our choice) [spacings].
constexpr double kMostClosed = 0.5;

/// Places on the flanks are not much closer than this [spacings]: closer ones would press the same spheres.
constexpr double kApart = 0.25;

/// Half of the way over which a change along the flanks is measured [m].
constexpr double kNudge = 0.05e-3;

}  // namespace

double local_thickness(const Tool& scalpel, double behind) {
  return std::min(scalpel.blade_thickness, std::max(0.0, behind / kBevel));
}

/// What of the flanks a node of the edge stands for.
struct BladeWedge::Flank {
  std::size_t organ;
  const Tool& tool;
  Vec3 up, back;                ///< along the edge and across it on the flanks, unit vectors in the world
  Vec3 edge{};                  ///< the node of the edge [m]
  Vec3 rest{};                  ///< where the tissue at rest is that is at the edge [m]
  Vec3 rest_up{}, rest_back{};  ///< moves at rest that move the place by `up` and `back`
  Vec3 normal{};                ///< of the flanks at rest, unit vector
  double height = 0;            ///< of the flanks [m]
  double along = 0;             ///< of the places from the tip [m]
  double apart = 0;             ///< from these places to the next along the edge [m]
  double rows = 0;              ///< of places behind the edge
  double width = 0;             ///< of the flanks' strip at rest [m]
};

/// Adds the contact of one place on the flanks; returns its force on the tissue along them [N].
Vec3 BladeWedge::press(const StateView& state, const cutting::CutFront& front, const Flank& flank, std::size_t row,
                       PointContacts& contacts) const {
  const OrganRange& organ = model_.organs[flank.organ];
  const double behind = (double(row) + 0.5) / flank.rows * flank.height;
  // The point is ground at 45 degrees.
  const auto resolved = [&](double distance) { return std::clamp(2 * distance / organ.spacing, 0.0, 1.0); };
  const double share = organ.modulus > 0 ? resolved(behind) * resolved(flank.along - behind) : 0.0;
  const Vec3 rest = flank.rest + behind * flank.rest_back;
  // As deep as both the place and the edge before it: the springs go before the edge leaves the tissue.
  const auto in_at = [&](Vec3 by) {
    return front.in_tissue(flank.organ, rest + by) * front.in_tissue(flank.organ, flank.rest + by);
  };
  const double in_tissue = share > 0 ? in_at({}) : 0.0;
  if (!(in_tissue > 0)) return {};
  const double in_cut = front.in_cut(flank.organ, rest);
  if (!(in_cut > 0)) return {};
  cutting::Opening opening;
  const Vec3 point = flank.edge + behind * flank.back;
  front.find_opening(flank.organ, rest, flank.normal, state.position, point, opening);
  if (!(opening.whole > 0)) return {};
  const Vec3 across = cross(flank.up, flank.back);
  const auto count = std::size_t(opening.count);
  cutting::Opening::Values off_cut;
  for (std::size_t i = 0; i < count; ++i)
    off_cut[i] = dot(across, state.position[std::size_t(opening.sphere[i])]) - opening.apart[i];
  const Carriers carriers{{opening.sphere.data(), count}, {opening.weight.data(), count}};
  const double closed =
      std::min(local_thickness(flank.tool, behind) - opening.jump(off_cut), kMostClosed * organ.spacing);
  if (!(closed > 0)) return {};
  const double area = share * in_cut * opening.whole * flank.width * flank.height / flank.rows;
  const double whole = organ.modulus / kYields * area, entry = kTissue * organ.modulus / organ.spacing * area;
  const double k = 1 / (1 / whole + (1 / in_tissue - 1) / entry);
  contacts.add({.axis = across, .force = k * closed * across, .k = k, .only_pushes = true}, carriers);

  // What the energy k / 2 closed^2 changes by while the blade moves along its flanks.
  const Vec3 change = opening.change(off_cut);
  const auto force_along = [&](Vec3 move) {
    double deeper = 0;
    if (in_tissue < 1) deeper = (in_at(kNudge * move) - in_at(-kNudge * move)) / (2 * kNudge);
    const double stiffer = (k / in_tissue) * (k / in_tissue) / entry * deeper;
    return 0.5 * stiffer * closed * closed - k * closed * dot(change, move);
  };
  return force_along(flank.rest_up) * flank.up + force_along(flank.rest_back) * flank.back;
}

void BladeWedge::find(const StateView& state, const Tool& tool, const cutting::CutFront& front,
                      const cutting::BladeEdge& edge, std::size_t hand, PointContacts& contacts) const {
  const double length = norm(edge.heel - edge.tip);
  const Vec3 up = (edge.heel - edge.tip) / length, point = edge.back - edge.tip;
  const Vec3 behind = point - dot(point, up) * up;
  const double height = norm(behind);
  if (!(height > 0)) return;
  const double apart = length / double(kEdgeNodes - 1 - cutting::kPointNodes);
  for (std::size_t n = cutting::kPointNodes; n < kEdgeNodes; ++n) {
    const cutting::CutFront::Node& node = front.nodes()[n];
    if (node.organ < 0 || node.place.count == 0) continue;
    const double least = kApart * model_.organs[std::size_t(node.organ)].spacing;
    const auto stride = std::size_t(std::max(1.0, std::floor(least / apart + 0.5)));
    if ((n - cutting::kPointNodes) % stride != 0) continue;
    Flank flank{std::size_t(node.organ), tool, up, behind / height};
    flank.height = height, flank.rows = std::clamp(std::floor(height / least + 0.5), 1.0, double(kRows));
    flank.along = double(n - cutting::kPointNodes) * apart, flank.apart = double(stride) * apart;
    flank.edge = at_node(edge, n);
    flank.rest = front.rest(n) + node.place.at_rest(state.position, at_node(edge, n) - node.place.at(state.position));
    flank.rest_up = node.place.at_rest(state.position, flank.up);
    flank.rest_back = node.place.at_rest(state.position, flank.back);
    flank.normal = cross(flank.rest_up, flank.rest_back);
    const double size = norm(flank.normal);
    if (!(size > 0)) continue;
    flank.normal = flank.normal / size;
    flank.width = norm(flank.rest_up) * flank.apart;
    Vec3 along;
    for (std::size_t row = 0; double(row) < flank.rows; ++row) along += press(state, front, flank, row, contacts);
    if (along == Vec3{}) continue;
    const auto count = std::size_t(node.place.count);
    contacts.add({.axis = up, .force = along, .hand = std::int32_t(hand)},
                 {{node.place.sphere.data(), count}, {node.place.weight.data(), count}});
  }
}

}  // namespace ctpm::contact
