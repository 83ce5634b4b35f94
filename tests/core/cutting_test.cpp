// What a blade severs, what it feels, and what is left.

#include "core/cutting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/forces.h"
#include "core/pieces.h"
#include "core/step.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

using testing::make_block;
using testing::make_block_model;
using testing::scalpel;
using testing::shake;

constexpr double kToughness = 164, kFriction = 2000;  // [J/m^2], [Pa]

Material resisting(double toughness = kToughness, double friction = 0) {
  Material material = testing::liver_material();
  material.fracture_toughness = toughness, material.blade_friction = friction;
  return material;
}

/// A block with a blade longer than the block is high.
Model block_with_blade(int ni, int nj, int nk, const Material& material,
                       Structure structure = Structure::ctpm) {
  Model model = make_block_model(ni, nj, nk, structure, material);
  model.tools = {scalpel(0.2)};
  model.solver.tolerance = 1e-11, model.solver.velocity_floor = 1e-14, model.solver.max_iterations = 2000;
  return model;
}

Model held_block(int ni, int nj, int nk, const Material& material = resisting()) {
  Model model = block_with_blade(ni, nj, nk, material);
  model.held_axes.assign(model.sphere_count(), kAnchored);
  return model;
}

Model free_block(int ni, int nj, int nk, const Material& material = resisting()) {
  Model model = block_with_blade(ni, nj, nk, material);
  model.held_axes.assign(model.sphere_count(), 0);
  return model;
}

Inputs blade_at(Vec3 tip) {
  Inputs inputs;
  inputs.tool = 0, inputs.position = tip;
  return inputs;
}

double kinetic_energy(const Model& model, const State& state) {
  double sum = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    sum += 0.5 * model.mass[i] * dot(state.velocity[i], state.velocity[i]);
  return sum;
}

Vec3 momentum(const Model& model, const State& state) {
  Vec3 sum;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) sum += model.mass[i] * state.velocity[i];
  return sum;
}

TEST(BladeForce, EveryPlaneOpensItsOwnAreaWhicheverWayItLies) {
  for (const LatticeKind lattice : {LatticeKind::cubic_18, LatticeKind::cubic_6}) {
    OrganSettings settings;
    settings.material = resisting(), settings.lattice = lattice;
    Model model;
    const FilledOrgan block = make_block(7, 7, 7);
    ASSERT_TRUE(add_organ(model, block, settings));
    const std::int32_t middle = 3 + 7 * (3 + 7 * 3);
    testing::Noise noise;
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 wild = noise.next_vec3(), n = wild / norm(wild);
      double opened = 0;  // energy per area of a plane with the normal n, from the elements of one sphere
      const auto add = [&](const auto& elements, const std::vector<double>& energy) {
        for (std::size_t e = 0; e < elements.size(); ++e) {
          if (elements.a[e] != middle && elements.b[e] != middle) continue;
          const Vec3 d = model.rest_position[std::size_t(elements.b[e])] -
                         model.rest_position[std::size_t(elements.a[e])];
          // Each direction leaves a sphere twice, and a volume s^3 has one element of each.
          opened += 0.5 * energy[e] * std::abs(dot(n, d)) / norm(d) * std::abs(dot(n, d)) /
                    std::pow(block.spacing, 3);
        }
      };
      add(model.edges, model.cut_resistance.edge_energy);
      add(model.tpms, model.cut_resistance.tpm_energy);
      EXPECT_NEAR(opened, kToughness, 1e-9 * kToughness);
    }
  }
}

/// What the hand does along its way through a held block, and what the elements that were severed cost.
struct Work {
  double by_hand = 0, of_fracture = 0;
  State state;
};

Work cut_through(const Model& model, double per_tick, Vec3 start, Vec3 way) {
  Work work;
  work.state = rest_state(model);
  Stepper stepper(model);
  const Vec3 direction = way / norm(way);
  const int ticks = int(std::ceil(norm(way) / per_tick));
  for (int i = 0; i <= ticks; ++i) {
    const StepReport report = stepper.step(work.state, blade_at(start + std::min(i * per_tick, norm(way)) * direction));
    if (i > 0) work.by_hand -= per_tick * dot(report.tool_force, direction);
    EXPECT_LE(dot(report.tool_force, direction), 0) << "the blade is never drawn in";
  }
  const Vec3 across = cross(direction, {0, 0, 1}), normal = across / norm(across);
  const auto add = [&](const auto& elements, const std::vector<std::uint8_t>& severed, const std::vector<double>& energy) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const Vec3 d = model.rest_position[std::size_t(elements.b[e])] - model.rest_position[std::size_t(elements.a[e])];
      if (severed[e]) work.of_fracture += energy[e] * std::abs(dot(normal, d)) / norm(d);
    }
  };
  add(model.edges, work.state.edge_severed, model.cut_resistance.edge_energy);
  add(model.tpms, work.state.tpm_severed, model.cut_resistance.tpm_energy);
  return work;
}

