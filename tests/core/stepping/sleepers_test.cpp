// Organs that stand still sleep: they cost nothing, wake as soon as something acts on them, and change what the others
// do by no more than the bound allows.

#include "core/stepping/sleepers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/elements/parts.h"
#include "core/stepping/step.h"
#include "core/surface/surface.h"
#include "tests/core/blade_blocks.h"
#include "tests/core/integrators.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kBound = 1e-5;  // [m/s]
constexpr int kSide = 4, kLayers = 4;
constexpr int kOfBlock = kSide * kSide * kLayers;
constexpr int kOfSecond = kSide * (kSide + 2) * kLayers, kOfBoth = kOfBlock + kOfSecond;  // unlike
constexpr double kSpacing = 0.012, kTop = 0.036, kApart = 0.1;                            // [m]
constexpr int kStill = 100;  // ticks of 1 ms before a part sleeps
enum : std::int32_t { kBall, kScalpel, kPin };

void add_block(Model& model, Vec3 by, bool is_held = true, int along_y = kSide, double edge = 0.006) {
  FilledOrgan organ = testing::make_block(kSide, along_y, kLayers);
  for (Vec3& centre : organ.centre) centre += by;
  testing::add_faces(organ, edge);
  network::OrganSettings settings;
  settings.name = "organ " + std::to_string(model.organs.size());
  settings.structure = network::Structure::ctpm, settings.tiling = network::Tiling::two_spheres;
  settings.material = testing::resisting(20, 500);
  settings.material.viscosity = 2e4, settings.material.stiffness_scale = 0.05;
  for (int i = 0; is_held && i < kSide * along_y; ++i) settings.anchored.push_back(i);
  ASSERT_TRUE(bool(network::add_organ(model, organ, settings)));
}

void finish(Model& model, Integrator integrator, double bound = kBound) {
  model.tools = {testing::ball(0.006), testing::scalpel(0.06),
                 Tool{"pin", ToolKind::pin, 0, 0, std::int32_t(model.sphere_count()) - 1}};
  testing::use_integrator(model, integrator);
  if (integrator == Integrator::leapfrog) model.solver.substeps = std::max(model.solver.substeps, 4);
  model.solver.tolerance = 1e-10, model.solver.velocity_floor = 1e-13, model.solver.max_iterations = 2000;
  model.solver.sleep_bound = bound;
}

/// Two blocks side by side that do not touch.
Model pair(Integrator integrator, double bound = kBound) {
  Model model;
  add_block(model, {}), add_block(model, {kApart, 0, 0}, true, kSide + 2);
  finish(model, integrator, bound);
  return model;
}

Inputs at(std::int32_t tool, Vec3 position) {
  Inputs inputs;
  inputs.tool = tool, inputs.position = position;
  return inputs;
}

/// A ball goes down at 20 mm/s on the first block's top, and rests 3 mm below.
Inputs press(std::int64_t tick, double x = 0.001) {
  return at(kBall, {x, 0.002, kTop + 0.0065 - 2e-5 * double(std::min<std::int64_t>(tick, 175))});
}

/// Places, velocities and internal variables of one of the two blocks.
std::vector<double> of_block(const Model& model, const State& state, std::size_t block) {
  std::vector<double> values;
  const auto first = std::size_t(model.organs[block].first);
  const auto end = first + std::size_t(model.organs[block].count);
  for (const Vec3Array* array : {&state.position, &state.velocity})
    for (std::size_t i = first; i < end; ++i)
      for (const double value : {(*array)[i].x, (*array)[i].y, (*array)[i].z}) values.push_back(value);
  for (std::size_t e = 0; e < model.axial.internal.size(); ++e)
    if (model.axial.internal[e] >= 0 && std::size_t(model.axial.a[e]) >= first && std::size_t(model.axial.a[e]) < end)
      values.push_back(state.kelvin_elongation[std::size_t(model.axial.internal[e])]);
  return values;
}

class Sleep : public ::testing::TestWithParam<Integrator> {};
class SleepInTouch : public Sleep {};

