#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/model.h"
#include "core/slabs.h"
#include "core/state.h"

namespace ctpm {

/// Three coordinates of all spheres in one array: x of all, then y, then z  (3 x sphere_count).
using Coordinates = std::vector<double>;

/// Symmetric 3x3 blocks, one a sphere, as six arrays: xx, xy, xz, yy, yz, zz  (6 x sphere_count).
using DiagonalBlocks = std::vector<double>;

/// All axial elements of a Model, edges first, then two-sphere TPMs, as batches for the inner loops (AxialBatch). Batches
/// with the same parameters share one copy of them, so a tissue of one material streams none from memory.
class AxialElements {
 public:
  AxialElements(const Model& model, const Slabs& slabs, const Schedule& schedule, const Kernels& kernels);

  /// What the loops of one call read and write; `softness` as in Elements, null without it.
  AxialArrays arrays(const State& state, const double* softness, double* force) const;

  /// Adds the forces of this moment [N] of one task's elements to `m.force`.
  void add_forces(const AxialArrays& m, int step, int task) const;

  /// Makes room for the coupling; before the first linearise().
  void prepare_linearise();

  /// Adds the elastic forces [N] to `m.force` and the diagonal of h^2 K + h C [kg] to `m.blocks`, and keeps the coupling
  /// for apply().
  void linearise(AxialArrays m, int step, int task);

  /// result += coupling times `v`.
  void apply(int step, int task, const double* v, double* result) const;

  /// Advances the Kelvin elongations of the two-sphere TPMs to the end of a step of `h` [s] that moved to
  /// State::position.
  void advance_kelvin(double h, State& state) const;


 private:
  using Task = std::vector<AxialBatch>;

  const Model& model_;
  const Kernels& kernels_;
  std::array<std::vector<Task>, Schedule::kSteps> tasks_;
  std::vector<double> parameters_;
  std::vector<std::int32_t>
      third_;  ///< like Edges::third, with the own first sphere where there is none; empty without softening
  std::vector<double> root_[3];  ///< direction times the root of the axial coupling [kg^1/2]; empty until needed
  std::vector<double> across_;   ///< coupling across the direction: h^2 tension / length [kg], >= 0
};

}  // namespace ctpm
