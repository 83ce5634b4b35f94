#pragma once

#include <vector>

#include "core/axial.h"
#include "core/kernels/kernels.h"
#include "core/lines.h"
#include "core/model.h"
#include "core/only_springs.h"
#include "core/slabs.h"
#include "core/state.h"
#include "core/team.h"

namespace ctpm {

/// All elements of a Model together: their forces, and their linearisation for an implicit step.
class Elements {
 public:
  /// `model` and `team` must outlive the Elements.
  Elements(const Model& model, Team& team, InstructionSet set = best_instruction_set());

  /// Adds the forces of this moment [N] to `force`: springs, dashpots at State::velocity, two-sphere TPMs at
  /// their present Kelvin elongation, constraints, softening (Eqs. 1-8)  (3 x sphere_count).
  void add_forces(const State& state, Coordinates& force);

  /// Adds the elastic forces [N] to `force` and the diagonal of h^2 K + h C [kg] to `blocks`, for a step of `h`
  /// [s]. The dashpots' forces are left to the matrix.
  void linearise(const State& state, double h, Coordinates& force, DiagonalBlocks& blocks);

  /// result += (h^2 K + h C) v as of the last linearise()  (3 x sphere_count each).
  void apply(const double* v, double* result) const;

  /// Brings the Kelvin elongations of the two-sphere TPMs to the end of a step of `h` [s] that moved to
  /// State::position.
  void advance_kelvin(double h, State& state) const {
    if constexpr (!kOnlySprings) axial_.advance_kelvin(h, state);
  }

  const Slabs& slabs() const { return slabs_; }

 private:
  void measure(const LineArrays& constraints, const LineArrays& angles);
  template <class Task>
  void for_each_task(Task&& task) const;

  Team& team_;
  Slabs slabs_;
  Schedule schedule_;
  AxialElements axial_;
  LineElements constraints_, angles_;
  std::vector<double> softness_;  ///< 1 / (1 + tan theta) of each sphere; empty without softening (sphere_count)
};

}  // namespace ctpm
