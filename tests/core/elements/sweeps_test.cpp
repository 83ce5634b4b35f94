#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/elements/elements.h"
#include "core/model/state.h"
#include "core/parallel/team.h"
#include "core/solver/linear_solver.h"
#include "core/stepping/integrator.h"
#include "core/stepping/motion.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

using elements::Coordinates;

/// The linearised elements of a shaken block without its mass.
struct Linearised {
  explicit Linearised(const Model& model, double h = 1e-3)
      : model(model),
        elements(model, team),
        state(rest_state(model)),
        force(3 * model.sphere_count()),
        blocks(6 * model.sphere_count()) {
    testing::shake(state, 5e-4, 0.1);
    for (std::size_t i = 0; i < state.axial_severed.size(); i += 7) state.axial_severed[i] = 1;
    elements.linearise(state, h, false, force, blocks, [](int) {});
  }

  const Model& model;
  parallel::Team team{2};
  elements::Elements elements;
  State state;
  Coordinates force;
  elements::DiagonalBlocks blocks;
};

Coordinates random_vector(std::size_t size) {
  testing::Noise noise;
  Coordinates v(size);
  for (double& x : v) x = noise.next();
  return v;
}

/// A ball-shaped organ: its rows have all lengths, and begin anywhere.
Model make_ball(int n, double viscosity) {
  FilledOrgan block = testing::make_block(n, n, n), ball = block;
  ball.cell.clear(), ball.centre.clear(), ball.layer.clear(), ball.depth.clear();
  const double middle = 0.5 * (n - 1);
  for (std::size_t i = 0; i < block.cell.size(); ++i) {
    const auto [x, y, z] = block.cell[i];
    if (std::hypot(x - middle, y - middle, z - middle) > middle + 0.1) continue;
    ball.cell.push_back(block.cell[i]), ball.centre.push_back(block.centre[i]);
    ball.layer.push_back(block.layer[i]), ball.depth.push_back(block.depth[i]);
  }
  network::OrganSettings settings;
  settings.name = "ball";
  settings.structure = network::Structure::ctpm;
  settings.material = testing::liver_material();
  settings.material.viscosity = viscosity;
  settings.anchored = {0};
  Model model;
  const Result<Done> added = network::add_organ(model, ball, settings);
  CTPM_CHECK(bool(added), "a test's own ball is valid");
  stepping::resolve_integrator(model);
  return model;
}

std::vector<Model> every_shape() {
  std::vector<Model> models;
  models.push_back(testing::make_block_model(3, 1, 1));
  models.push_back(testing::make_block_model(7, 6, 5));
  models.push_back(testing::make_block_model(22, 5, 17));  // two slabs
  models.push_back(testing::make_block_model(5, 6, 6, network::Structure::angle_mass_spring));
  models.push_back(make_ball(9, 5e6)), models.push_back(make_ball(18, 5e6));
  for (Model& model : models) model.tools = {testing::scalpel(0.02)};
  return models;
}

TEST(Sweeps, HaveEachSphereInOneChunkAndCoupleChunksInTheirOrder) {
  for (const Model& model : every_shape()) {
    Linearised linear(model);
    std::int32_t next = 0;
    const parallel::Slabs& slabs = linear.elements.slabs();
    for (int slab = 0; slab < slabs.count(); ++slab) {
      const elements::Sweep sweep = linear.elements.sweep(slab);
      for (const elements::SweepChunk* chunk = sweep.first; chunk != sweep.last; ++chunk) {
        EXPECT_EQ(chunk->first, next);
        EXPECT_GE(chunk->count, 1);
        EXPECT_LE(chunk->count, elements::kLanes);
        next += chunk->count;
        for (const elements::SweepPiece* piece = chunk->later; piece != chunk->end; ++piece) {
          ASSERT_LT(piece->begin, piece->end);
          EXPECT_GE(piece->begin, 0);
          EXPECT_LE(piece->end, chunk->count);
          EXPECT_GE(piece->across + piece->begin, sweep.begin);
          EXPECT_LE(piece->across + piece->end, sweep.end);
          if (piece < chunk->earlier) {
            EXPECT_GE(piece->across + piece->begin, next);
          } else if (piece < chunk->beside) {
            EXPECT_LE(piece->across + piece->end, chunk->first);
          }
        }
      }
      EXPECT_EQ(next, slabs.end(slab));
    }
  }
}

/// result += what pieces couple, with the sign that it has in the matrix.
void apply_pieces(const Linearised& linear, const Coordinates& v, Coordinates& result) {
  const std::size_t n = linear.model.sphere_count();
  const elements::SweepCoupling c = linear.elements.sweep_coupling();
  for (int slab = 0; slab < linear.elements.slabs().count(); ++slab) {
    const elements::Sweep sweep = linear.elements.sweep(slab);
    for (const elements::SweepChunk* chunk = sweep.first; chunk != sweep.last; ++chunk)
      for (const elements::SweepPiece* piece = chunk->later; piece != chunk->end; ++piece)
        for (std::int32_t lane = piece->begin; lane < piece->end; ++lane) {
          const std::ptrdiff_t place = piece->place + lane;
          const auto to = std::size_t(chunk->first + lane), from = std::size_t(piece->across + lane);
          const Vec3 root{c.root_x[place], c.root_y[place], c.root_z[place]}, at{v[from], v[n + from], v[2 * n + from]};
          const Vec3 q = dot(root, at) * root + double(c.across[place]) * at;
          result[to] -= q.x, result[n + to] -= q.y, result[2 * n + to] -= q.z;
        }
  }
}

