// What a blade severs and what remains.

#include "core/cutting/cutting.h"

#include "core/cutting/pieces.h"
#include "core/elements/forces.h"
#include "tests/core/blade_blocks.h"

namespace ctpm {
namespace {

using testing::blade_at;
using testing::block_with_blade;
using testing::cut_through;
using testing::free_block;
using testing::held_block;
using testing::kinetic_energy;
using testing::momentum;
using testing::resisting;
using testing::shake;
using testing::straight_front;

TEST(Severing, ConservesMomentumAndNeverAddsEnergy) {
  for (const network::Structure structure : {network::Structure::mass_spring, network::Structure::angle_mass_spring,
                                             network::Structure::tpm, network::Structure::ctpm}) {
    const Model model = block_with_blade(6, 5, 4, resisting(), structure);
    State state = rest_state(model);
    shake(state, 0.002, 0.5);
    const State before = state;
    std::vector<cutting::Crossing> crossings;
    EXPECT_GT(testing::sever(model, straight_front({0.0002, -0.06, -0.05}, {0.0002, -0.06, 0.15}),
                             straight_front({0.0032, 0.01, -0.05}, {0.0012, 0.02, 0.15}), state, crossings),
              0);
    EXPECT_EQ(state.velocity, before.velocity);
    EXPECT_EQ(state.position, before.position);
    EXPECT_LE(elements::elastic_energy(model, state), elements::elastic_energy(model, before));
    Vec3 force;
    const Vec3Array forces = elements::internal_forces(model, state);
    for (std::size_t i = 0; i < forces.size(); ++i) force += forces[i];
    EXPECT_NEAR(norm(force), 0, 1e-9);
  }
}

TEST(Severing, IsTheSameAtEverySpeedThroughAHeldOrgan) {
  // Straight, slanted and through a single sheet of spheres. The last speed passes the block in one tick.
  for (const auto& [ni, nj, nk] : {std::array{6, 5, 4}, std::array{6, 5, 1}, std::array{6, 1, 4}})
    for (const Vec3 way : {Vec3{0, 0.12, 0}, Vec3{0.05, 0.12, 0.01}}) {
      const Model model = held_block(ni, nj, nk);
      State slow;
      for (const double per_tick : {5e-5, 7e-4, 0.013, 0.2}) {
        State state = cut_through(model, per_tick, Vec3{0.0002, -0.06, -0.05} - 0.5 * Vec3{way.x, 0, 0}, way).state;
        if (slow.axial_severed.empty()) {
          slow = state;
          continue;
        }
        EXPECT_EQ(state.axial_severed, slow.axial_severed);
        EXPECT_EQ(state.constraint_severed, slow.constraint_severed);
        for (std::size_t e = 0; e < state.axial_crossing.size(); ++e)
          EXPECT_NEAR(cutting::crossing_of(state.axial_crossing[e]), cutting::crossing_of(slow.axial_crossing[e]),
                      1.01 * cutting::kCrossingUnit);
      }
      EXPECT_GT(std::count(slow.axial_severed.begin(), slow.axial_severed.end(), 1), 0);
    }
}

TEST(Severing, RemembersWhereTheBladePassed) {
  const Model model = held_block(6, 5, 4);
  const double x = 0.0031;
  const State state = cut_through(model, 3e-4, {x, -0.06, -0.05}, {0, 0.12, 0}).state;
  int severed = 0;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    if (!state.axial_severed[e]) {
      EXPECT_EQ(state.axial_crossing[e], 0);
      continue;
    }
    const double a = model.rest_position.x[std::size_t(model.axial.a[e])],
                 b = model.rest_position.x[std::size_t(model.axial.b[e])];
    EXPECT_NEAR(a + cutting::crossing_of(state.axial_crossing[e]) * (b - a), x, cutting::kCrossingUnit * 0.012);
    ++severed;
  }
  EXPECT_GT(severed, 0);
}

TEST(Severing, ATripleThatLostOneEdgeKeepsTheOther) {
  const Model model = held_block(6, 5, 4);
  const State state = cut_through(model, 3e-4, {0.0002, -0.06, -0.05}, {0, 0.12, 0}).state;
  // A constraint is severed exactly if one of its elements is, and an element exactly if the plane x = 0.2 mm crosses
  // it.
  for (std::size_t c = 0; c < model.constraints.size(); ++c) {
    bool lost = false;
    for (const auto& edge : model.constraints.edge) lost = lost || state.axial_severed[std::size_t(edge[c])];
    EXPECT_EQ(state.constraint_severed[c] != 0, lost);
  }
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const double a = model.rest_position.x[std::size_t(model.axial.a[e])],
                 b = model.rest_position.x[std::size_t(model.axial.b[e])];
    EXPECT_EQ(state.axial_severed[e] != 0, (a < 0.0002) != (b < 0.0002));
  }
}