TEST(BladeForce, TheHandsWorkIsTheToughnessTimesTheAreaAtEverySpeed) {
  const Model model = held_block(6, 5, 4);
  for (const double per_tick : {2e-5, 1e-4, 1e-3, 0.02, 0.11})
    for (const Vec3 way : {Vec3{0, 0.12, 0}, Vec3{0.03, 0.12, 0}}) {
      const Work work = cut_through(model, per_tick, {-0.0131 * way.x / 0.03 + 0.0002, -0.06, -0.05}, way);
      ASSERT_GT(work.of_fracture, 0);
      // The first half millimetre in which the heading is not yet known is outside; rounding is left.
      EXPECT_NEAR(work.by_hand, work.of_fracture, 1e-6 * work.of_fracture)
          << per_tick * 1e3 << " mm a tick along " << way.x;
    }
}

TEST(BladeForce, RisesBeforeTheCutAndIsGoneAfterIt) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  Stepper stepper(model);
  State state = rest_state(model);
  double before_first = 0, while_cutting = 0;
  int severed = 0;
  StepReport report;
  for (int i = 0; i < 2400; ++i) {
    report = stepper.step(state, blade_at({0.0002, -0.06 + 5e-5 * i, -0.05}));
    ASSERT_EQ(report.status, StepStatus::ok);
    severed += report.severed;
    const double force = norm(report.tool_force);
    if (i < 300) { EXPECT_EQ(force, 0) << "far from the block, tick " << i; }
    if (severed == 0) before_first = std::max(before_first, force);
    if (severed > 0) while_cutting = std::max(while_cutting, force);
  }
  EXPECT_GT(severed, 0);
  EXPECT_GT(before_first, 0.5);
  // J_c times the height of the block is the mean force of a blade that cuts it.
  const double steady = kToughness * 0.048;
  EXPECT_GT(while_cutting, 0.7 * steady);
  EXPECT_LT(while_cutting, 4 * steady);
  EXPECT_EQ(norm(report.tool_force), 0) << "the blade has left";
}

TEST(BladeForce, ARestingBladeGoesOnHoldingTheTissueBack) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  Stepper stepper(model);
  State state = rest_state(model);
  StepReport report;
  double y = -0.06;
  for (; y < 0 && report.tool_force.y > -1; y += 5e-5) report = stepper.step(state, blade_at({0.0002, y, -0.05}));
  ASSERT_LT(y, 0);
  for (int i = 0; i < 50; ++i) {
    // The hand trembles by 20 micrometres and the force does not jump.
    const double before = report.tool_force.y;
    report = stepper.step(state, blade_at({0.0002, y + (i % 2 ? 2e-5 : 0.0), -0.05}));
    EXPECT_LT(report.tool_force.y, -0.3);
    if (i > 0) { EXPECT_NEAR(report.tool_force.y, before, 0.15 * std::abs(before)) << i; }
  }
}

TEST(BladeForce, FlanksRubUntilTheBladeLeaves) {
  const Model model = held_block(6, 5, 4, resisting(0, kFriction));
  Stepper stepper(model);
  State state = rest_state(model);
  double most = 0;
  StepReport report;
  for (int i = 0; i < 1200; ++i) {
    report = stepper.step(state, blade_at({0.0002, -0.06 + 1e-4 * i, -0.05}));
    EXPECT_LE(report.tool_force.y, 0);
    most = std::max(most, -report.tool_force.y);
  }
  // Two flanks, 6 mm high, along the 48 mm of the blade that are inside.
  const double expected = 2 * kFriction * 0.006 * 0.048;
  EXPECT_GT(most, 0.5 * expected);
  EXPECT_LT(most, 2 * expected);
  EXPECT_EQ(norm(report.tool_force), 0);
}

TEST(BladeForce, TheTissueFeelsWhatTheHandFeels) {
  const Model model = free_block(6, 5, 4, resisting(kToughness, kFriction));
  Stepper stepper(model);
  State state = rest_state(model);
  Vec3 before;
  double largest = 0;
  for (const double per_tick : {1e-4, 4e-3})
    for (int i = 0; i < 300; ++i) {
      const Vec3 middle = state.position[70];
      const StepReport report = stepper.step(
          state, blade_at({0.0002 + 1e-5 * i, middle.y - 0.04 + per_tick * (i % 25), -0.05}));
      const Vec3 now = momentum(model, state), gained = now - before;
      EXPECT_NEAR(norm(gained + model.tick * report.tool_force), 0, 1e-9 + 1e-5 * norm(gained)) << i;
      largest = std::max(largest, norm(report.tool_force));
      before = now;
    }
  EXPECT_GT(largest, 1);
}

