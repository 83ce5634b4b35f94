#pragma once

#include <cstdint>
#include <vector>

#include "core/cutting/pieces.h"
#include "core/model/model.h"
#include "core/surface/rigid_motion.h"

namespace ctpm::contact {

/// The motion as a whole of the pieces of tissue that nothing holds: organs without anchors, and what cuts have taken
/// off. How deep they are pressed is measured beside it.
class OwnMotion {
 public:
  /// `model` must outlive the OwnMotion. Reserves all memory that it needs.
  explicit OwnMotion(const Model& model);

  /// Finds the pieces anew if other axial elements are severed than before (axial_count, or empty).
  void follow(const std::vector<std::uint8_t>& axial_severed);

  /// The piece of a sphere: its first sphere; -1: something holds it.
  std::int32_t free_piece(std::int32_t sphere) const;

  /// How a free piece has moved, with the spheres at `position` [m].
  surface::RigidMotion of(std::int32_t piece, const Vec3Array& position) const;

 private:
  void find();

  const Model& model_;
  std::vector<std::uint8_t> severed_;
  cutting::Pieces pieces_;
  std::vector<std::uint8_t> is_held_;   ///< of a piece, at its first sphere (sphere_count)
  std::vector<std::int32_t> by_piece_;  ///< all spheres, by piece and ascending (sphere_count)
};

}  // namespace ctpm::contact
