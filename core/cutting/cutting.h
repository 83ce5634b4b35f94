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

/// The blade edge of a scalpel at the pose that `inputs` give.
BladeEdge blade_edge(const Tool& scalpel, const Inputs& inputs);

/// An element that a blade has just severed.
struct Crossing {
  std::int32_t element;  ///< row of Model::axial
  double along;          ///< where the blade passed it, 0 at its first sphere to 1 at its second
  double across = 0;     ///< which part of the blade met it, 0 at the tip to 1 at the heel
  double share = 0;      ///< when the blade met it, 0 at the start of its way in the tick to 1 at the end
};

/// Severs every element, of those that are `near`, that the blade crosses while it moves from `before` to
/// `after` through the resting network at `position`, and every constraint and angle spring that thereby lost
/// an element. What a moving edge sweeps is the two triangles (tip, heel, tip') and (heel, heel', tip'). Returns
/// how many elements, constraints and angle springs were severed; appends the elements to `crossings`.
/// Touching counts as crossing, so nothing slips between two ticks.
std::int32_t sever_swept_by_blade(const Model& model, const NearElements& near, const BladeEdge& before,
                                  const BladeEdge& after, const Vec3Array& position, State& state,
                                  std::vector<Crossing>& crossings);

/// Severs every element, of those that are `near`, that moves through the resting `blade` while the network
/// goes from `from` to `to`.
std::int32_t sever_moved_through_blade(const Model& model, const NearElements& near, const BladeEdge& blade,
                                       const Vec3Array& from, const Vec3Array& to, State& state,
                                       std::vector<Crossing>& crossings);

/// State::axial_crossing counts in this part of an element: 1 is at its first sphere, 255 at its second.
inline constexpr double kCrossingUnit = 1.0 / 254;

/// How a place `along` an element, in [0, 1], is kept in State::axial_crossing, and read back.
std::uint8_t stored_crossing(double along);
double crossing_of(std::uint8_t stored);

}  // namespace ctpm::cutting
