// A ball touches the surface that is drawn.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/contact/contact_law.h"
#include "core/contact/drawn_surfaces.h"
#include "core/stepping/step.h"
#include "core/surface/surface.h"
#include "tests/core/integrators.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kTop = 0.036;  // of a block of four layers [m]

Inputs at(Vec3 position) {
  Inputs inputs;
  inputs.tool = 0, inputs.position = position;
  return inputs;
}

Model pressed_block(Integrator integrator, double radius,
                    network::Structure structure = network::Structure::mass_spring, double edge = 3e-3) {
  Model model = testing::make_skinned_block(5, 5, 4, structure, edge);
  model.tools = {testing::ball(radius)};
  model.solver.integrator = integrator, model.solver.substeps = integrator == Integrator::leapfrog ? 4 : 1;
  model.solver.tolerance = 1e-9, model.solver.velocity_floor = 1e-12;
  return model;
}

class SurfaceContact : public ::testing::TestWithParam<Integrator> {};

TEST_P(SurfaceContact, BeginsWhereTheSurfaceIsAtAnyPlace) {
  for (const double radius : {0.004, 0.01})
    for (const Vec3 place : {Vec3{0, 0, 0}, Vec3{0.006, 0, 0}, Vec3{0.006, 0.006, 0}, Vec3{0.0037, 0.0051, 0}}) {
      const Model model = pressed_block(GetParam(), radius);
      stepping::Stepper stepper(model);
      State state = rest_state(model);
      const auto force_at = [&](double height) {
        state = rest_state(model);
        return norm(stepper.step(state, at(place + Vec3{0, 0, kTop + radius + height})).tool_force);
      };
      EXPECT_EQ(force_at(1e-6), 0) << radius;
      EXPECT_GT(force_at(-1e-4), 0) << radius;
    }
}

TEST_P(SurfaceContact, GivesThePressesForceBackToTheHand) {
  const Model model = pressed_block(GetParam(), 0.01);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  stepping::StepReport report;
  Vec3 before, kicked;
  for (int i = 0; i < 20; ++i) {
    before = {};
    for (std::size_t n = 0; n < model.sphere_count(); ++n) before += model.mass[n] * state.velocity[n];
    report = stepper.step(state, at({0.002, 0.001, kTop + 0.01 - 1e-4 * i}));
    ASSERT_EQ(report.status, stepping::StepStatus::ok);
  }
  EXPECT_GT(report.tool_force.z, 0.01) << "tissue pushes the ball out";
  EXPECT_GT(report.contacts, 3);
  EXPECT_NEAR(report.depth, 19e-4, 6e-4);
}

TEST_P(SurfaceContact, DrawsTheSurfaceOnTheBall) {
  const double radius = 0.01;
  const Model model = pressed_block(GetParam(), radius);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i <= 60; ++i)
    ASSERT_EQ(stepper.step(state, at({0.002, 0.001, kTop + radius - 1e-4 * i})).status, stepping::StepStatus::ok);
  std::vector<Vec3> vertex;
  contact::DrawnSurfaces(model).place(0, model.surfaces[0], state, vertex);
  double deepest = 0;
  for (const Vec3& p : vertex) deepest = std::max(deepest, radius - norm(p - state.last_inputs.position));
  EXPECT_LT(deepest, 1e-4) << "no vertex is seen inside the ball";
  EXPECT_GT(deepest, -1e-3) << "but it is seen to touch";
}

/// Places of the drawn surface under a ball so far in [m], and where the lattice carries them.
struct Dent {
  Vec3 centre;
  std::vector<Vec3> carried, drawn;
};

Dent dent(Integrator integrator, double radius, double depth) {
  const Model model = pressed_block(integrator, radius);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (double way = 0; way <= depth; way += 1e-4)
    EXPECT_EQ(stepper.step(state, at({0.002, 0.001, kTop + radius - way})).status, stepping::StepStatus::ok);
  Dent dent{state.last_inputs.position, {}, {}};
  surface::deform_surface(model.surfaces[0], state.position, 0, dent.carried);
  contact::DrawnSurfaces(model).place(0, model.surfaces[0], state, dent.drawn);
  return dent;
}

TEST_P(SurfaceContact, DrawsAFunnelAroundABallThatIsInDeeperThanItsMiddle) {
  const double radius = 0.004;
  const Dent deep = dent(GetParam(), radius, 2.5 * radius);
  int in_shaft = 0, around = 0;
  for (std::size_t v = 0; v < deep.drawn.size(); ++v) {
    const Vec3 carried = deep.carried[v] - deep.centre, drawn = deep.drawn[v] - deep.centre;
    if (carried.z < -2 * radius) {
      EXPECT_EQ(deep.drawn[v], deep.carried[v]) << "the far side";
      continue;
    }
    const double from_axis = std::hypot(drawn.x, drawn.y);
    in_shaft += carried.z > 0 && std::hypot(carried.x, carried.y) < radius;
    around += carried.z > 0.1 * radius && from_axis > radius && from_axis < 1.5 * radius;
    if (from_axis < 1.5 * radius) {
      EXPECT_LT(drawn.z, std::max(0.0, from_axis - radius) + 0.05 * radius) << v;
    }
  }
  EXPECT_GT(in_shaft, 2) << "the lattice alone leaves tissue over the ball";
  EXPECT_GT(around, 2);
}