TEST_P(Sleep, LeavesOutAnOrganThatNothingTouches) {
  const Model model = pair(GetParam()), awake = pair(GetParam(), 0);
  stepping::Stepper stepper(model), all(awake);
  State state = rest_state(model), whole = rest_state(awake);
  double peak = 0, force_error = 0, place_error = 0;
  for (int tick = 0; tick < 3 * kStill; ++tick) {
    const stepping::StepReport report = stepper.step(state, press(tick)), full = all.step(whole, press(tick));
    ASSERT_EQ(report.status, stepping::StepStatus::ok) << tick;
    EXPECT_EQ(full.asleep, 0);
    // Both blocks are at rest at first; the ball reaches the first one well before it would sleep.
    EXPECT_EQ(report.asleep, tick < kStill ? 0 : kOfSecond) << tick;
    peak = std::max(peak, norm(full.tool_force));
    force_error = std::max(force_error, norm(report.tool_force - full.tool_force));
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      place_error = std::max(place_error, norm(state.position[i] - whole.position[i]));
  }
  EXPECT_GT(peak, 0.01);
  EXPECT_LT(force_error, 1e-6 * peak);
  EXPECT_LT(place_error, 1e-9);
  EXPECT_EQ(state.still_ticks[1], kStill);
}

TEST_P(Sleep, WakesAnOrganInTheTickInWhichTheBallTouchesIt) {
  const Model model = pair(GetParam());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int tick = 0; tick <= kStill; ++tick) (void)stepper.step(state, {});
  ASSERT_EQ(stepper.step(state, {}).asleep, kOfBoth);
  Model other = pair(GetParam(), 0);
  stepping::Stepper all(other);
  State whole = state;
  bool has_touched = false;
  for (int tick = 0; tick < 60; ++tick) {
    const Inputs inputs = press(tick, kApart + 0.001);
    const stepping::StepReport report = stepper.step(state, inputs), full = all.step(whole, inputs);
    has_touched = has_touched || full.contacts > 0;
    EXPECT_EQ(report.contacts, full.contacts) << tick;
    EXPECT_EQ(report.asleep, has_touched ? kOfBlock : kOfBoth) << tick;
    EXPECT_NEAR(norm(report.tool_force - full.tool_force), 0, 1e-6) << tick;
  }
  EXPECT_TRUE(has_touched);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    ASSERT_NEAR(norm(state.position[i] - whole.position[i]), 0, 1e-10) << i;
  for (std::size_t i = 0; i < state.kelvin_elongation.size(); ++i)
    ASSERT_NEAR(state.kelvin_elongation[i], whole.kelvin_elongation[i], 1e-10) << i;
}

TEST_P(Sleep, KeepsWhatSleepsToTheBit) {
  const Model model = pair(GetParam(), 5e-4);  // what a press leaves swinging takes seconds to get slower
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  // The second block is pressed, let go, and sleeps where it came to rest.
  for (int tick = 0; tick < 100; ++tick) (void)stepper.step(state, press(tick, kApart + 0.001));
  int ticks = 0;
  while (stepper.step(state, {}).asleep < kOfBoth && ticks < 20000) ++ticks;
  EXPECT_GT(ticks, kStill - 2);
  ASSERT_LT(ticks, 20000);
  const std::vector<double> before = of_block(model, state, 1);
  for (int tick = 0; tick < 150; ++tick) (void)stepper.step(state, press(tick));
  EXPECT_EQ(of_block(model, state, 1), before);
  for (std::size_t i = kOfBlock; i < kOfBoth; ++i) EXPECT_EQ(state.velocity[i], Vec3{});
  EXPECT_GT(norm(state.position[kOfBlock - 3] - Vec3(model.rest_position[kOfBlock - 3])), 0.0);
}

