#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/axial.h"
#include "core/kernels/kernels.h"
#include "core/slabs.h"
#include "core/team.h"

namespace ctpm {

/// When a solve may stop. Norms are of the preconditioned residual, whose square is an energy.
struct CgLimits {
  double relative = 1e-4;  ///< residual against that of the first guess, or against the root of the first guess's
                           ///< kinetic energy x M x where that is less: dashpots that are far stiffer than the mass make
                           ///< the first residual so large that soft motions would be left unsolved
  double absolute = 0;     ///< residual that counts as solved anyway
  std::int32_t max_iterations = 200;
};

struct CgOutcome {
  std::int32_t iterations = 0;
  double residual = 0;  ///< relative to that of the first guess
  bool converged = false;
};

/// Conjugate gradients for A x = b with A = mass + coupling, symmetric and positive definite, preconditioned by each
/// sphere's own 3x3 block (Saad, "Iterative methods for sparse linear systems", 2003, alg. 9.1). Sums go slab by slab,
/// so they do not depend on the number of threads.
class ConjugateGradient {
 public:
  ConjugateGradient(const Model& model, const Slabs& slabs, Team& team, const Kernels& kernels);

  /// Takes the diagonal blocks of A. Coordinates that are held, as in Model::held_axes, and the sphere `pinned` stay at
  /// the first guess: their rows are left out of the system.
  void set_blocks(const DiagonalBlocks& blocks, std::int32_t pinned);

  /// `x` is the first guess and the result. `add_coupling(in, out)` does out += coupling times in.
  template <class AddCoupling>
  CgOutcome solve(const Coordinates& b, Coordinates& x, const CgLimits& limits, AddCoupling&& add_coupling);

 private:
  template <class Part>
  double sum_over_slabs(Part&& part);
  void hold(std::size_t sphere, std::uint8_t axes);

  const Model& model_;
  const Slabs& slabs_;
  Team& team_;
  const Kernels& kernels_;
  std::vector<std::int32_t> held_;  ///< spheres of which an axis or more is held
  std::vector<double> inverse_;     ///< inverse blocks, 0 along held axes (6 x sphere_count)
  Coordinates residual_, preconditioned_, direction_, product_;
  std::vector<double> part_;  ///< of a sum (slab_count)
};

template <class Part>
double ConjugateGradient::sum_over_slabs(Part&& part) {
  team_.for_each(slabs_.count(), [&](int slab) {
    part_[std::size_t(slab)] = part(std::size_t(slabs_.begin(slab)), std::size_t(slabs_.end(slab)));
  });
  double sum = 0;
  for (const double value : part_) sum += value;
  return sum;
}

template <class AddCoupling>
CgOutcome ConjugateGradient::solve(const Coordinates& b, Coordinates& x, const CgLimits& limits,
                                   AddCoupling&& add_coupling) {
  const SolverArrays m{model_.sphere_count(),  model_.mass.data(), inverse_.data(), x.data(), residual_.data(),
                       preconditioned_.data(), direction_.data(),  product_.data()};
  const auto for_each_slab = [&](auto&& part) {
    team_.for_each(slabs_.count(),
                   [&](int slab) { part(std::size_t(slabs_.begin(slab)), std::size_t(slabs_.end(slab))); });
  };
  for_each_slab([&](std::size_t begin, std::size_t end) { kernels_.multiply_mass(m, x.data(), begin, end); });
  const double kinetic = sum_over_slabs([&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = axis * m.spheres + begin; i < axis * m.spheres + end; ++i) sum += x[i] * product_[i];
    return sum;
  });
  add_coupling(x.data(), m.product);
  double energy = sum_over_slabs(
      [&](std::size_t begin, std::size_t end) { return kernels_.begin_solve(m, b.data(), begin, end); });
  const double first_energy = energy;
  const double enough =
      std::max(std::min(first_energy, kinetic) * limits.relative * limits.relative, limits.absolute * limits.absolute);

  CgOutcome outcome;
  double turn = 0;
  while (energy > enough && outcome.iterations < limits.max_iterations) {
    for_each_slab([&](std::size_t begin, std::size_t end) { kernels_.turn(m, turn, begin, end); });
    add_coupling(m.direction, m.product);
    const double curvature =
        sum_over_slabs([&](std::size_t begin, std::size_t end) { return kernels_.curvature(m, begin, end); });
    if (!(curvature > 0)) break;  // not a number, or nothing left to gain
    const double step = energy / curvature;
    const double next =
        sum_over_slabs([&](std::size_t begin, std::size_t end) { return kernels_.descend(m, step, begin, end); });
    turn = next / energy;
    energy = next;
    ++outcome.iterations;
  }
  outcome.converged = energy <= enough;
  outcome.residual = first_energy > 0 ? std::sqrt(energy / first_energy) : 0.0;
  return outcome;
}

}  // namespace ctpm