TEST_P(SurfaceContact, LeavesWhatIsBesideAShallowDentAsItIsCarried) {
  const double radius = 0.01;
  const Dent shallow = dent(GetParam(), radius, 0.2 * radius);
  int moved = 0;
  for (std::size_t v = 0; v < shallow.drawn.size(); ++v) {
    if (norm(shallow.carried[v] - shallow.centre) > radius) {
      EXPECT_EQ(shallow.drawn[v], shallow.carried[v]) << v;
    }
    moved += shallow.drawn[v] != shallow.carried[v];
  }
  EXPECT_GT(moved, 3);
}

TEST_P(SurfaceContact, OfASmallBallGoesDeeperThanTheLatticeFollows) {
  // A ball of a sixth of the spacing, eight of its radii deep... four: the force grows and never turns round.
  const double radius = 0.002;
  const Model model = pressed_block(GetParam(), radius);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double last = 0;
  for (int step = 1; step <= 8; ++step) {
    stepping::StepReport report;
    for (int i = 0; i < 40; ++i)
      report = stepper.step(state, at({0.003, 0.004, kTop + radius - 1e-3 * (step - 1 + (i + 1) / 40.0)}));
    for (int i = 0; i < 200; ++i) report = stepper.step(state, state.last_inputs);
    EXPECT_GT(report.tool_force.z, last) << step << " mm";
    last = report.tool_force.z;
  }
}

// A stepper remembers which triangles are near the ball. One that is new in each tick has to look for them.
TEST_P(SurfaceContact, IsTheSameWheneverItsTrianglesWereLookedFor) {
  for (const double radius : {0.002, 0.01}) {
    const Model model = pressed_block(GetParam(), radius);
    stepping::Stepper stepper(model);
    State state = rest_state(model), other = state;
    const auto step_both = [&](Vec3 position) {
      const double force = stepper.step(state, at(position)).tool_force.z;
      EXPECT_EQ(stepping::Stepper(model).step(other, at(position)).tool_force.z, force);
      EXPECT_EQ(state.position.x, other.position.x);
      EXPECT_EQ(state.position.z, other.position.z);
      EXPECT_EQ(state.touched, other.touched);
      return force;
    };
    // Pressed in, drawn along, fast and slowly, lifted off, and set down elsewhere at once.
    double most = 0;
    for (int i = 0; i <= 30; ++i) most = std::max(most, step_both({0, 0, kTop + radius - 1e-4 * i}));
    for (int i = 0; i <= 40; ++i) most = std::max(most, step_both({i < 20 ? 1e-3 * i : 0.02, 0, kTop + radius - 3e-3}));
    EXPECT_GT(most, 0);
    EXPECT_EQ(step_both({0, 0, kTop + 0.05}), 0);
    most = 0;
    for (int i = 0; i <= 20; ++i)
      most = std::max(most, step_both({-0.015, 0.01 - 1e-5 * i, kTop + radius - 1e-3 - 1e-4 * i}));
    EXPECT_GT(most, 0);
  }
}

// A scanner's mesh is many times finer than what spheres and ball resolve.
TEST_P(SurfaceContact, OfAFineMeshGivesTheForceOfAFineOneWithTheContactsOfACoarseOne) {
  struct Press {
    double force = 0;
    int contacts = 0;
  };
  const auto press = [&](double edge, Vec3 place) {
    const double radius = 0.01;
    const Model model = pressed_block(GetParam(), radius, network::Structure::mass_spring, edge);
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    stepping::StepReport report;
    for (int i = 0; i <= 40; ++i) report = stepper.step(state, at(place + Vec3{0, 0, kTop + radius - 1e-4 * i}));
    for (int i = 0; i < 200; ++i) report = stepper.step(state, state.last_inputs);
    return Press{report.tool_force.z, report.contacts};
  };
  for (const Vec3 place : {Vec3{0, 0, 0}, Vec3{0.0037, 0.0051, 0}}) {
    const Press coarse = press(1.6e-3, place), fine = press(0.4e-3, place);  // facets have a radius of 1.5 mm
    EXPECT_NEAR(fine.force / coarse.force, 1, 0.01);
    EXPECT_LT(fine.contacts, 1.5 * coarse.contacts);
  }
}

TEST_P(SurfaceContact, HoldsForTenSecondsWhatItGrips) {
  const Model model = pressed_block(GetParam(), 0.01);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i <= 40; ++i) (void)stepper.step(state, at({0, 0, kTop + 0.01 - 1e-4 * i}));
  for (int i = 0; i < 500; ++i) (void)stepper.step(state, state.last_inputs);
  for (int i = 1; i <= 20; ++i) (void)stepper.step(state, at({2e-5 * i, 0, kTop + 0.006}));
  double early = 0, late = 0;
  for (int i = 0; i < 3000; ++i) {
    const double force = stepper.step(state, state.last_inputs).tool_force.x;
    if (i == 1500) early = force;
    late = force;
  }
  EXPECT_LT(early, -0.005) << "the tissue pulls the ball back";
  EXPECT_NEAR(late / early, 1, 0.02) << "and does not let go";
}

