#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ctpm {

/// Dot product whose order of summation depends on the length alone, never on the instruction set.
double fixed_order_dot(std::span<const double> a, std::span<const double> b);

/// When a solve may stop. Norms are of the preconditioned residual, whose square is an energy.
struct CgLimits {
  double relative = 1e-4;  ///< residual against that of the first guess
  double absolute = 0;     ///< residual that counts as solved anyway
  std::int32_t max_iterations = 200;
};

struct CgOutcome {
  std::int32_t iterations = 0;
  double residual = 0;  ///< relative to that of the first guess
  bool converged = false;
};

/// Preconditioned conjugate gradients for a symmetric positive definite matrix. Owns its vectors.
class ConjugateGradient {
 public:
  explicit ConjugateGradient(std::size_t size)
      : residual_(size), preconditioned_(size), direction_(size), product_(size) {}

  /// Solves A x = b. `x` is the first guess and the result. `apply(in, out)` sets out = A in;
  /// `precondition(in, out)` sets out = P in with P an approximate inverse of A.
  template <class Apply, class Precondition>
  CgOutcome solve(const std::vector<double>& b, std::vector<double>& x, const CgLimits& limits, Apply&& apply,
                  Precondition&& precondition);

 private:
  std::vector<double> residual_, preconditioned_, direction_, product_;
};

template <class Apply, class Precondition>
CgOutcome ConjugateGradient::solve(const std::vector<double>& b, std::vector<double>& x,
                                   const CgLimits& limits, Apply&& apply, Precondition&& precondition) {
  const std::size_t n = b.size();
  apply(x, product_);
  for (std::size_t i = 0; i < n; ++i) residual_[i] = b[i] - product_[i];
  precondition(residual_, preconditioned_);
  direction_ = preconditioned_;
  double energy = fixed_order_dot(residual_, preconditioned_);
  const double first_energy = energy;
  const double enough =
      std::max(first_energy * limits.relative * limits.relative, limits.absolute * limits.absolute);

  CgOutcome outcome;
  while (energy > enough && outcome.iterations < limits.max_iterations) {
    apply(direction_, product_);
    const double curvature = fixed_order_dot(direction_, product_);
    if (!(curvature > 0)) break;  // not a number, or nothing left to gain
    const double step = energy / curvature;
    for (std::size_t i = 0; i < n; ++i) x[i] += step * direction_[i];
    for (std::size_t i = 0; i < n; ++i) residual_[i] -= step * product_[i];
    precondition(residual_, preconditioned_);
    const double next = fixed_order_dot(residual_, preconditioned_);
    const double turn = next / energy;
    for (std::size_t i = 0; i < n; ++i) direction_[i] = preconditioned_[i] + turn * direction_[i];
    energy = next;
    ++outcome.iterations;
  }
  outcome.converged = energy <= enough;
  outcome.residual = first_energy > 0 ? std::sqrt(energy / first_energy) : 0.0;
  return outcome;
}

}  // namespace ctpm
