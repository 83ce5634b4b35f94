#include "core/solver/linear_solver.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/elements/elements.h"
#include "core/elements/kernels/kernels.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

/// Neighbours in the numbering of spheres pull at each other; the preconditioner knows the masses alone.
struct Chain {
  Model model = testing::make_block_model(5, 5, 5);
  parallel::Slabs slabs{model.sphere_count()};
  parallel::Team team{1};
  solver::LinearSolver solver{model, slabs, team, elements::kernels_for(elements::best_instruction_set()), 100};
  elements::Coordinates b = elements::Coordinates(3 * model.sphere_count()),
                        x = elements::Coordinates(3 * model.sphere_count(), 1.0);

  Chain() {
    const std::size_t n = model.sphere_count();
    elements::DiagonalBlocks masses(6 * n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (const std::size_t diagonal : {0, 3, 5}) masses[diagonal * n + i] = model.mass[i];
    solver.set_blocks(masses, std::array<std::int32_t, 1>{-1});
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = model.mass[0] * double(1 + i % 7);
  }

  solver::SolverOutcome solve(const solver::SolverLimits& limits) {
    return solver.solve(b, x, {}, limits, [&](const auto* in, auto* out, auto&& after) {
      using Real = std::remove_cvref_t<decltype(*in)>;
      const Real stiffness = Real(20 * model.mass[0]);
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        const Real apart = in[i + 1] - in[i];
        out[i] -= stiffness * apart, out[i + 1] += stiffness * apart;
      }
      for (int slab = 0; slab < slabs.count(); ++slab) after(slab);
      return 0.0;
    });
  }
};

TEST(LinearSolver, WhatCountedAsSolvedIsALimitForTheNextSolve) {
  // Were the next solve held against its own first guess, it would begin to solve what is solved.
  Chain chain;
  const solver::SolverOutcome first = chain.solve({.relative = 1e-3});
  EXPECT_TRUE(first.converged);
  EXPECT_GT(first.iterations, 3);
  EXPECT_GT(first.enough, 0);
  const elements::Coordinates solved = chain.x;
  const solver::SolverOutcome next = chain.solve({.relative = 1e-3, .absolute = first.enough});
  EXPECT_TRUE(next.converged);
  EXPECT_EQ(next.iterations, 0);
  EXPECT_EQ(chain.x, solved);
  EXPECT_GT(chain.solve({.relative = 1e-3}).iterations, 3);
}

}  // namespace
}  // namespace ctpm
