#pragma once

#include <cstdint>
#include <vector>

#include "core/elements/kernels/kernels.h"
#include "core/elements/sweeps.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/parallel/slabs.h"

namespace ctpm::elements {

/// Three coordinates of all spheres in one array: x of all, then y, then z  (3 x sphere_count).
using Coordinates = std::vector<double>;

/// Symmetric 3x3 blocks, one per sphere, as six arrays: xx, xy, xz, yy, yz, zz (6 x sphere_count).
using DiagonalBlocks = std::vector<double>;

/// Forces of all axial elements of a Model, in batches for the inner loops (AxialBatch). Batches with equal parameters
/// share one copy of them, so that tissue of one material streams no parameters from memory.
class AxialForces {
 public:
  AxialForces(const Model& model, const parallel::Slabs& slabs, const Kernels& kernels);

  /// Arrays that the loops of one call read and write; `softness` as in Elements, null without softening.
  AxialArrays arrays(const StateView& state, const double* softness) const;

  /// Adds the present forces [N] of one slab's elements to `m.force`.
  void add_forces(const AxialArrays& m, int slab) const;

  /// Allocates the coupling; call it before the first linearise().
  void prepare_linearise();

  /// Adds the elastic forces [N] to `m.force` and the diagonal of h^2 K + h C [kg] to `m.blocks`. Stores the coupling
  /// for apply(). prepare_kelvin() must have been called for the same step.
  void linearise(AxialArrays m, int slab);

  /// result += coupling times `v`.
  void apply(int slab, const double* v, SlabTarget<double> result) const;

  /// As above, of what the pieces of the sweeps leave out, in the precision of `v`, float or double.
  template <class Real>
  void apply_lagged(int slab, const Real* v, SlabTarget<Real> result) const;

  /// What the solver's sweeps through a slab need of the last linearise().
  Sweep sweep(int slab) const { return sweeps_[std::size_t(slab)].sweep(); }
  SweepCoupling sweep_coupling() const;

  /// Whether find_kelvin() finds elongations at the end of a step, or those that act in it.
  enum class KelvinAt { end, acting };

  /// Prepares find_kelvin(), finish_kelvin() and linearise() for steps of `h` [s]; allocates at the first call.
  void prepare_kelvin(double h, KelvinAt at);

  /// Elements::find_kelvin() or find_acting_kelvin() for the elements whose first sphere is the slab's own.
  void find_kelvin(const StateView& state, std::vector<double>& kelvin, int slab) const;
  /// Elements::finish_kelvin() for internal variables [first, last).
  void finish_kelvin(const std::vector<double>& before, std::vector<double>& kelvin, std::size_t first,
                     std::size_t last) const;

 private:
  /// Elements that can share a batch, and the empty places between them.
  struct Run {
    std::size_t first, last;            ///< rows of Model::axial [first, last)
    std::vector<std::int32_t> element;  ///< row of each place; -1: none (place_count)
    AxialLaw law;                       ///< of the batch
  };

  AxialArrays coupling_arrays() const;
  Run find_run(std::size_t first, const parallel::Slabs& slabs) const;
  std::vector<double> parameters_of(const Run& run) const;
  void add_places(const Run& run);
  /// What find_kelvin() needs of each internal variable and length of step: divisions that every step repeats.
  struct KelvinSteps {
    double h = 0;  ///< step that the rest is for [s]
    KelvinAt at = KelvinAt::end;
    std::vector<double> share;                    ///< of the step after which the elongation is wanted (internal_count)
    std::vector<double> damping, sum, stiffness;  ///< as in elements::KelvinStep
  };

  double acting_part(double h, std::size_t variable) const;
  void fill(KelvinSteps& steps) const;

  using Batches = std::vector<AxialBatch>;

  const Model& model_;
  const parallel::Slabs& slabs_;
  const Kernels& kernels_;
  std::vector<Batches> of_slab_;  ///< of each slab, the batches that add to its spheres (slab_count)
  std::vector<double> parameters_;
  /// AxialElements::third, with the element's own first sphere if it has none; empty without softening (place_count).
  std::vector<std::int32_t> third_;
  std::vector<std::int32_t> element_;      ///< AxialArrays::element; empty without a scalpel (place_count)
  std::vector<std::int32_t> of_internal_;  ///< row of Model::axial that has the internal variable (internal_count)
  KelvinSteps kelvin_, kelvin_before_;     ///< SDIRK2 and what it falls back to take steps of two lengths
  std::size_t place_count_ = 0;
  /// Coupling of each place, from the kLanes-th number on, followed by kLanes more: direction times the root of the
  /// axial part [kg^1/2], and the part across it, h^2 tension / length [kg], >= 0. Empty until needed.
  std::vector<float> root_[3], across_;
  std::vector<Sweeps> sweeps_;  ///< empty until needed (slab_count)
};

}  // namespace ctpm::elements