TEST_P(Sleep, IsInTheStateAlone) {
  const Model model = pair(GetParam());
  State state = rest_state(model);
  stepping::Stepper stepper(model, {.threads = 2});
  const auto inputs = [](int tick) { return tick < 240 ? press(tick) : press(tick - 240, kApart + 0.001); };
  for (int tick = 0; tick < 420; ++tick) {
    // Another Stepper, with other threads and kernels, that has seen other ticks, goes on in the same way.
    if (tick == 150 || tick == 240) {
      State copy = state;
      stepping::Stepper other(model, {.threads = 1, .instruction_set = elements::InstructionSet::baseline});
      State elsewhere = rest_state(model);
      for (int i = 0; i < 120; ++i) (void)other.step(elsewhere, press(i, kApart));
      for (int i = tick; i < tick + 60; ++i) (void)other.step(copy, inputs(i)), (void)stepper.step(state, inputs(i));
      EXPECT_EQ(state.position, copy.position);
      EXPECT_EQ(state.velocity, copy.velocity);
      EXPECT_EQ(state.acceleration, copy.acceleration);
      EXPECT_EQ(state.kelvin_elongation, copy.kelvin_elongation);
      EXPECT_EQ(state.touched, copy.touched);
      EXPECT_EQ(state.grip, copy.grip);
      EXPECT_EQ(state.kelvin_dent, copy.kelvin_dent);
      EXPECT_EQ(state.still_ticks, copy.still_ticks);
      tick += 60;
    }
    (void)stepper.step(state, inputs(tick));
  }
}

TEST_P(Sleep, IsNotForAFallingOrganUntilItLies) {
  Model model;
  add_block(model, {0, 0, 0.0005}, false);
  model.obstacles.push_back({"ground", ObstacleKind::plane, {0, 0, -0.006}, {}, {}});
  model.gravity = {0, 0, -9.81}, model.contact_friction = 0.3;
  finish(model, GetParam(), 1e-4);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  int lies_at = -1;
  for (int tick = 0; tick < 6000 && lies_at < 0; ++tick)
    if (stepper.step(state, {}).asleep > 0) lies_at = tick;
  ASSERT_GT(lies_at, kStill);
  // What it stands on still holds it when it wakes: it does not jump.
  const State before = state;
  for (int tick = 0; tick < 50; ++tick) (void)stepper.step(state, {});
  EXPECT_EQ(of_block(model, state, 0), of_block(model, before, 0));
  EXPECT_EQ(state.touched, before.touched);
  EXPECT_EQ(state.grip, before.grip);
  EXPECT_EQ(state.kelvin_dent, before.kelvin_dent);
  state.still_ticks.assign(1, 0);
  double moved = 0;
  for (int tick = 0; tick < 50; ++tick) {
    (void)stepper.step(state, {});
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      moved = std::max(moved, norm(state.position[i] - before.position[i]));
  }
  EXPECT_LT(moved, 50e-6);
}

/// A block on another one, both at rest.
Model stack(Integrator integrator, double bound) {
  Model model;
  add_block(model, {}, true, kSide, 0.003), add_block(model, {0, 0, kLayers * kSpacing - 0.0058}, false, kSide, 0.003);
  model.organs_meet = true, model.contact_friction = 0.3, model.gravity = {0, 0, -1};
  finish(model, integrator, bound);
  return model;
}

TEST_P(SleepInTouch, EndsForAllThatTouchesWhatIsPressed) {
  const Model model = stack(GetParam(), 5e-3);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  int ticks = 0;
  std::int32_t asleep = 0;
  while ((asleep = stepper.step(state, {}).asleep) < 2 * kOfBlock && ticks < 12000) {
    EXPECT_EQ(asleep, 0) << "one sleeps while the other, which it touches, moves";
    ++ticks;
  }
  ASSERT_LT(ticks, 12000);
  std::vector<Vec3> drawn;
  surface::deform_surface(model.surfaces[1], state.position, model.organs[1].first, drawn);
  const Vec3 top = *std::max_element(drawn.begin(), drawn.end(), [](Vec3 a, Vec3 b) { return a.z < b.z; });
  bool has_touched = false;
  for (int tick = 0; tick < 80; ++tick) {
    const stepping::StepReport report = stepper.step(state, at(kBall, top + Vec3{0, 0, 0.0068 - 2e-5 * tick}));
    has_touched = has_touched || report.contacts > 0;
    EXPECT_EQ(report.asleep, has_touched ? 0 : 2 * kOfBlock) << tick;
  }
  EXPECT_TRUE(has_touched);
}

