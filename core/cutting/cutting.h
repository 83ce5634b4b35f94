#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/cutting/swept_surface.h"
#include "core/cutting/tissue_depth.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::cutting {

/// What a blade cuts with, in the world: its edge from the tip to the heel, and the point from the tip to its back,
/// with which a stab along the edge cuts a slit as wide as the blade.
struct BladeEdge {
  Vec3 tip, heel, back;  ///< [m]
};

/// Nodes of State::blade_trail up to the tip: the first is at the blade's back, the last of all at the heel.
inline constexpr std::size_t kPointNodes = 6;

/// Place of a node.
Vec3 at_node(const BladeEdge& edge, std::size_t node);
/// Direction of the edge or the point at a node, of any length; that of the edge at the tip.
inline Vec3 along_node(const BladeEdge& edge, std::size_t node) {
  return node < kPointNodes ? edge.tip - edge.back : edge.heel - edge.tip;
}
/// Whether a node that goes `way` cuts. The point only trails behind the edge, unless the blade goes forwards along it.
inline bool leads(const BladeEdge& edge, std::size_t node, Vec3 way) {
  if (node >= kPointNodes) return true;
  const Vec3 point = edge.tip - edge.back, up = edge.heel - edge.tip;
  return dot(way, up - dot(up, point) / dot(point, point) * point) < 0;
}

/// The edge of a scalpel at the pose of a hand.
BladeEdge blade_edge(const Tool& scalpel, const Hand& hand);

/// The crossing of an element by the front of a cut, which has just severed it.
struct Crossing {
  std::int32_t element;  ///< row of Model::axial
  double along;          ///< position along the element, 0 at its first sphere to 1 at its second
};

/// The axial elements by the spheres that they begin at, and where the tissue is that they stand for.
class RestElements {
 public:
  /// Elements lie between the spheres at rest.
  explicit RestElements(const Model& model);
  /// A lattice covers its organ: a sphere outside the organ's surface, or on the boundary of an organ without one,
  /// stands for the tissue next to it inside. So elements lie between places that are in tissue.
  /// `only`: the one organ of which that is so, as the depth may know no other.
  RestElements(const Model& model, const TissueDepth& depth, std::optional<std::size_t> only = {});

  /// Where the tissue of a sphere is at rest [m].
  Vec3 place(std::size_t sphere) const { return place_[sphere]; }

  /// No element is longer between such places [m].
  double longest() const { return longest_; }

  /// Rows of Model::axial that begin or end at a sphere.
  std::span<const std::int32_t> of(std::size_t sphere) const {
    const auto begin = std::size_t(first_[sphere]), end = std::size_t(first_[sphere + 1]);
    return {elements_.data() + begin, end - begin};
  }

 private:
  void find_longest(const AxialElements& axial);

  std::vector<std::int32_t> first_, elements_;
  std::vector<Vec3> place_;  ///< (sphere_count)
  double longest_ = 0;
};

/// Marks every element of an organ in `severed`, between the places of its spheres, that the front crosses where it is
/// `newly` swept while it goes `from`-`to`, so that the elements are those that the swept surface crosses. Between two
/// nodes the front sweeps the two triangles (p, q, p') and (q, q', p'). Touching counts as crossing, so nothing slips
/// between two ticks or two nodes. Appends those that were not marked before to `crossings`.
void find_severed(const Model& model, const RestElements& elements, std::size_t organ, const Front& from,
                  const Front& to, const NewlySwept& newly, std::vector<std::uint8_t>& severed,
                  std::vector<Crossing>& crossings);

/// Severs the elements of all organs that find_severed() finds; then every constraint and angle spring that has lost an
/// element. Appends the severed elements to `crossings`; returns the number of severed elements, constraints and angle
/// springs.
std::int32_t sever_swept(const Model& model, const RestElements& elements, const Front& from, const Front& to,
                         const NewlySwept& newly, State& state, std::vector<Crossing>& crossings);

/// Unit of State::axial_crossing, as a fraction of the element: 1 is at its first sphere, 255 at its second.
inline constexpr double kCrossingUnit = 1.0 / 254;

/// Code of a crossing at `along` an element, in [0, 1], for State::axial_crossing; and its inverse, which gives 0.5 for
/// 0.
std::uint8_t stored_crossing(double along);
double crossing_of(std::uint8_t stored);

}  // namespace ctpm::cutting
