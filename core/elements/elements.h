#pragma once

#include <vector>

#include "core/elements/axial.h"
#include "core/elements/kernels/kernels.h"
#include "core/elements/lines.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/parallel/slabs.h"
#include "core/parallel/team.h"

namespace ctpm::elements {

/// All elements of a Model: their forces, and their linearisation for an implicit step.
class Elements {
 public:
  /// `model` and `team` must outlive the Elements. Forces and matrices are those of awake slabs alone.
  Elements(const Model& model, parallel::Team& team, InstructionSet set = best_instruction_set());

  /// Adds the present forces [N] to `force` (3 x sphere_count): springs, dashpots at StateView::velocity, two-sphere
  /// TPMs at their present Kelvin elongation, constraints and softening (Eqs. 1-8).
  void add_forces(const StateView& state, Coordinates& force);

  /// As above. Calls before(slab) and after(slab) around the additions to the spheres of a slab.
  template <class Before, class After>
  void add_forces(const StateView& state, Coordinates& force, Before&& before, After&& after);

  /// Adds the elastic forces [N] to `force` and the diagonal of h^2 K + h C [kg] to `blocks` for a step of `h` [s].
  /// Kelvin elongations are those at the end of the step. The forces of dashpots are added only `with_dashpots`;
  /// otherwise the matrix alone accounts for them. Calls before(slab) before anything is added to the spheres of a
  /// slab. If `v` is not null, adds (h^2 K + h C) v to `product`, as apply() would (3 x sphere_count each).
  template <class Before>
  void linearise(const StateView& state, double h, bool with_dashpots, Coordinates& force, DiagonalBlocks& blocks,
                 Before&& before, const double* v = nullptr, double* product = nullptr);

  /// Finds and allocates what the first linearise() for a step of `h` [s] would.
  void prepare_linearise(double h);

  /// result += (h^2 K + h C) v as of the last linearise() (3 x sphere_count each).
  void apply(const double* v, double* result) const;

  /// result = what the sweeps leave out of (h^2 K + h C) v, in the precision of `v`, float or double (3 x sphere_count
  /// each): the coupling of lines, and of spheres of two slabs, without the diagonal blocks.
  template <class Real>
  void apply_lagged(const Real* v, Real* result) const;

  /// What the solver's sweeps through a slab need of the last linearise().
  Sweep sweep(int slab) const { return axial_.sweep(slab); }
  SweepCoupling sweep_coupling() const { return axial_.sweep_coupling(); }

  /// Kelvin elongations of the two-sphere TPMs [m] at the end of a step of `h` [s] that starts from
  /// StateView::kelvin_elongation and ends with the spheres at StateView::position. First order (internal_count).
  void find_kelvin(double h, const StateView& state, std::vector<double>& after);

  /// Kelvin elongations [m] that act in a step of `h` [s], with the spheres at StateView::position in its middle.
  /// Second order if the step resolves them (internal_count).
  void find_acting_kelvin(double h, const StateView& state, std::vector<double>& acting);

  /// Replaces the acting Kelvin elongations [m] of the last find_acting_kelvin() by those at the end of its step;
  /// `before`: at its start (internal_count).
  void finish_kelvin(const std::vector<double>& before, std::vector<double>& kelvin) const;

  const parallel::Slabs& slabs() const { return slabs_; }
  parallel::Slabs& slabs() { return slabs_; }

 private:
  void find_kelvin_of(double h, AxialForces::KelvinAt at, const StateView& state, std::vector<double>& kelvin);

  /// Scratch memory for the sums of one slab, before they are added to the arrays of all spheres. Unused with a single
  /// slab.
  struct Workbench {
    std::vector<double> full;   ///< three rows of forces, six of blocks, three of products
    std::vector<float> single;  ///< three rows
  };

  /// Arrays that the loops of one call read and write.
  struct Arrays {
    LineArrays constraints, angles;
    AxialArrays axial;
  };

  Arrays arrays(const StateView& state);
  void measure(const Arrays& arrays);
  void add_forces_of(int slab, Arrays arrays, Coordinates& force);
  void linearise_of(int slab, Arrays arrays, Coordinates& force, DiagonalBlocks& blocks, double* product);

  void make_room(std::size_t full_rows, std::size_t single_rows);

  /// Where a slab adds three rows (of a vector) or six (of blocks) that belong to `all` (rows x sphere_count); in the
  /// workbench so many rows after the first.
  template <class Real>
  SlabTarget<Real> target_for(int slab, std::size_t rows, Real* all, std::size_t after = 0) const;

  /// Adds the sums of a slab to `all`.
  template <class Real>
  void bring(const SlabTarget<Real>& own, std::size_t rows, Real* all) const;

  parallel::Team& team_;
  parallel::Slabs slabs_;
  AxialForces axial_;
  LineElements constraints_, angles_;
  std::vector<double> softness_;  ///< 1 / (1 + tan theta) of each sphere; empty without softening (sphere_count)
  mutable std::vector<Workbench> workbenches_;  ///< (slab_count)
};

template <class Before, class After>
void Elements::add_forces(const StateView& state, Coordinates& force, Before&& before, After&& after) {
  make_room(3, 0);
  const Arrays all = arrays(state);
  measure(all);
  slabs_.for_each_awake(team_, [&](int slab) { before(slab), add_forces_of(slab, all, force), after(slab); });
}

template <class Before>
void Elements::linearise(const StateView& state, double h, bool with_dashpots, Coordinates& force,
                         DiagonalBlocks& blocks, Before&& before, const double* v, double* product) {
  prepare_linearise(h);
  Arrays all = arrays(state);
  measure(all);
  all.constraints.h = all.angles.h = all.axial.h = h;
  all.axial.with_dashpots = with_dashpots;
  all.constraints.multiplied.v = all.angles.multiplied.v = all.axial.multiplied.v = v;
  slabs_.for_each_awake(team_, [&](int slab) { before(slab), linearise_of(slab, all, force, blocks, product); });
}

}  // namespace ctpm::elements
