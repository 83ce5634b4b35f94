#pragma once

#include <cstdint>
#include <vector>

#include "core/cutting/near_elements.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::cutting {

/// The edge of a blade in the world.
struct BladeEdge {
  Vec3 tip, heel;  ///< both ends [m]
};

/// The edge of a scalpel at the pose of `inputs`.
BladeEdge blade_edge(const Tool& scalpel, const Inputs& inputs);

/// The crossing of an element by the blade that has just severed it.
struct Crossing {
  std::int32_t element;  ///< row of Model::axial
  double along;          ///< position along the element, 0 at its first sphere to 1 at its second
  double across = 0;     ///< position along the blade, 0 at the tip to 1 at the heel
  /// Part of the motion that was done at the crossing, 0 to 1: of the blade in the tick, or of the tissue in the
  /// substep.
  double share = 0;
};

/// Severs every element among those `near` that the blade crosses while it moves from `before` to `after` through the
/// resting network at `position`, then every constraint and angle spring that has lost an element. The moving edge
/// sweeps the two triangles (tip, heel, tip') and (heel, heel', tip'). Touching counts as crossing, so nothing slips
/// between two ticks. Appends the severed elements to `crossings`; returns the number of severed elements, constraints
/// and angle springs.
std::int32_t sever_swept_by_blade(const Model& model, const NearElements& near, const BladeEdge& before,
                                  const BladeEdge& after, const Vec3Array& position, State& state,
                                  std::vector<Crossing>& crossings);

/// As above, for elements that move through the resting `blade` while the network goes from `from` to `to`.
std::int32_t sever_moved_through_blade(const Model& model, const NearElements& near, const BladeEdge& blade,
                                       const Vec3Array& from, const Vec3Array& to, State& state,
                                       std::vector<Crossing>& crossings);

/// Unit of State::axial_crossing, as a fraction of the element: 1 is at its first sphere, 255 at its second.
inline constexpr double kCrossingUnit = 1.0 / 254;

/// Code of a crossing at `along` an element, in [0, 1], for State::axial_crossing; and its inverse, which gives 0.5 for
/// 0.
std::uint8_t stored_crossing(double along);
double crossing_of(std::uint8_t stored);

}  // namespace ctpm::cutting
