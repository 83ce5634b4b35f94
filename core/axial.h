#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model.h"
#include "core/state.h"

namespace ctpm {

/// Three coordinates of all spheres in one array: x of all, then y, then z  (3 x sphere_count).
using Coordinates = std::vector<double>;

/// Symmetric 3x3 blocks, one a sphere, as six arrays: xx, xy, xz, yy, yz, zz  (6 x sphere_count).
using DiagonalBlocks = std::vector<double>;

/// All axial elements of a Model, edges first, then two-sphere TPMs, with what one tick needs of each.
/// Elements whose two ends both advance by one sphere are grouped into runs, over which loops need no index
/// gathers.
class AxialElements {
 public:
  explicit AxialElements(const Model& model);

  /// Computes direction, tension and linearisation of every element at `position` for a step of `h` [s].
  /// `softness` [1] is 1 / (1 + tan theta) of each sphere (Eq. 8); empty without softening.
  /// Adds the elastic forces [N] to `force` and h^2 times the stiffness plus h times the damping to `blocks`.
  void linearise(const State& state, std::span<const double> softness, double h, Coordinates& force,
                 DiagonalBlocks& blocks);

  /// result += linearised coupling of all elements times `v`.
  void apply(const Coordinates& v, Coordinates& result) const;

  /// Adds the forces of this moment [N]: springs, dashpots at State::velocity, two-sphere TPMs at their present
  /// Kelvin elongation; `softness` as above.
  void add_forces(const State& state, std::span<const double> softness, Coordinates& force) const;

  /// Advances the Kelvin elongations of the two-sphere TPMs to the end of a step of `h` [s] that moved to
  /// State::position.
  void advance_kelvin(double h, State& state) const;

  /// Elastic energy of the edges [J] at `position` (two-sphere TPMs have none of their own to give back).
  double elastic_energy(const State& state) const;

 private:
  struct Run {
    std::int32_t first;  ///< first element
    std::int32_t count;
    std::int32_t a, b;  ///< ends of the first element
  };
  void linearise_run(const Run& run, const State& state, std::span<const double> softness, double h,
                     Coordinates& force, DiagonalBlocks& blocks);

  const Model& model_;
  std::int32_t edge_count_;
  std::vector<Run> runs_;
  std::vector<std::int32_t>
      third_;  ///< like Edges::third, with the own first sphere where there is none; empty without softening
  std::vector<double> direction_[3];  ///< unit vector from a to b, 0 where the ends coincide (element_count)
  std::vector<double> root_[3];  ///< direction times the root of the axial coupling [kg^1/2] (element_count)
  std::vector<double>
      transverse_;  ///< coupling across the direction: h^2 tension / length [kg], >= 0 (element_count)
  std::vector<double> tension_;    ///< softened elastic force, pull positive [N] (element_count)
  std::vector<double> stiffness_;  ///< what acts in the step [kg] (element_count)
};

}  // namespace ctpm