/// Moves along a closed polygon around `middle`, with `ticks_per_side` ticks per side.
std::int32_t cut_around(stepping::Stepper& stepper, State& state, Vec3 middle, double radius, int ticks_per_side) {
  constexpr int kSides = 64;
  constexpr double kTurn = 2 * 3.14159265358979323846 / kSides;
  const auto corner = [&](int i) {
    return middle + radius * Vec3{std::cos(kTurn * (i % kSides)), std::sin(kTurn * (i % kSides)), 0};
  };
  std::int32_t severed = 0;
  for (int side = 0; side < kSides; ++side)
    for (int i = 0; i <= ticks_per_side; ++i) {
      const double share = double(i) / ticks_per_side;
      severed += stepper.step(state, blade_at((1 - share) * corner(side) + share * corner(side + 1))).severed;
    }
  return severed;
}

TEST(Severing, FollowsACurveAndCutsAPlugOut) {
  const Model model = held_block(6, 6, 3);
  const auto is_inside = [&](std::int32_t sphere) {
    const Vec3 p = model.rest_position[std::size_t(sphere)];
    return std::hypot(p.x, p.y) < 0.016;
  };
  for (const int ticks_per_side : {1, 7}) {
    State state = rest_state(model);
    stepping::Stepper stepper(model);
    EXPECT_GT(cut_around(stepper, state, {0.0002, 0.0003, -0.05}, 0.016, ticks_per_side), 0);
    for (std::size_t e = 0; e < model.axial.size(); ++e)
      EXPECT_EQ(state.axial_severed[e] != 0, is_inside(model.axial.a[e]) != is_inside(model.axial.b[e]));
    cutting::Pieces pieces(model);
    EXPECT_EQ(pieces.find(state), 2);
    for (std::int32_t i = 0; i < std::int32_t(model.sphere_count()); ++i)
      EXPECT_EQ(pieces.piece()[std::size_t(i)] == 0, !is_inside(i));
    EXPECT_EQ(cut_around(stepper, state, {0.0002, 0.0003, -0.05}, 0.016, ticks_per_side), 0)
        << "nothing is left to cut";
  }
}

/// Forces on a line of five spheres after a cut at `x`; the second sphere is displaced 1 mm to the right.
Vec3Array forces_after_cut(const Model& model, double x) {
  State state = rest_state(model);
  std::vector<cutting::Crossing> crossings;
  EXPECT_GT(testing::sever(model, straight_front({x, -0.05, -0.05}, {x, -0.05, 0.05}),
                           straight_front({x, 0.05, -0.05}, {x, 0.05, 0.05}), state, crossings),
            1)
      << "an edge and the constraint over it";
  EXPECT_EQ(crossings.size(), 1u);
  EXPECT_EQ(state.constraint_severed, std::vector<std::uint8_t>{1});
  state.position.add(1, {0.001, 0, 0});
  return elements::internal_forces(model, state);
}

TEST(Severing, WhatIsLeftOfATripleIsItsOtherEdgeAsStiffAsBefore) {
  network::Material material = testing::liver_material();
  material.kelvin = 2 * material.spring;
  const Model model = block_with_blade(5, 1, 1, material);
  ASSERT_EQ(model.axial.size(), 4u);
  ASSERT_EQ(model.constraints.size(), 1u);
  const auto edge_between = [&](std::int32_t p, std::int32_t q) {
    for (std::size_t e = 0; e < 4; ++e)
      if (std::min(model.axial.a[e], model.axial.b[e]) == p && std::max(model.axial.a[e], model.axial.b[e]) == q)
        return e;
    return std::size_t(4);
  };
  const double left = model.axial.k[edge_between(0, 1)], right = model.axial.k[edge_between(1, 2)];
  EXPECT_NE(left, right) << "a triple is a spring and a Kelvin unit";
  // If the left edge of the triple 0-1-2 is severed, only the right one acts, and vice versa.
  const Vec3Array without_left = forces_after_cut(model, -0.018), without_right = forces_after_cut(model, -0.006);
  EXPECT_EQ(without_left.x[0], 0);
  EXPECT_NEAR(without_left.x[1], -0.001 * right, 1e-9 * right);
  EXPECT_NEAR(without_left.x[2], 0.001 * right, 1e-9 * right);
  EXPECT_NEAR(without_right.x[0], 0.001 * left, 1e-9 * left);
  EXPECT_NEAR(without_right.x[1], -0.001 * left, 1e-9 * left);
  EXPECT_EQ(without_right.x[2], 0);
}

