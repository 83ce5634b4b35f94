#pragma once

#include "core/axial.h"
#include "core/model.h"
#include "core/state.h"

namespace ctpm {

/// The angle springs of a Model (Fig. 1b). Their law is linear, so the matrix needs nothing that changes from
/// tick to tick.
class AngleElements {
 public:
  explicit AngleElements(const Model& model) : model_(model) {}

  /// Adds the forces [N].
  void add_forces(const State& state, Coordinates& force) const;

  /// Adds the forces [N] and the linearisation for a step of `h` [s].
  void linearise(const State& state, double h, Coordinates& force, DiagonalBlocks& blocks) const;

  /// result += coupling of a step of `h` [s] times `v`.
  void apply(const State& state, double h, const Coordinates& v, Coordinates& result) const;

  /// [J]
  double elastic_energy(const State& state) const;

 private:
  bool lives(const State& state, std::size_t i) const {
    return state.angle_severed.empty() || !state.angle_severed[i];
  }

  const Model& model_;
};

}  // namespace ctpm
