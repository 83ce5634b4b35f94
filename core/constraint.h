#pragma once

#include <span>
#include <vector>

#include "core/axial.h"
#include "core/model.h"
#include "core/state.h"

namespace ctpm {

/// The constraints of all five-sphere lines, with what one tick needs of each.
class ConstraintElements {
 public:
  explicit ConstraintElements(const Model& model);

  /// Tilt of every line, and from it `softness` = 1 / (1 + tan theta) of every sphere: the largest tilt of
  /// the lines centred on it, 1 where there is none (Eq. 8)  (sphere_count, or empty without softening).
  void measure_tilt(const State& state, std::vector<double>& softness);

  /// Adds the constraint forces (Eqs. 2, 5; divided as Eq. 8 says). measure_tilt() of the same State comes first.
  void add_forces(const State& state, std::span<const double> softness, Coordinates& force) const;

  /// Adds the constraint forces and the linearisation for a step of `h` [s]. measure_tilt() of the same State comes
  /// first.
  void linearise(const State& state, std::span<const double> softness, double h, Coordinates& force,
                 DiagonalBlocks& blocks);

  /// result += coupling times `v`.
  void apply(const Coordinates& v, Coordinates& result) const;

 private:
  const Model& model_;
  std::vector<Vec3> offset_;          ///< u = C - (A + E) / 2 [m] (constraint_count)
  std::vector<double> half_length_;   ///< |E - A| / 2 [m] (constraint_count)
  std::vector<std::int32_t> active_;  ///< constraints tilted enough to matter in the matrix
  std::vector<double> isotropic_;     ///< their coupling in all directions [kg] (active_count)
  std::vector<Vec3> along_;  ///< unit vector of u times the root of the rest of the coupling (active_count)
};

}  // namespace ctpm