TEST_P(Sleep, EndsForPinsBladesAndLoads) {
  Model model = pair(GetParam());
  model.loads.sphere = {kOfBlock - 1}, model.loads.force = Vec3Array(1), model.loads.start = {0.3},
  model.loads.ramp = {0.01};
  model.loads.force.set(0, {0, 0, 0.05});
  stepping::Stepper stepper(model);
  State start = rest_state(model);
  for (int tick = 0; tick <= kStill; ++tick) (void)stepper.step(start, {});
  // A pin holds the last sphere of the second block. It could draw spheres away from what they hold, so all are awake.
  State state = start;
  const Vec3 place = state.position[kOfBoth - 1];
  EXPECT_EQ(stepper.step(state, at(kPin, place)).asleep, 0);
  EXPECT_EQ(stepper.step(state, at(kPin, place + Vec3{0, 0, 1e-4})).asleep, 0);
  EXPECT_NEAR(state.velocity[kOfBoth - 1].z, 0.1, 1e-12);
  // A blade cuts the second block, and its faces part.
  state = start;
  std::int32_t severed = 0;
  for (int tick = 0; tick < 150; ++tick) {
    const stepping::StepReport report =
        stepper.step(state, at(kScalpel, {kApart + 0.0007, -0.034 + 0.0004 * tick, 0.02}));
    severed += report.severed;
    if (severed > 0) {
      EXPECT_EQ(report.asleep, kOfBlock) << tick;
    }
  }
  EXPECT_GT(severed, 0);
  // The load begins to pull at a sphere of the first block 0.3 s from the start.
  state = start;
  while (state.tick < 298) ASSERT_EQ(stepper.step(state, {}).asleep, kOfBoth);
  while (state.tick < 330) (void)stepper.step(state, {});
  EXPECT_EQ(stepper.step(state, {}).asleep, kOfSecond);
  EXPECT_GT(norm(state.position[kOfBlock - 1] - start.position[kOfBlock - 1]), 1e-6);
}

TEST_P(Sleep, DoesNotChangeInARefusedTick) {
  const Model model = pair(GetParam());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int tick = 0; tick < kStill + 5; ++tick) (void)stepper.step(state, {});
  const State before = state;
  const stepping::StepReport report = stepper.step(state, at(kPin, {0, 0, 1e4}));
  ASSERT_EQ(report.status, stepping::StepStatus::diverged);
  EXPECT_EQ(report.asleep, 0);
  EXPECT_EQ(state.still_ticks, before.still_ticks);
  EXPECT_EQ(state.position, before.position);
  EXPECT_EQ(stepper.step(state, {}).asleep, kOfBoth);
}

TEST_P(Sleep, HoldsForAnyState) {
  const Model model = pair(GetParam());
  stepping::Stepper stepper(model);
  for (const std::vector<std::int32_t>& still : {std::vector<std::int32_t>{}, {100}, {100, 100, 100}}) {
    State state = rest_state(model);
    state.still_ticks = still;  // not one for each part: none was still
    EXPECT_EQ(stepper.step(state, {}).asleep, 0);
    EXPECT_EQ(state.still_ticks, (std::vector<std::int32_t>{1, 1}));
  }
  State state = rest_state(model);
  state.still_ticks = {1000000000, 3};
  state.velocity.set(0, {0, 0, 1}), state.velocity.set(kOfBlock - 1, {0, 0, 1});
  EXPECT_EQ(stepper.step(state, {}).asleep, kOfBlock);
  EXPECT_EQ(state.still_ticks, (std::vector<std::int32_t>{kStill, 4}));
  EXPECT_EQ(state.velocity[kOfBlock - 1], Vec3{}) << "time stands still in what sleeps";
  // A Model in which nothing sleeps forgets what a State says, and gives the next State nothing of it.
  const Model awake = pair(GetParam(), 0);
  stepping::Stepper all(awake);
  State other = rest_state(awake);
  (void)all.step(state, {}), (void)all.step(other, {});
  EXPECT_TRUE(state.still_ticks.empty());
  EXPECT_TRUE(other.still_ticks.empty());
}

TEST_P(SleepInTouch, EndsForWhatItsSupportNoLongerHolds) {
  Model model = stack(GetParam(), 5e-3);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  int ticks = 0;
  while (stepper.step(state, {}).asleep < 2 * kOfBlock && ticks < 12000) ++ticks;
  ASSERT_LT(ticks, 12000);
  // What lies under the upper block is moved away from it in one go: it falls.
  const double before = state.position[2 * kOfBlock - 1].z;
  Inputs pin = at(kPin, state.position[kOfBlock / 2]);
  for (int tick = 0; tick < 60; ++tick) pin.position.z -= 2e-4, (void)stepper.step(state, pin);
  for (int tick = 0; tick < 200; ++tick) (void)stepper.step(state, {});
  EXPECT_NE(state.position[2 * kOfBlock - 1].z, before);
  EXPECT_LT(state.still_ticks[1], kStill);
}

