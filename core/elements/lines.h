#pragma once

#include <cstdint>
#include <vector>

#include "core/elements/axial.h"
#include "core/elements/kernels/kernels.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/parallel/slabs.h"

namespace ctpm::elements {

/// Elements that pull the middle sphere of a lattice line towards the midpoint of its ends, u = C - (A + E) / 2: either
/// the constraints of five-sphere lines (Eqs. 2, 5), whose stiffness grows with the tilt, or the angle springs of Fig.
/// 1b, whose stiffness is constant.
class LineElements {
 public:
  LineElements(const Model& model, const Constraints& constraints, const parallel::Slabs& slabs,
               const Kernels& kernels);
  LineElements(const Model& model, const AngleSprings& angle_springs, const parallel::Slabs& slabs,
               const Kernels& kernels);

  bool empty() const { return k_.empty(); }

  /// Arrays that the loops of one call read and write. `softness` [1] = 1 / (1 + tan theta) of each sphere, null
  /// without softening.
  LineArrays arrays(const StateView& state, double* softness);

  /// Computes lambda of the lines centred on a sphere of the slab, and the softness of that sphere: the least of all
  /// its lines (Eq. 8).
  void measure(const LineArrays& m, int slab) const;

  /// Adds the forces [N] of one slab's lines to `m.force`. Call measure() of all slabs first.
  void add_forces(const LineArrays& m, int slab) const;

  /// Adds the forces to `m.force` and the diagonal of h^2 K [kg] to `m.blocks`. Stores the coupling for apply().
  void linearise(LineArrays m, int slab);
  void prepare_linearise();

  /// result += coupling times `v`, in the precision of `v`, float or double.
  template <class Real>
  void apply(int slab, const Real* v, SlabTarget<Real> result) const;

  /// As above, without the diagonal that linearise() added to the blocks.
  template <class Real>
  void apply_lagged(int slab, const Real* v, SlabTarget<Real> result) const;

 private:
  /// The batches [first, last) of one slab.
  struct Range {
    std::size_t first, last;
  };

  LineArrays coupling_arrays() const;

  LineElements(const Model& model, bool is_constraint, const std::vector<std::int32_t>& first,
               const std::vector<std::int32_t>& middle, const std::vector<std::int32_t>& last,
               const std::vector<double>& k, const parallel::Slabs& slabs, const Kernels& kernels);

  const Model& model_;
  const Kernels& kernels_;
  bool is_constraint_;
  std::vector<std::int32_t> first_, middle_, last_, line_;  ///< spheres and line of each place (place_count)
  std::vector<double> k_;                                   ///< (place_count)
  std::vector<LineBatch> batches_;
  std::vector<Range> of_slab_;      ///< (slab_count)
  std::vector<LineWeight> weight_;  ///< of each batch's coupling
  std::vector<double> lambda_;      ///< before softening [N/m] (place_count)
  /// Coupling: its root along u [kg^1/2], and the part equal in all directions [kg] (place_count each).
  std::vector<float> along_[3], isotropic_;
};

}  // namespace ctpm::elements
