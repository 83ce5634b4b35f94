#include "core/solver/linear_solver.h"

#include <algorithm>

namespace ctpm::solver {
namespace {

/// Largest stiffness ratio at which float resolves soft motions beside stiff ones.
constexpr double kStiffestForFloat = 1e4;

std::variant<ConjugateGradient<float>, ConjugateGradient<double>> gradient_for(const elements::Elements& elements,
                                                                               parallel::Team& team,
                                                                               const elements::Kernels& kernels,
                                                                               double stiffness_ratio) {
  if (stiffness_ratio <= kStiffestForFloat) return ConjugateGradient<float>(elements, team, kernels);
  return ConjugateGradient<double>(elements, team, kernels);
}

}  // namespace

LinearSolver::LinearSolver(const Model& model, const elements::Elements& elements, parallel::Team& team,
                           const elements::Kernels& kernels, double stiffness_ratio)
    : model_(model),
      slabs_(elements.slabs()),
      team_(team),
      kernels_(kernels),
      residual_(3 * model.sphere_count()),
      parts_(std::size_t(slabs_.count())),
      gradient_(gradient_for(elements, team, kernels, stiffness_ratio)) {
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] != 0) held_.push_back(std::int32_t(i));
}

double LinearSolver::energy_of(const elements::Coordinates& v) {
  return sum_over_slabs(slabs_, team_, parts_, [&](std::size_t begin, std::size_t end) {
    return kernels_.multiply_mass(model_.sphere_count(), model_.mass.data(), v.data(), residual_.data(), begin, end);
  });
}

void LinearSolver::set_blocks(const elements::DiagonalBlocks& blocks, std::span<const std::int32_t> pinned) {
  std::visit([&](auto& gradient) { set_blocks_of(gradient, blocks, pinned); }, gradient_);
}

template <class Real>
void LinearSolver::set_blocks_of(ConjugateGradient<Real>& gradient, const elements::DiagonalBlocks& blocks,
                                 std::span<const std::int32_t> pinned) {
  const std::size_t n = model_.sphere_count();
  const elements::SolverKernels<Real>& kernels = elements::solver_kernels<Real>(kernels_);
  std::vector<Real>& factor = gradient.factor();
  slabs_.for_each_awake(team_, [&](int slab) {
    kernels.factor_blocks(n, blocks.data(), factor.data(), std::size_t(slabs_.begin(slab)),
                          std::size_t(slabs_.end(slab)));
  });
  // A sweep's last vector reaches into the next slab. If that sleeps, nobody has set its factor.
  for (const int slab : slabs_.asleep())
    for (std::size_t k = 0; k < 6; ++k)
      std::fill_n(&factor[k * n + std::size_t(slabs_.begin(slab))],
                  std::min(elements::kLanes, slabs_.end(slab) - slabs_.begin(slab)), Real(0));
  constexpr std::uint8_t kAxes[6] = {1, 3, 5, 2, 6, 4};  // which axes xx, xy, xz, yy, yz, zz belong to
  const auto hold = [&](std::size_t sphere, std::uint8_t axes) {
    // Factors the block of the free axes by itself.
    double own[6];
    Real free[6];
    for (std::size_t k = 0; k < 6; ++k) {
      const bool is_diagonal = k == 0 || k == 3 || k == 5;
      own[k] = is_diagonal || (kAxes[k] & axes) == 0 ? blocks[k * n + sphere] : 0.0;
    }
    kernels.factor_blocks(1, own, free, 0, 1);
    for (std::size_t k = 0; k < 6; ++k) factor[k * n + sphere] = (kAxes[k] & axes) == 0 ? free[k] : Real(0);
  };
  for (const int slab : slabs_.awake()) {
    const auto first = std::lower_bound(held_.begin(), held_.end(), slabs_.begin(slab)),
               last = std::lower_bound(first, held_.end(), slabs_.end(slab));
    for (auto sphere = first; sphere != last; ++sphere)
      hold(std::size_t(*sphere), model_.held_axes[std::size_t(*sphere)]);
  }
  for (const std::int32_t sphere : pinned)
    if (sphere >= 0) hold(std::size_t(sphere), kAnchored);
}

}  // namespace ctpm::solver
