#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/elements/axial.h"
#include "core/elements/kernels/kernels.h"
#include "core/parallel/slabs.h"
#include "core/parallel/team.h"

namespace ctpm::solver {

/// Sum over all slabs of part(begin, end), each called with its range of spheres. It adds slab by slab, so the result
/// does not depend on the number of threads.
template <class Part>
double sum_over_slabs(const parallel::Slabs& slabs, parallel::Team& team, std::vector<double>& parts, Part&& part) {
  team.for_each(slabs.count(), [&](int slab) {
    parts[std::size_t(slab)] = part(std::size_t(slabs.begin(slab)), std::size_t(slabs.end(slab)));
  });
  double sum = 0;
  for (const double value : parts) sum += value;
  return sum;
}

/// Conjugate gradients for A c = r from c = 0, with vectors of Real and a block Jacobi preconditioner of one 3x3 block
/// per sphere (Saad, "Iterative methods for sparse linear systems", 2003, alg. 9.1). r is scaled into the range of
/// float.
template <class Real>
class ConjugateGradient {
 public:
  ConjugateGradient(const std::vector<double>& mass, const parallel::Slabs& slabs, parallel::Team& team,
                    const elements::Kernels& kernels);

  /// Inverse blocks of the preconditioner, to be filled before a solve; 0 along held axes (6 x sphere_count).
  std::vector<Real>& inverse() { return inverse_; }

  /// Sets r = `scale` * `residual`; returns its energy r . (inverse blocks) r.
  double begin(const elements::Coordinates& residual, double scale);

  /// Iterates until the energy of the residual is at most `enough` or `iterations` are used up. Decrements `iterations`
  /// and returns the energy. `add_coupling(in, out, after)` does out += coupling times in, and calls after(slab) when
  /// the part of out that belongs to a slab is done. It returns in . addition for anything it adds to out afterwards.
  template <class AddCoupling>
  double descend(double enough, std::int32_t& iterations, AddCoupling&& add_coupling);

  /// x += c / scale.
  void add_to(elements::Coordinates& x) const;

 private:
  elements::SolverArrays<Real> arrays();

  const parallel::Slabs& slabs_;
  parallel::Team& team_;
  const elements::SolverKernels<Real>& kernels_;
  std::vector<Real> mass_, inverse_, solution_, residual_, preconditioned_, direction_, product_;
  std::vector<double> parts_;  ///< of a sum (slab_count)
  double scale_ = 1, energy_ = 0;
};

template <class Real>
template <class AddCoupling>
double ConjugateGradient<Real>::descend(double enough, std::int32_t& iterations, AddCoupling&& add_coupling) {
  const elements::SolverArrays<Real> m = arrays();
  double turn = 0;
  while (energy_ > enough && iterations > 0) {
    team_.for_each(slabs_.count(), [&](int slab) {
      kernels_.turn(m, Real(turn), std::size_t(slabs_.begin(slab)), std::size_t(slabs_.end(slab)));
    });
    double curvature = add_coupling(static_cast<const Real*>(m.direction), m.product, [&](int slab) {
      parts_[std::size_t(slab)] = kernels_.curvature(m, std::size_t(slabs_.begin(slab)), std::size_t(slabs_.end(slab)));
    });
    for (const double part : parts_) curvature += part;
    if (!(curvature > 0)) break;  // not a number, or converged to rounding
    const double step = energy_ / curvature;
    const double next = sum_over_slabs(slabs_, team_, parts_, [&](std::size_t begin, std::size_t end) {
      return kernels_.descend(m, Real(step), begin, end);
    });
    turn = next / energy_;
    energy_ = next;
    --iterations;
  }
  return energy_;
}

}  // namespace ctpm::solver
