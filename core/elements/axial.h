#pragma once

#include <cstdint>
#include <vector>

#include "core/elements/kernels/kernels.h"
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
  /// for apply().
  void linearise(AxialArrays m, int slab);

  /// result += coupling times `v`, in the precision of `v`, float or double.
  template <class Real>
  void apply(int slab, const Real* v, SlabTarget<Real> result) const;

  /// Prepares find_acting_kelvin() and finish_kelvin() for steps of `h` [s]; allocates at the first call.
  void prepare_acting(double h);

  /// Elements::find_acting_kelvin() for the elements whose first sphere is the slab's own.
  void find_acting_kelvin(const StateView& state, std::vector<double>& acting, int slab) const;
  /// Elements::find_kelvin() and finish_kelvin() for internal variables [first, last).
  void find_kelvin(double h, const StateView& state, std::vector<double>& after, std::size_t first,
                   std::size_t last) const;
  void finish_kelvin(const std::vector<double>& before, std::vector<double>& kelvin, std::size_t first,
                     std::size_t last) const;

 private:
  /// Elements that can share a batch, and the empty places between them.
  struct Run {
    std::size_t first, last;            ///< rows of Model::axial [first, last)
    std::vector<std::int32_t> element;  ///< row of each place; -1: none (place_count)
    AxialLaw law;                       ///< of the batch
  };

  Run find_run(std::size_t first, const parallel::Slabs& slabs) const;
  std::vector<double> parameters_of(const Run& run) const;
  void add_places(const Run& run);
  /// What find_acting_kelvin() needs of each internal variable and length of step: divisions that every step repeats.
  struct Acting {
    double h = 0;                 ///< step that the rest is for [s]
    std::vector<double> share;    ///< acting_part() (internal_count)
    std::vector<double> damping;  ///< over share times h [N/m]
    std::vector<double> sum;      ///< of both stiffnesses and that [N/m]
  };

  double kelvin_after(double h, const StateView& state, std::size_t variable) const;
  double acting_part(double h, std::size_t variable) const;

  using Batches = std::vector<AxialBatch>;

  const Model& model_;
  const Kernels& kernels_;
  std::vector<Batches> of_slab_;  ///< of each slab, the batches that add to its spheres (slab_count)
  std::vector<double> parameters_;
  /// AxialElements::third, with the element's own first sphere if it has none; empty without softening (place_count).
  std::vector<std::int32_t> third_;
  std::vector<std::int32_t> element_;      ///< AxialArrays::element; empty without a scalpel (place_count)
  std::vector<std::int32_t> of_internal_;  ///< row of Model::axial that has the internal variable (internal_count)
  Acting acting_;
  std::size_t place_count_ = 0;
  std::vector<float> root_[3];  ///< direction times the root of the axial coupling [kg^1/2]; empty until needed
  std::vector<float> across_;   ///< coupling across the direction: h^2 tension / length [kg], >= 0
};

}  // namespace ctpm::elements
