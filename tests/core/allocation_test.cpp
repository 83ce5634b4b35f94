// A tick must not allocate: allocation time is unbounded, and a haptic device does not wait.

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/model/fields.h"
#include "core/stepping/step.h"
#include "tests/core/counting_allocator.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

using testing::allocations, testing::live_bytes;

class EveryIntegrator : public ::testing::TestWithParam<Integrator> {};

TEST_P(EveryIntegrator, AllocatesNothingAfterTheFirstTick) {
  network::Material material = testing::liver_material();
  if (GetParam() == Integrator::leapfrog) material.viscosity = 5e3, material.stiffness_scale = 0.3;
  for (const int threads : {1, 2}) {
    Model model = testing::make_block_model(12, 12, 12, network::Structure::ctpm, material, 0.012, 10);
    model.tools = {testing::ball(0.02), testing::scalpel(0.1)};
    testing::use_integrator(model, GetParam());
    stepping::Stepper stepper(model, {threads, elements::best_instruction_set()});
    State state = rest_state(model);
    std::int32_t contacts = 0, severed = 0, inverted = 0;
    // The first tick with each tool may allocate.
    long before = 0;
    for (int tick = 0; tick < 24; ++tick) {
      Inputs inputs;
      inputs.tool = tick < 12 ? 0 : 1;
      // The ball jumps into the block, so that cells turn inside out.
      inputs.position = tick < 12 ? Vec3{0, 0, tick < 6 ? 0.156 - 0.0006 * tick : 0.12}
                                  : Vec3{0.0007, -0.1 + 0.01 * (tick - 12), 0.1};
      // For some ticks the block is inside out.
      if (tick == 6)
        for (double& z : state.position.z) z = -z;
      if (tick == 12) state = rest_state(model);
      if (tick == 1 || tick == 13) before = allocations;
      const stepping::StepReport report = stepper.step(state, inputs);
      if (tick != 0 && tick != 12) {
        ASSERT_EQ(allocations, before) << "tick " << tick << ", " << threads << " threads";
      }
      contacts += report.contacts, severed += report.severed, inverted += report.inverted;
    }
    EXPECT_GT(inverted, 0);
    EXPECT_GT(contacts, 0);
    EXPECT_GT(severed, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryIntegrator,
                         ::testing::Values(Integrator::leapfrog, Integrator::backward_euler, Integrator::sdirk2));

TEST_P(EveryIntegrator, AllocatesNothingWhereBodiesMeet) {
  network::Material material = testing::liver_material();
  if (GetParam() == Integrator::leapfrog) material.viscosity = 5e3, material.stiffness_scale = 0.3;
  Model model;
  for (const double height : {0.0, 0.0241}) {
    FilledOrgan organ = testing::make_block(4, 4, 3);
    for (Vec3& centre : organ.centre) centre.z += height;
    testing::add_faces(organ, 0.004);
    network::OrganSettings settings;
    settings.name = "block", settings.structure = network::Structure::mass_spring, settings.material = material;
    ASSERT_TRUE(bool(network::add_organ(model, organ, settings)));
    model.organs.back().meets_itself = true;
  }
  model.organs_meet = true, model.contact_friction = 0.3, model.gravity = {0, 0, -9.81};
  model.obstacles = {{"ground", ObstacleKind::plane, {0, 0, -1e-4}, {}, {}},
                     {"wall", ObstacleKind::box, {0.0479, 0, 0}, {}, {0.03, 0.1, 0.1}}};
  testing::use_integrator(model, GetParam());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  long before = 0;
  for (int tick = 0; tick < 60; ++tick) {
    if (tick == 1) before = allocations;
    ASSERT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
  }
  EXPECT_EQ(allocations, before);
  const auto points = std::int32_t(model.touchable_count());
  for (std::int32_t kind = 1; kind <= 3; ++kind)
    EXPECT_TRUE(std::any_of(state.touched.begin(), state.touched.end(), [&](std::int32_t point) {
      return point / points == kind;
    })) << kind;
}

TEST_P(EveryIntegrator, AllocatesNothingWithTwoHands) {
  network::Material material = testing::liver_material();
  if (GetParam() == Integrator::leapfrog) material.viscosity = 5e3, material.stiffness_scale = 0.05;
  Model model = testing::make_skinned_block(6, 6, 4, network::Structure::mass_spring, 0.003, material);
  model.tools = {testing::ball(0.01), testing::ball(0.01)}, model.hands = 2;
  testing::use_integrator(model, GetParam());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  long before = 0;
  std::int32_t contacts = 0;
  for (int tick = 0; tick < 60; ++tick) {
    if (tick == 1) before = allocations;
    Inputs inputs;
    inputs.tool = 0, inputs.position = {-0.006, 0, 0.046 - 5e-5 * tick};
    inputs.second.tool = 1, inputs.second.position = {0.006, 0, 0.046 - 5e-5 * tick};
    const stepping::StepReport report = stepper.step(state, inputs);
    ASSERT_EQ(report.status, stepping::StepStatus::ok);
    contacts += std::min(report.contacts, report.second.contacts);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(contacts, 0);
}

Model springs_only() {
  network::Material material = testing::liver_material();
  material.stiffness_scale = 0.29;
  Model model = testing::make_block_model(11, 11, 11, network::Structure::mass_spring, material);
  testing::use_integrator(model, Integrator::leapfrog);
  return model;
}

/// Memory of a Stepper of `model` after a tick [bytes].
long stepper_bytes(const Model& model) {
  State state = rest_state(model);
  const long before = live_bytes;
  stepping::Stepper stepper(model);
  EXPECT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
  return live_bytes - before;
}

TEST(SpringsOnly, ModelAndStateHaveNoArraysOfOtherFeatures) {
  const Model model = springs_only();
  const State state = rest_state(model);
  std::set<std::string> filled;
  const auto note = [&](std::string_view name, const auto& member) {
    if constexpr (requires { member.data(); })
      if (member.size() > 0) filled.emplace(name);
  };
  for_each_field(model, note), for_each_field(state, note);
  const std::set<std::string> expected{
      "rest_position.x", "rest_position.y", "rest_position.z", "mass",      "held_axes",  "contact_radius",
      "layer",           "cell.i",          "cell.j",          "cell.k",    "organs",     "axial.rest_length",
      "axial.a",         "axial.b",         "axial.law",       "axial.k",   "position.x", "position.y",
      "position.z",      "velocity.x",      "velocity.y",      "velocity.z"};
  EXPECT_EQ(filled, expected);
}

TEST(SpringsOnly, StepperHoldsPositionForceVelocityMassAndTheBatchesOfElements) {
  const Model model = springs_only();
  const long spheres = long(model.sphere_count()), elements = long(model.axial.size());
  const long bound = spheres * (10 * 8 + 1) + elements * 4, bytes = stepper_bytes(model), room = bound - bytes;
  EXPECT_GT(room, 0);

  // Each feature needs more memory than the bound leaves free, so the bound detects it.
  const auto taken_by = [&](auto&& feature) {
    Model other = springs_only();
    feature(other);
    return stepper_bytes(other) - bytes;
  };
  EXPECT_GT(taken_by([](Model& m) { m.tools = {testing::ball(0.01)}; }), room);
  EXPECT_GT(taken_by([](Model& m) { m.tools = {testing::scalpel(0.05)}; }), room);
  const auto dashpots = [](Model& m) {
    for (std::size_t e = 0; e < m.axial.size(); ++e) m.axial.c.push_back(1e-9 * double(e));
    m.axial.law.assign(m.axial.size(), AxialLaw::kelvin_unit);
  };
  EXPECT_GT(taken_by(dashpots), room);
  const auto constraints = [](Model& m) {
    m.constraints = testing::make_block_model(11, 11, 11).constraints;
    for (double& k : m.constraints.k) k *= 1e-3;
  };
  EXPECT_GT(taken_by(constraints), room);
  const auto cells = [](Model& m) {
    m.tissue_cells =
        testing::make_block_model(11, 11, 11, network::Structure::mass_spring, testing::liver_material(), 0.012, 10)
            .tissue_cells;
  };
  EXPECT_GT(taken_by(cells), room);
  const auto softening = [](Model& m) { m.has_softening = true, m.axial.third.assign(m.axial.size(), -1); };
  EXPECT_GT(taken_by(softening), room);
}

}  // namespace
}  // namespace ctpm
