#pragma once

#include <vector>

#include "core/angle_spring.h"
#include "core/axial.h"
#include "core/constraint.h"
#include "core/model.h"
#include "core/state.h"

namespace ctpm {

/// All elements of a Model together: their forces, and their linearisation for an implicit step.
class Elements {
 public:
  explicit Elements(const Model& model);

  /// Adds the forces of this moment [N] to `force`: springs, dashpots at State::velocity, two-sphere TPMs at
  /// their present Kelvin elongation, constraints, softening (Eqs. 1-8)  (3 x sphere_count).
  void add_forces(const State& state, Coordinates& force);

  /// Adds the elastic forces [N] to `force` and the diagonal of h^2 K + h C [kg] to `blocks`, for a step of `h`
  /// [s]. The dashpots' forces are left to the matrix.
  void linearise(const State& state, double h, Coordinates& force, DiagonalBlocks& blocks);

  /// result += (h^2 K + h C) v as of the last linearise() with the same State and `h`.
  void apply(const State& state, double h, const Coordinates& v, Coordinates& result) const;

  /// Brings the Kelvin elongations of the two-sphere TPMs to the end of a step of `h` [s] that moved to
  /// State::position.
  void advance_kelvin(double h, State& state) const { axial_.advance_kelvin(h, state); }

 private:
  const Model& model_;
  AxialElements axial_;
  ConstraintElements constraints_;
  AngleElements angles_;
  std::vector<double> softness_;  ///< 1 / (1 + tan theta) of each sphere; empty without softening (sphere_count)
};

}  // namespace ctpm