TEST(BladeForce, TissueNeverGainsMoreEnergyThanTheHandGives) {
  for (const double per_tick : {1e-4, 2e-3, 0.03}) {
    const Model model = free_block(6, 5, 4, resisting(kToughness, kFriction));
    Stepper stepper(model);
    State state = rest_state(model);
    double given = 0;
    const int ticks = int(0.12 / per_tick);
    for (int i = 0; i <= ticks + 50; ++i) {
      const int moved = std::min(i, ticks);
      const StepReport report = stepper.step(state, blade_at({0.0002, -0.06 + per_tick * moved, -0.05}));
      if (i > 0 && i <= ticks) given -= per_tick * report.tool_force.y;
      EXPECT_LE(elastic_energy(model, state) + kinetic_energy(model, state), given + 1e-9) << "tick " << i;
    }
    EXPECT_GT(given, 0);
  }
}

TEST(Severing, ConservesMomentumAndNeverAddsEnergy) {
  for (const Structure structure :
       {Structure::mass_spring, Structure::angle_mass_spring, Structure::tpm, Structure::ctpm}) {
    const Model model = block_with_blade(6, 5, 4, resisting(), structure);
    State state = rest_state(model);
    shake(state, 0.002, 0.5);
    const State before = state;
    std::vector<Crossing> crossings;
    EXPECT_GT(sever_swept_by_blade(model, {{0.0002, -0.06, -0.05}, {0.0002, -0.06, 0.15}},
                                   {{0.0032, 0.01, -0.05}, {0.0012, 0.02, 0.15}}, state.position, state, crossings),
              0);
    EXPECT_EQ(state.velocity, before.velocity);
    EXPECT_EQ(state.position, before.position);
    EXPECT_LE(elastic_energy(model, state), elastic_energy(model, before));
    Vec3 force;
    const Vec3Array forces = internal_forces(model, state);
    for (std::size_t i = 0; i < forces.size(); ++i) force += forces[i];
    EXPECT_NEAR(norm(force), 0, 1e-9);
  }
}

TEST(Severing, IsTheSameAtEverySpeedThroughAHeldOrgan) {
  // Straight, slanted and through a single sheet of spheres; the last speed jumps over the block in one tick.
  for (const auto& [ni, nj, nk] : {std::array{6, 5, 4}, std::array{6, 5, 1}, std::array{6, 1, 4}})
    for (const Vec3 way : {Vec3{0, 0.12, 0}, Vec3{0.05, 0.12, 0.01}}) {
      const Model model = held_block(ni, nj, nk);
      State slow;
      for (const double per_tick : {5e-5, 7e-4, 0.013, 0.2}) {
        State state = cut_through(model, per_tick, Vec3{0.0002, -0.06, -0.05} - 0.5 * Vec3{way.x, 0, 0}, way).state;
        if (slow.edge_severed.empty()) {
          slow = state;
          continue;
        }
        EXPECT_EQ(state.edge_severed, slow.edge_severed);
        EXPECT_EQ(state.tpm_severed, slow.tpm_severed);
        EXPECT_EQ(state.constraint_severed, slow.constraint_severed);
        for (std::size_t e = 0; e < state.edge_crossing.size(); ++e)
          EXPECT_NEAR(crossing_of(state.edge_crossing[e]), crossing_of(slow.edge_crossing[e]), 1.01 * kCrossingUnit);
      }
      const auto severed = std::count(slow.edge_severed.begin(), slow.edge_severed.end(), 1) +
                           std::count(slow.tpm_severed.begin(), slow.tpm_severed.end(), 1);
      EXPECT_GT(severed, 0);
    }
}

TEST(Severing, RemembersWhereTheBladePassed) {
  const Model model = held_block(6, 5, 4);
  const double x = 0.0031;
  const State state = cut_through(model, 3e-4, {x, -0.06, -0.05}, {0, 0.12, 0}).state;
  int severed = 0;
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    if (!state.edge_severed[e]) {
      EXPECT_EQ(state.edge_crossing[e], 0);
      continue;
    }
    const double a = model.rest_position.x[std::size_t(model.edges.a[e])],
                 b = model.rest_position.x[std::size_t(model.edges.b[e])];
    EXPECT_NEAR(a + crossing_of(state.edge_crossing[e]) * (b - a), x, kCrossingUnit * 0.012);
    ++severed;
  }
  EXPECT_GT(severed, 0);
}