TEST(Pieces, AreCountedAsTheyComeLoose) {
  const Model model = held_block(6, 6, 4);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  cutting::Pieces pieces(model);
  EXPECT_EQ(pieces.find(state), 1);
  int loose = 0;
  const auto sweep = [&](Vec3 from, Vec3 to) {
    Inputs away;
    (void)stepper.step(state, away);  // the blade is put away and picked up again
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

/// Cuts a block in the middle and pushes its right half against the left one. Returns the least distance ever between
/// spheres of the two halves [m].
double gap_after_pushing(bool lips_meet, double sideways, double stiffening = Model{}.cut_face_stiffening) {
  Model model = block_with_blade(6, 4, 4, resisting(0));
  model.held_axes.assign(model.sphere_count(), 0);
  model.lip_k = lips_meet ? model.axial.k[0] : 0, model.cut_face_stiffening = stiffening;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    if (i % 6 == 0) model.held_axes[i] = kAnchored;
    if (i % 6 != 5) continue;
    model.loads.sphere.push_back(std::int32_t(i)), model.loads.force.push_back({-0.1, sideways, 0});
    model.loads.start.push_back(0.05), model.loads.ramp.push_back(0.1);
  }
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double gap = INFINITY;
  for (int i = 0; i < 400; ++i) {
    const Inputs inputs = i < 50 ? blade_at({0.0002, -0.05 + 0.002 * i, -0.05}) : Inputs{};
    EXPECT_EQ(stepper.step(state, inputs).status, stepping::StepStatus::ok);
    if (i % 5 != 0) continue;
    for (std::size_t a = 0; a < model.sphere_count(); ++a)
      for (std::size_t b = 0; b < model.sphere_count(); ++b)
        if (a % 6 < 3 && b % 6 >= 3) gap = std::min(gap, norm(state.position[b] - state.position[a]));
  }
  return gap;
}

TEST(CutFaces, MeetAgainWithoutPassingThroughEachOther) {
  EXPECT_LT(gap_after_pushing(false, 0), 0.002);
  EXPECT_GT(gap_after_pushing(true, 0), 0.009);
  EXPECT_GT(gap_after_pushing(true, 0.03), 0.007);  // while they slide past each other
}

TEST(CutFaces, StayFartherApartTheMoreTheirContactStiffens) {
  const double soft = gap_after_pushing(true, 0, 2), standard = gap_after_pushing(true, 0),
               stiff = gap_after_pushing(true, 0, 16);
  EXPECT_LT(soft + 2e-4, standard);
  EXPECT_LT(standard + 2e-4, stiff);
  EXPECT_LT(stiff, 0.012);
}

TEST(CutFaces, ConserveMomentum) {
  Model model = free_block(6, 4, 4, resisting(0));
  model.lip_k = model.axial.k[0];
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i < 50; ++i) (void)stepper.step(state, blade_at({0.0002, -0.05 + 0.002 * i, -0.05}));
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    state.velocity.set(i, {i % 6 < 3 ? 0.2 : -0.2, i % 6 < 3 ? 0.05 : -0.01, 0});
  const Vec3 before = momentum(model, state);
  double energy = kinetic_energy(model, state) + elements::elastic_energy(model, state);
  for (int i = 0; i < 300; ++i) (void)stepper.step(state, {});
  EXPECT_NEAR(norm(momentum(model, state) - before), 0, 1e-6 * norm(before) + 1e-9);
  EXPECT_LE(kinetic_energy(model, state) + elements::elastic_energy(model, state), energy);
  double left = 0, right = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    (i % 6 < 3 ? left : right) += state.velocity.x[i] * model.mass[i];
  EXPECT_LT(left, right) << "they have met and do not move through each other";
}

}  // namespace
}  // namespace ctpm
