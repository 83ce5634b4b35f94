#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/elements/elements.h"
#include "core/model/model.h"
#include "core/parallel/slabs.h"
#include "core/parallel/team.h"
#include "core/solver/conjugate_gradient.h"

namespace ctpm::solver {

/// When a solve may stop. Norms are those of the preconditioned residual; their square is an energy.
struct SolverLimits {
  /// Residual relative to that of the first guess. The reference is the root of the kinetic energy x M x of the first
  /// guess instead where that is less: dashpots far stiffer than the mass make the first residual so large that soft
  /// motions would be left unsolved.
  double relative = 1e-4;
  double absolute = 0;  ///< residual that always counts as solved
  std::int32_t max_iterations = 200;
  double enough = 0;  ///< residual that counts as solved once an iteration was made
};

struct SolverOutcome {
  std::int32_t iterations = 0;
  double residual = 0;  ///< relative to that of the first guess
  bool converged = false;
};

/// What is known of a first guess x.
struct FirstGuess {
  double energy;  ///< energy_of(x), or of what x is a change of [J]
  bool is_zero;   ///< x is 0, as the change of a velocity; otherwise product() has a part of A x
};

/// Solves A x = b with A = mass + coupling, symmetric and positive definite, by iterative refinement (Higham, "Accuracy
/// and stability of numerical algorithms", 2002, ch. 12). Each round computes the residual in double. Its correction
/// comes from conjugate gradients, in float if the Model is soft enough and otherwise in double. One round mostly
/// suffices.
class LinearSolver {
 public:
  /// `stiffness_ratio` is a bound on the largest eigenvalue of M^-1 (A - M) [1]; it decides whether corrections are
  /// computed in float.
  LinearSolver(const Model& model, const elements::Elements& elements, parallel::Team& team,
               const elements::Kernels& kernels, double stiffness_ratio);

  /// Sets the diagonal blocks of A. Coordinates held by Model::held_axes, and the spheres `pinned` (-1: none), keep the
  /// first guess: their rows are left out of the system.
  void set_blocks(const elements::DiagonalBlocks& blocks, std::span<const std::int32_t> pinned);

  /// `x` is the first guess and the result; `guess`: what is known of it, if anything. `add_coupling(in, out,
  /// has_part)` does out += coupling times in, for vectors of double, or what product() lacks of that; `apply_lagged`
  /// is as in ConjugateGradient, for vectors of float and of double.
  template <class AddCoupling, class ApplyLagged>
  SolverOutcome solve(const elements::Coordinates& b, elements::Coordinates& x, std::optional<FirstGuess> guess,
                      const SolverLimits& limits, AddCoupling&& add_coupling, ApplyLagged&& apply_lagged);

  /// v . M v [J], twice the kinetic energy of velocity `v` [m/s]. Leaves M v in product().
  double energy_of(const elements::Coordinates& v);
  /// To M v the caller may add a part of the coupling times v before a solve from `v` (3 x sphere_count).
  elements::Coordinates& product() { return residual_; }

 private:
  template <class Real>
  void set_blocks_of(ConjugateGradient<Real>& gradient, const elements::DiagonalBlocks& blocks,
                     std::span<const std::int32_t> pinned);

  /// Factor by which one round with vectors of Real may reduce the energy of the residual; a smaller one is lost in
  /// rounding.
  template <class Real>
  static constexpr double kGain = sizeof(Real) == sizeof(float) ? 1e-10 : 1e-24;

  const Model& model_;
  const parallel::Slabs& slabs_;
  parallel::Team& team_;
  const elements::Kernels& kernels_;
  std::vector<std::int32_t> held_;  ///< spheres held along one axis or more, ascending
  elements::Coordinates residual_;
  std::vector<double> parts_;  ///< of a sum (slab_count)
  std::variant<ConjugateGradient<float>, ConjugateGradient<double>> gradient_;
};

template <class AddCoupling, class ApplyLagged>
SolverOutcome LinearSolver::solve(const elements::Coordinates& b, elements::Coordinates& x,
                                  std::optional<FirstGuess> guess, const SolverLimits& limits,
                                  AddCoupling&& add_coupling, ApplyLagged&& apply_lagged) {
  const std::size_t n = model_.sphere_count();
  SolverOutcome outcome;
  std::int32_t left = limits.max_iterations;
  double first_energy = 0, at_once = 0, later = 0;  // energies at which it ends, before and after an iteration
  std::visit(
      [&]<class Real>(ConjugateGradient<Real>& gradient) {
        for (bool is_first = true;; is_first = false) {
          const bool is_known = is_first && guess.has_value();
          const double kinetic = is_known ? guess->energy : energy_of(x);
          if (is_known && guess->is_zero)
            std::fill(residual_.begin(), residual_.end(), 0.0);
          else
            add_coupling(static_cast<const double*>(x.data()), residual_.data(), is_known);
          const double squared = sum_over_slabs(slabs_, team_, parts_, [&](std::size_t begin, std::size_t end) {
            return kernels_.residual_from(n, b.data(), residual_.data(), begin, end);
          });
          const double scale = squared > 0 ? 1 / std::sqrt(squared) : 1.0;
          const double energy = gradient.begin(residual_, scale), unit = scale * scale;
          if (is_first) {
            first_energy = energy / unit;
            at_once = std::max(std::min(first_energy, kinetic) * limits.relative * limits.relative,
                               limits.absolute * limits.absolute);
            later = std::max(at_once, limits.enough * limits.enough);
          }
          const std::int32_t before = left;
          const double rounding = energy * kGain<Real>;
          const double reached = gradient.descend(std::max(at_once * unit, rounding), std::max(later * unit, rounding),
                                                  left, apply_lagged);
          if (left != before) gradient.add_to(x);
          outcome.converged = reached <= (left == limits.max_iterations ? at_once : later) * unit;
          outcome.residual = first_energy > 0 ? std::sqrt(reached / unit / first_energy) : 0.0;
          if (outcome.converged || left == before || left == 0) break;
        }
      },
      gradient_);
  outcome.iterations = limits.max_iterations - left;
  return outcome;
}

}  // namespace ctpm::solver