TEST(Severing, ATripleThatLostOneEdgeKeepsTheOther) {
  const Model model = held_block(6, 5, 4);
  const State state = cut_through(model, 3e-4, {0.0002, -0.06, -0.05}, {0, 0.12, 0}).state;
  // Every edge that the plane x = 0 does not cross lives, and every constraint that lost an edge is gone.
  for (std::size_t c = 0; c < model.constraints.size(); ++c) {
    bool lost = false;
    for (const auto& edge : model.constraints.edge) lost = lost || state.edge_severed[std::size_t(edge[c])];
    EXPECT_EQ(state.constraint_severed[c] != 0, lost);
  }
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const double a = model.rest_position.x[std::size_t(model.edges.a[e])],
                 b = model.rest_position.x[std::size_t(model.edges.b[e])];
    EXPECT_EQ(state.edge_severed[e] != 0, (a < 0.0002) != (b < 0.0002));
  }
}

TEST(Pieces, AreCountedAsTheyComeLoose) {
  const Model model = held_block(6, 6, 4);
  Stepper stepper(model);
  State state = rest_state(model);
  Pieces pieces(model);
  EXPECT_EQ(pieces.find(state), 1);
  int loose = 0;
  const auto sweep = [&](Vec3 from, Vec3 to) {
    Inputs away;
    (void)stepper.step(state, away);  // the blade is put away and taken again
    for (int i = 0; i <= 50; ++i) loose += stepper.step(state, blade_at(from + i / 50.0 * (to - from))).came_loose;
  };
  sweep({0.0002, -0.06, -0.05}, {0.0002, 0.005, -0.05});  // not through
  EXPECT_EQ(loose, 0);
  sweep({0.0002, 0.06, -0.05}, {0.0002, -0.001, -0.05});  // and from the other side
  EXPECT_EQ(loose, 1);
  sweep({-0.06, 0.0003, -0.05}, {0.06, 0.0003, -0.05});  // across
  EXPECT_EQ(loose, 3);
  sweep({-0.06, 0.0003, -0.05}, {0.06, 0.0003, -0.05});  // again
  EXPECT_EQ(loose, 3);
  EXPECT_EQ(pieces.find(state), 4);
  EXPECT_EQ(pieces.piece()[0], 0);
  EXPECT_EQ(pieces.piece()[5], 3);
}

/// A block cut through in the middle, whose right half is pushed against the left one: the least distance that
/// two spheres of its halves ever have [m].
double gap_after_pushing(bool lips_meet, double sideways) {
  Model model = block_with_blade(6, 4, 4, resisting(0));
  model.held_axes.assign(model.sphere_count(), 0);
  model.lip_k = lips_meet ? model.edges.k[0] : 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    if (i % 6 == 0) model.held_axes[i] = kAnchored;
    if (i % 6 != 5) continue;
    model.loads.sphere.push_back(std::int32_t(i)), model.loads.force.push_back({-0.1, sideways, 0});
    model.loads.start.push_back(0.05), model.loads.ramp.push_back(0.1);
  }
  Stepper stepper(model);
  State state = rest_state(model);
  double gap = INFINITY;
  for (int i = 0; i < 400; ++i) {
    const Inputs inputs = i < 50 ? blade_at({0.0002, -0.05 + 0.002 * i, -0.05}) : Inputs{};
    EXPECT_EQ(stepper.step(state, inputs).status, StepStatus::ok);
    if (i % 5 != 0) continue;
    for (std::size_t a = 0; a < model.sphere_count(); ++a)
      for (std::size_t b = 0; b < model.sphere_count(); ++b)
        if (a % 6 < 3 && b % 6 >= 3) gap = std::min(gap, norm(state.position[b] - state.position[a]));
  }
  return gap;
}

TEST(Lips, MeetAgainWithoutPassingThroughEachOther) {
  EXPECT_LT(gap_after_pushing(false, 0), 0.002);
  EXPECT_GT(gap_after_pushing(true, 0), 0.009);
  EXPECT_GT(gap_after_pushing(true, 0.03), 0.007);  // while they slide past each other
}

TEST(Lips, ConserveMomentum) {
  Model model = free_block(6, 4, 4, resisting(0));
  model.lip_k = model.edges.k[0];
  Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i < 50; ++i) (void)stepper.step(state, blade_at({0.0002, -0.05 + 0.002 * i, -0.05}));
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    state.velocity.set(i, {i % 6 < 3 ? 0.2 : -0.2, i % 6 < 3 ? 0.05 : -0.01, 0});
  const Vec3 before = momentum(model, state);
  double energy = kinetic_energy(model, state) + elastic_energy(model, state);
  for (int i = 0; i < 300; ++i) (void)stepper.step(state, {});
  EXPECT_NEAR(norm(momentum(model, state) - before), 0, 1e-6 * norm(before) + 1e-9);
  EXPECT_LE(kinetic_energy(model, state) + elastic_energy(model, state), energy);
  double left = 0, right = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    (i % 6 < 3 ? left : right) += state.velocity.x[i] * model.mass[i];
  EXPECT_LT(left, right) << "they have met and do not move through each other";
}

}  // namespace
}  // namespace ctpm
