#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/pin.h"
#include "core/elements/axial.h"
#include "core/elements/kernels/kernels.h"
#include "core/inversion/cell_check.h"
#include "core/inversion/corner.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/parallel/slabs.h"
#include "core/parallel/team.h"

namespace ctpm::inversion {

class LinearisedResistance;

/// What keeps tissue from turning inside out, and turns it back (TissueCells). A cell that lost one of its twelve
/// edges to a blade does not resist and does not count. Capacity is fixed at construction, so that a tick never
/// allocates; without tissue cells nothing is stored.
class Resistance {
 public:
  /// `model`, `slabs` and `team` must outlive the Resistance.
  Resistance(const Model& model, const parallel::Slabs& slabs, parallel::Team& team, const elements::Kernels& kernels);

  /// Whether the Model has tissue cells.
  bool any() const { return model_.tissue_cells.size() > 0; }

  /// Energy stored in all cells [J].
  double energy(const StateView& state);

  /// Number of cells with a corner tetrahedron inside out, J < 0.
  std::int32_t count_inverted(const StateView& state);

  /// Changes the `velocity` [m/s] that spheres have after an explicit step of `h` [s] without resistance; `middle` is
  /// the middle of the step. Tetrahedra follow one after the other, each solved implicitly; none pulls. Spheres keep
  /// their velocity along held axes, and so do those of `pins`; returns the force on each pin's sphere [N].
  std::array<Vec3, kMostHands> push_out(const StateView& middle, double h, const contact::Pins& pins,
                                        Vec3Array& velocity);

  /// Adds the forces [N] at `state` to `force`, and the diagonal of h^2 K [kg] to `blocks` until the result is
  /// destroyed. K is the positive semidefinite part of the second derivative: k g g^T of each tetrahedron, g the
  /// gradient of J. One linearisation at a time.
  [[nodiscard]] LinearisedResistance linearise(const StateView& state, double h, elements::Coordinates& force,
                                               elements::DiagonalBlocks& blocks);

 private:
  friend class LinearisedResistance;

  /// A corner tetrahedron that resists.
  struct Pressed {
    CornerSpheres sphere;
    std::array<Vec3, 3> gradient;  ///< of J over the positions of the neighbours [1/m]
    double lack;                   ///< J0 - J, > 0
    double k;                      ///< [J]

    Vec3 at_corner() const { return -(gradient[0] + gradient[1] + gradient[2]); }
    Vec3 at(std::size_t i) const { return i == 0 ? at_corner() : gradient[i - 1]; }
  };

  void find_edges();
  bool is_cut(std::size_t cell, const std::vector<std::uint8_t>& axial_severed) const;
  void find_pressed(const StateView& state);
  template <class Visit>
  void for_each_pressed(Visit&& visit) const;

  const Model& model_;
  const parallel::Slabs& slabs_;
  parallel::Team& team_;
  CellCheck check_;
  /// Rows of Model::axial along each cell's edges; -1: none; empty if the Model has no scalpel (cell_count).
  std::vector<std::array<std::int32_t, 12>> edges_;
  std::vector<std::vector<Pressed>> pressed_;  ///< (slab_count)
  std::vector<std::int32_t> counts_;           ///< (slab_count)
  struct SavedBlock {
    std::int32_t sphere;
    std::array<double, 6> block;
  };
  std::vector<SavedBlock> saved_;       ///< blocks before linearise()
  std::vector<std::uint8_t> is_saved_;  ///< (sphere_count)
  bool is_linearised_ = false;
};

/// The resistance in the linear system of an implicit step, until it is destroyed. The destructor restores the blocks
/// to the bit; whatever was added to them in between must have been taken back.
class LinearisedResistance {
 public:
  LinearisedResistance(const LinearisedResistance&) = delete;
  LinearisedResistance& operator=(const LinearisedResistance&) = delete;
  ~LinearisedResistance();

  /// result += h^2 K times `v` (3 x sphere_count each).
  void apply(const double* v, double* result) const { apply_of<false>(v, result); }

  /// As above without the diagonal that was added to the blocks, in the precision of `v`, float or double.
  template <class Real>
  void apply_lagged(const Real* v, Real* result) const {
    apply_of<true>(v, result);
  }

 private:
  friend class Resistance;
  template <bool kLagged, class Real>
  void apply_of(const Real* v, Real* result) const;
  LinearisedResistance(Resistance& resistance, const StateView& state, double h, elements::Coordinates& force,
                       elements::DiagonalBlocks& blocks);

  Resistance& resistance_;
  double h_;
  elements::DiagonalBlocks& blocks_;
};

}  // namespace ctpm::inversion
