#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "core/elements/elements.h"
#include "core/elements/kernels/kernels.h"
#include "core/parallel/slabs.h"
#include "core/parallel/team.h"

namespace ctpm::solver {

/// Sum over all slabs that are awake of part(slab). It adds slab by slab, so the result does not depend on the number
/// of threads. `parts` is scratch memory (slab_count).
template <class Part>
requires std::is_invocable_v<Part, int>
double sum_over_slabs(const parallel::Slabs& slabs, parallel::Team& team, std::vector<double>& parts, Part&& part) {
  slabs.for_each_awake(team, [&](int slab) { parts[std::size_t(slab)] = part(slab); });
  double sum = 0;
  for (const int slab : slabs.awake()) sum += parts[std::size_t(slab)];
  return sum;
}

/// As above, of part(begin, end), each called with a slab's range of spheres.
template <class Part>
requires std::is_invocable_v<Part, std::size_t, std::size_t>
double sum_over_slabs(const parallel::Slabs& slabs, parallel::Team& team, std::vector<double>& parts, Part&& part) {
  return sum_over_slabs(slabs, team, parts,
                        [&](int slab) { return part(std::size_t(slabs.begin(slab)), std::size_t(slabs.end(slab))); });
}

/// Conjugate gradients for A c = r from c = 0, with vectors of Real and symmetric successive over-relaxation as
/// preconditioner, (D + L) D^-1 (D + U) (Saad, "Iterative methods for sparse linear systems", 2003, alg. 9.1 and sec.
/// 10.2). A = D + L + U + N: D has one 3x3 block per sphere, L couples a chunk with earlier ones of its slab, U is the
/// transpose of L, and N is the rest, whose coupling is lagged. Each product with A takes one sweep with U and one with
/// L (Eisenstat, "Efficient implementation of a class of preconditioned conjugate gradient methods", 1981). r is scaled
/// into the range of float.
template <class Real>
class ConjugateGradient {
 public:
  ConjugateGradient(const elements::Elements& elements, parallel::Team& team, const elements::Kernels& kernels);

  /// The factor of D, to be filled before a solve; 0 along held axes (6 x sphere_count).
  std::vector<Real>& factor() { return factor_; }

  /// Sets r = `scale` * `residual`; returns its energy r . (D + U)^-1 D (D + L)^-1 r.
  double begin(const elements::Coordinates& residual, double scale);

  /// Iterates until the energy of the residual is at most `at_once`, or `later` once an iteration was made, or
  /// `iterations` are used up. Decrements `iterations` and returns the energy. `apply_lagged(in, out)` does out = N in,
  /// but for what is in pieces of the sweeps.
  template <class ApplyLagged>
  double descend(double at_once, double later, std::int32_t& iterations, ApplyLagged&& apply_lagged);

  /// x += c / scale.
  void add_to(elements::Coordinates& x) const;

 private:
  elements::SolverArrays<Real> arrays();

  const elements::Elements& elements_;
  const parallel::Slabs& slabs_;
  parallel::Team& team_;
  const elements::SolverKernels<Real>& kernels_;
  std::size_t spheres_;
  /// The residual is kept as D (D + L)^-1 r; the others are as in elements::SolverKernels.
  std::vector<Real> factor_, solution_, residual_, direction_, upward_, downward_, change_, lagged_;
  std::vector<double> parts_;  ///< of a sum (slab_count)
  double scale_ = 1, energy_ = 0;
};

template <class Real>
template <class ApplyLagged>
double ConjugateGradient<Real>::descend(double at_once, double later, std::int32_t& iterations,
                                        ApplyLagged&& apply_lagged) {
  const elements::SolverArrays<Real> m = arrays();
  const elements::SweepCoupling coupling = elements_.sweep_coupling();
  double turn = 0;
  for (double enough = at_once; energy_ > enough && iterations > 0; enough = later) {
    slabs_.for_each_awake(team_, [&](int slab) { kernels_.sweep_up(m, coupling, elements_.sweep(slab), Real(turn)); });
    apply_lagged(static_cast<const Real*>(m.upward), m.lagged);
    const double curvature = sum_over_slabs(
        slabs_, team_, parts_, [&](int slab) { return kernels_.sweep_down(m, coupling, elements_.sweep(slab)); });
    if (!(curvature > 0)) break;  // not a number, or converged to rounding
    const double step = energy_ / curvature;
    const double next = sum_over_slabs(
        slabs_, team_, parts_, [&](int slab) { return kernels_.descend(m, elements_.sweep(slab), Real(step)); });
    turn = next / energy_;
    energy_ = next;
    --iterations;
  }
  return energy_;
}

}  // namespace ctpm::solver