TEST(SleepInSlabs, GivesTheSameBitsWithAnyThreadsAndInstructionSet) {
  const auto make = [] {
    Model model;
    for (const double x : {0.0, 0.3}) {
      FilledOrgan organ = testing::make_block(12, 12, 11);
      for (Vec3& centre : organ.centre) centre.x += x;
      network::OrganSettings settings;
      settings.name = std::to_string(x), settings.material = testing::liver_material();
      for (int i = 0; i < 144; ++i) settings.anchored.push_back(i);
      CTPM_CHECK(bool(network::add_organ(model, organ, settings)), "a test's own organ is valid");
    }
    model.contact_k = 1000;
    finish(model, Integrator::backward_euler);
    return model;
  };
  const Model model = make();
  const auto run = [&](const stepping::StepperOptions& options) {
    stepping::Stepper stepper(model, options);
    State state = rest_state(model);
    for (int tick = 0; tick < kStill + 30; ++tick) {
      const stepping::StepReport report = stepper.step(state, at(kBall, {0.001, 0.002, 0.131 - 2e-5 * tick}));
      EXPECT_EQ(report.asleep, tick < kStill ? 0 : 12 * 12 * 11) << tick;
    }
    return state;
  };
  const State plain = run({1, elements::InstructionSet::baseline}), other = run({3, elements::InstructionSet::avx2});
  EXPECT_EQ(plain.position, other.position);
  EXPECT_EQ(plain.velocity, other.velocity);
  EXPECT_NE(plain.position, model.rest_position);
}

std::string name_of_case(const ::testing::TestParamInfo<Integrator>& of) {
  std::string name = stepping::name_of(of.param);
  std::erase(name, '-');
  return name;
}

const auto kImplicit = ::testing::Values(Integrator::backward_euler, Integrator::sdirk2);
const auto kExplicit = ::testing::Values(Integrator::leapfrog);
INSTANTIATE_TEST_SUITE_P(Implicit, Sleep, kImplicit, name_of_case);
INSTANTIATE_TEST_SUITE_P(Explicit, Sleep, kExplicit, name_of_case);
INSTANTIATE_TEST_SUITE_P(Implicit, SleepInTouch, kImplicit, name_of_case);
INSTANTIATE_TEST_SUITE_P(SlowExplicit, SleepInTouch, kExplicit, name_of_case);

TEST(Parts, AreOrgansThatNoElementJoins) {
  Model model = pair(Integrator::backward_euler);
  using Ranges = std::vector<parallel::SphereRange>;
  EXPECT_EQ(elements::parts_of(model), (Ranges{{0, kOfBlock}, {kOfBlock, kOfBoth}}));
  const parallel::Slabs slabs(elements::parts_of(model));
  EXPECT_EQ(slabs.count(), 2);
  EXPECT_EQ(slabs.of(kOfBlock - 1), 0);
  EXPECT_EQ(slabs.of(kOfBlock), 1);
  model.axial.b.front() = kOfBoth - 1;
  EXPECT_EQ(elements::parts_of(model), (Ranges{{0, kOfBoth}}));
  model.organs.clear();
  EXPECT_EQ(elements::parts_of(model), (Ranges{{0, kOfBoth}}));
}

TEST(Parts, OfWhichSomeSleepLeaveTheirSlabsOut) {
  parallel::Slabs slabs(std::vector<parallel::SphereRange>{{0, 10000}, {10000, 12000}});
  ASSERT_EQ(slabs.count(), 4);
  EXPECT_EQ(slabs.awake(), (std::vector<int>{0, 1, 2, 3}));
  slabs.set_asleep({1, 1, 0, 1});
  EXPECT_EQ(slabs.awake(), (std::vector<int>{2}));
  EXPECT_EQ(slabs.asleep(), (std::vector<int>{0, 1, 3}));
}

}  // namespace
}  // namespace ctpm