TEST(Sweeps, PiecesBlocksAndWhatTheyLeaveAreTheMatrix) {
  for (const Model& model : every_shape()) {
    Linearised linear(model);
    const std::size_t n = model.sphere_count();
    const Coordinates v = random_vector(3 * n);
    Coordinates whole(3 * n), parts(3 * n);
    linear.elements.apply(v.data(), whole.data());
    linear.elements.apply_lagged(v.data(), parts.data());
    apply_pieces(linear, v, parts);
    constexpr std::size_t kEntry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
          parts[row * n + i] += linear.blocks[kEntry[row][column] * n + i] * v[column * n + i];
    const double largest = std::abs(
        *std::max_element(whole.begin(), whole.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    EXPECT_GT(largest, 0);
    for (std::size_t i = 0; i < 3 * n; ++i) ASSERT_NEAR(parts[i], whole[i], 1e-13 * largest) << n << " spheres, " << i;
  }
}

/// Solves M + coupling, with one sphere pinned, for a random right-hand side, and compares with a dense factorisation.
/// `tolerance`: of the root mean square of velocities.
void expect_solution(const Model& model, double ratio, double error, double tolerance = 1e-12) {
  Linearised linear(model);
  const std::size_t n = model.sphere_count();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(Eigen::Index(3 * n), Eigen::Index(3 * n));
  const auto pinned = std::int32_t(n - 1);
  const auto is_free = [&](std::size_t i) {
    return i % n != std::size_t(pinned) && (model.held_axes[i % n] >> (i / n) & 1) == 0;
  };
  for (std::size_t column = 0; column < 3 * n; ++column) {
    Coordinates unit(3 * n), product(3 * n);
    unit[column] = 1;
    linear.elements.apply(unit.data(), product.data());
    for (std::size_t row = 0; row < 3 * n; ++row)
      if (is_free(row) && is_free(column)) a(Eigen::Index(row), Eigen::Index(column)) = product[row];
    a(Eigen::Index(column), Eigen::Index(column)) += model.mass[column % n];
  }
  Coordinates b = random_vector(3 * n), x(3 * n);
  for (std::size_t i = 0; i < 3 * n; ++i) b[i] *= is_free(i) ? model.mass[i % n] : 0;
  elements::DiagonalBlocks blocks = linear.blocks;
  for (const std::size_t k : {0u, 3u, 5u})
    for (std::size_t i = 0; i < n; ++i) blocks[k * n + i] += model.mass[i];
  solver::LinearSolver solver(model, linear.elements, linear.team,
                              elements::kernels_for(elements::best_instruction_set()), ratio);
  solver.set_blocks(blocks, std::array{pinned});
  const auto outcome = solver.solve(
      b, x, std::nullopt, {0, tolerance * std::sqrt(stepping::total_mass(model)), 20000},
      [&](const double* in, double* out, bool) { linear.elements.apply(in, out); },
      [&](const auto* in, auto* out) { linear.elements.apply_lagged(in, out); });
  EXPECT_GT(outcome.iterations, 0);
  const Eigen::VectorXd exact = a.ldlt().solve(Eigen::Map<Eigen::VectorXd>(b.data(), Eigen::Index(3 * n)));
  for (std::size_t i = 0; i < 3 * n; ++i)
    ASSERT_NEAR(x[i], exact[Eigen::Index(i)], error * exact.lpNorm<Eigen::Infinity>()) << i;
}

TEST(Elements, MultiplyWhileTheyAreLinearisedToTheBit) {
  for (const int n : {6, 16}) {  // one slab, and several
    for (const double viscosity : {0.0, 5e6}) {
      Model model = testing::make_block_model(n, n, n, network::Structure::ctpm, [&] {
        network::Material material = testing::liver_material();
        material.viscosity = viscosity;
        return material;
      }());
      model.tools = {testing::scalpel(0.02)};
      Linearised linear(model);
      const Coordinates v = random_vector(3 * model.sphere_count());
      Coordinates later = random_vector(v.size()), product = later, force(v.size());
      linear.elements.apply(v.data(), later.data());
      linear.elements.linearise(
          linear.state, 1e-3, false, force, linear.blocks, [](int) {}, v.data(), product.data());
      EXPECT_EQ(product, later) << n << " " << viscosity;
    }
  }
}

TEST(LinearSolver, AgreesWithADenseFactorisationInBothPrecisions) {
  for (const double viscosity : {0.0, 5e3, 5e6}) {
    Model model = make_ball(6, viscosity);
    model.tools = {testing::scalpel(0.02)};
    model.held_axes[3] = 5;  // slides along y
    expect_solution(model, 1, 1e-9);
    expect_solution(model, 1e9, 1e-9);
  }
}

TEST(LinearSolver, AgreesWithADenseFactorisationWhereDashpotsAreABillionTimesStifferThanTheMass) {
  Model model = make_ball(6, 5e12);
  model.tools = {testing::scalpel(0.02)};
  expect_solution(model, 1e9, 1e-5);
}

TEST(LinearSolver, IterationsBeyondWhatRoundingAllowsDoNoHarm) {
  for (const double ratio : {1.0, 1e9}) {
    Model model = make_ball(6, 5e6);
    model.tools = {testing::scalpel(0.02)};
    expect_solution(model, ratio, 1e-9, 0);
  }
}

}  // namespace
}  // namespace ctpm
