#pragma once

#include <cstdint>

#include "core/model.h"
#include "core/state.h"

namespace ctpm {

/// The edge of a blade in the world.
struct BladeEdge {
  Vec3 tip, heel;  ///< both ends [m]
};

/// The blade edge of a scalpel at the pose that `inputs` give.
BladeEdge blade_edge(const Tool& scalpel, const Inputs& inputs);

/// Severs every element that the blade crosses while it moves from `before` to `after` through the resting
/// network at `position`. What a moving edge sweeps is the two triangles (tip, heel, tip') and (heel, heel',
/// tip'). Returns how many elements were severed. Touching counts as crossing, so nothing slips between two
/// ticks.
std::int32_t sever_swept_by_blade(const Model& model, const BladeEdge& before, const BladeEdge& after,
                                  const Vec3Array& position, State& state);

/// Severs every element that moves through the resting `blade` while the network goes from `from` to `to`.
std::int32_t sever_moved_through_blade(const Model& model, const BladeEdge& blade, const Vec3Array& from,
                                       const Vec3Array& to, State& state);

}  // namespace ctpm