// Where skin is folded, its lower side faces downwards. A ball that was pressed on it and is lifted off is behind that.
TEST_P(SurfaceContact, IsGoneOnceTheBallHasLeftAFold) {
  const double radius = 0.01;
  Model model = pressed_block(GetParam(), radius);
  const double edge = *std::max_element(model.rest_position.x.begin(), model.rest_position.x.end());
  State folded = rest_state(model);
  model.held_axes.assign(model.sphere_count(), 3);  // so that it stays folded, and gives way up and down
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.rest_position.x[i] > edge - 1e-6 && model.rest_position.z[i] > kTop - 1e-6)
      folded.position.add(i, {-0.022, 0, 0.006});
  const auto highest = [](const State& state) {
    return *std::max_element(state.position.z.begin(), state.position.z.end());
  };
  const double start = highest(folded) + radius, deepest = start - 0.008;
  int clear_of_it = 0;
  for (const double speed : {0.04, 0.4, 4.0})
    for (const double x : {0.0, 0.004, 0.008}) {
      stepping::Stepper stepper(model);
      State state = folded;
      int most = 0;
      for (int i = 0; i <= 100; ++i)
        most = std::max(most, stepper.step(state, at({x, 0.002, start + (deepest - start) * i / 100})).contacts);
      EXPECT_GT(most, 3) << x;
      for (double z = deepest; z < start + 0.06; z += speed * model.tick) {
        const stepping::StepReport report = stepper.step(state, at({x, 0.002, z}));
        if (z - radius < highest(state) + model.organs[0].spacing) continue;
        ++clear_of_it;
        ASSERT_EQ(report.contacts, 0) << "at x = " << x << ", " << speed << " m/s, " << z << " m high";
      }
    }
  EXPECT_GT(clear_of_it, 1000);
}

TEST_P(SurfaceContact, ReachesThroughNoThinFlapToItsFarSide) {
  constexpr double kRadius = 0.03, kThick = 0.012;  // [m]
  Model model = testing::make_skinned_block(6, 6, 2);
  model.tools = {testing::ball(kRadius)};
  model.solver.integrator = GetParam(), model.solver.substeps = GetParam() == Integrator::leapfrog ? 4 : 1;
  model.held_axes.assign(model.sphere_count(), 0);
  for (const double deep : {0.004, 0.016, 0.025}) {  // the last two are deeper than it is thick
    State state = rest_state(model);
    stepping::Stepper stepper(model);
    const stepping::StepReport report = stepper.step(state, at({0.001, 0.002, kThick + kRadius - deep}));
    EXPECT_GT(report.tool_force.z, 0) << deep;
    ASSERT_FALSE(state.touched.empty());
    for (const std::int32_t vertex : state.touched)
      EXPECT_NEAR(model.surfaces[0].vertex[std::size_t(vertex)].z, kThick, 1e-9) << deep;
  }
}

CTPM_UNDER_EACH_INTEGRATOR(SurfaceContact);

TEST(Foundation, IsAThreeParameterModel) {
  OrganRange organ;
  organ.instant_ratio = 2.5, organ.kelvin_time = 0.2;
  // At once K2, after long the static stiffness; between them the force follows exp(-t / tau), tau = c / (K1 + K2).
  const double k = 7, h = 1e-5, dent = 1e-3, tau = organ.kelvin_time / organ.instant_ratio;
  double kelvin = 0, time = 0;
  const contact::Foundation step(organ, k, h);
  EXPECT_NEAR(step.force(dent, 0), 2.5 * k * dent, 1e-3 * k * dent);
  while (time < 3 * tau) kelvin = step.kelvin_after(dent, kelvin), time += h;
  const double expected = k * dent * (1 + 1.5 * std::exp(-time / tau));
  EXPECT_NEAR(2.5 * k * (dent - kelvin), expected, 1e-3 * expected);
  OrganRange elastic;
  EXPECT_EQ(contact::Foundation(elastic, k, h).force(dent, 0), k * dent);
}

TEST(DentStiffness, IsHertzWhereTheLatticeIsCoarseAndVanishesWhereItIsFine) {
  // A ball of R 1 at d 1e-4 dents where it overlaps: force k pi R d^2 against 4/3 E' sqrt(R) d^1.5.
  const double modulus = 4e4, radius = 1, depth = 1e-4, a = std::sqrt(2 * radius * depth);
  const double k = contact::dent_stiffness(modulus, a, 1e3 * a);
  const double hertz = 4.0 / 3 * modulus / (1 - 1.0 / 16) * std::sqrt(radius) * std::pow(depth, 1.5);
  EXPECT_NEAR(k * std::numbers::pi * radius * depth * depth, hertz, 0.002 * hertz);
  EXPECT_GT(contact::dent_stiffness(modulus, a, 0.01 * a), 1000 * k);
}

}  // namespace
}  // namespace ctpm
