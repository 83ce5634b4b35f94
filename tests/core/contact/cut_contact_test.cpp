// What a cut opens is touched: walls by a ball, and what came loose by a ball and by what it falls on.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/cutbody/cut_points.h"
#include "core/cutting/blade_geometry.h"
#include "core/stepping/step.h"
#include "tests/core/cut_blocks.h"
#include "tests/core/integrators.h"

namespace ctpm {
namespace {

using testing::cut_along, testing::DrawnCut, testing::open_soon, testing::straight_front;

constexpr double kTop = 0.036;  // of the block [m]

Inputs at(Vec3 position) {
  Inputs inputs;
  inputs.tool = 0, inputs.position = position;
  return inputs;
}

cutting::Front upright(double t, double x, double bottom) {
  const double y = -0.06 + 0.12 * t;
  return straight_front({x, y, bottom}, {x, y, 0.06});
}

/// A cut along y, down to `bottom`, that gapes by `angle` to each side.
State open_wound(const Model& model, double x, double bottom, double angle) {
  State state = rest_state(model);
  cut_along(
      model, [&](double t) { return upright(t, x, bottom); }, state);
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 p = model.rest_position[i];
    if (p.z <= bottom) continue;
    const double side = p.x < x ? -1 : 1;
    state.position.add(i, {side * angle * (p.z - bottom), 0, 0});
  }
  return state;
}

double distance_to(const DrawnCut& drawn, Vec3 point) {
  double least = INFINITY;
  for (const auto& t : drawn.surface.triangle) {
    const Vec3 a = drawn.vertex[std::size_t(t[0])], b = drawn.vertex[std::size_t(t[1])],
               c = drawn.vertex[std::size_t(t[2])];
    least = std::min(least, norm(cutting::nearest_in_triangle(point, a, b, c) - point));
  }
  return least;
}

/// How far a ball goes from `from` towards `way` until `touches(place)` [m].
template <class Touches>
double first_contact(Vec3 from, Vec3 way, const Touches& touches) {
  double free = 0, touched = 1;
  EXPECT_FALSE(touches(from)) << "it begins in the open";
  for (double t = 0; t <= 1; t += 0.02)
    if (touches(from + t * way)) {
      touched = t;
      break;
    } else {
      free = t;
    }
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (free + touched);
    (touches(from + middle * way) ? touched : free) = middle;
  }
  return touched * norm(way);
}

TEST(CutContact, ABallInAWoundTouchesTheWallsWhereTheyAreDrawn) {
  double worst = 0;
  for (const double radius : {0.002, 0.004}) {
    Model model = testing::block_to_cut(8, 8, 4, radius);
    // One substep a tick: in more of them the wound closes by some 0.4 mm before the ball is felt.
    testing::use_integrator(model, Integrator::backward_euler);
    const State wound = open_wound(model, 0.0013, 0.006, 0.3);
    const DrawnCut drawn(model, wound);
    stepping::Stepper stepper(model);
    const auto touches = [&](Vec3 place) {
      State state = wound;
      return stepper.step(state, at(place)).contacts > 0;
    };
    const auto is_near = [&](Vec3 place) { return distance_to(drawn, place) < radius; };
    // Down into the wound, and sideways against both walls.
    const Vec3 mouth{0.0013, 0, 0.05}, inside{0.0013, 0.003, 0.0291};
    for (const auto& [from, way] : {std::pair{mouth, Vec3{0, 0, -0.04}},
                                    {mouth + Vec3{0.001, 0.0052, 0}, {0, 0, -0.04}},
                                    {inside, {0.02, 0, 0}},
                                    {inside, {-0.02, 0.002, -0.001}}}) {
      const double touched = first_contact(from, way, touches), seen = first_contact(from, way, is_near);
      EXPECT_NEAR(touched, seen, 5e-5) << radius << " from " << from.x << ' ' << from.y << ' ' << from.z;
      worst = std::max(worst, std::abs(touched - seen));
    }
  }
  RecordProperty("worst_mm", std::to_string(1e3 * worst));
  std::printf("first contact off the drawn wall by at most %.4f mm\n", 1e3 * worst);
}

TEST(CutContact, AWallCarriesABallAsSkinDoes) {
  const double radius = 0.008;
  Model model = testing::block_to_cut(8, 8, 4, radius);
  // Only the half that is pressed moves.
  State halves = rest_state(model);
  cut_along(
      model, [&](double t) { return upright(t, 0.0, -0.01); }, halves);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.rest_position.x[i] < 0) halves.position.add(i, {-0.1, 0, 0});
  const auto press = [&](State state, Vec3 from, Vec3 way) {
    stepping::Stepper stepper(model);
    stepping::StepReport report;
    for (int i = 0; i <= 300; ++i) report = stepper.step(state, at(from + std::min(1.0, i / 100.0) * way));
    return norm(report.tool_force);
  };
  double least = INFINITY, most = 0;
  for (const double y : {0.0, 0.003, 0.006, 0.009}) {
    const double force = press(halves, {-radius, y, 0.018}, {0.003, 0, 0});
    least = std::min(least, force), most = std::max(most, force);
  }
  const double skin = press(rest_state(model), {-0.042 - radius, 0, 0.018}, {0.003, 0, 0});
  std::printf("wall %.4f to %.4f N, skin %.4f N\n", least, most, skin);
  EXPECT_LT(most / least, 1.25) << "neither triangles nor spheres are felt";
  EXPECT_NEAR(0.5 * (least + most) / skin, 1, 0.3);
}

TEST(CutContact, ABallPushesALoosePieceByItsCutFace) {
  const double radius = 0.006;
  Model model = testing::block_to_cut(6, 6, 4, radius);
  model.held_axes.assign(model.sphere_count(), 0);
  testing::use_integrator(model, Integrator::backward_euler);  // one substep: the report's force is that of the tick
  model.solver.tolerance = 1e-10, model.solver.velocity_floor = 1e-13, model.solver.max_iterations = 2000;
  State state = rest_state(model);
  cut_along(
      model, [&](double t) { return upright(t, 0.0013, -0.01); }, state);
  const auto is_right = [&](std::size_t i) { return model.rest_position.x[i] > 0.0013; };
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (!is_right(i)) state.position.add(i, {-0.1, 0, 0});
  stepping::Stepper stepper(model);
  Vec3 impulse;
  double work = 0, deepest = 0;
  for (int i = 0; i < 400; ++i) {
    const stepping::StepReport report = stepper.step(state, at({-0.012 + 1e-4 * i, 0.001, 0.017}));
    ASSERT_EQ(report.status, stepping::StepStatus::ok);
    impulse -= model.tick * report.tool_force;
    work += norm(report.tool_force), deepest = std::max(deepest, report.depth);
  }
  Vec3 right, left;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    (is_right(i) ? right : left) += model.mass[i] * state.velocity[i];
  double mass = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (is_right(i)) mass += model.mass[i];
  std::printf("momentum %.3e kg m/s, off by %.1e of it; %.1f mm/s\n", norm(right), norm(right - impulse) / norm(right),
              1e3 * right.x / mass);
  EXPECT_GT(work, 0);
  EXPECT_LT(deepest, 0.002) << "how far it was pushed is not how deep it was pressed";
  EXPECT_GT(right.x / mass, 0.05) << "the ball's 100 mm/s, nearly";
  EXPECT_LT(norm(right - impulse), 1e-8 * norm(right));
  EXPECT_LT(norm(left), 1e-12 * norm(right)) << "what it does not touch stays";
}

/// Drops what was cut on the ground for some seconds.
struct Dropped {
  State state;
  double fastest = 0, inside = 0, lowest = 0;  ///< [m/s], [m], [m]
};

Dropped drop(const Model& model, State state, double ground, int ticks) {
  stepping::Stepper stepper(model);
  Dropped dropped;
  for (int i = 0; i < ticks; ++i) EXPECT_EQ(stepper.step(state, Inputs{}).status, stepping::StepStatus::ok);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    dropped.fastest = std::max(dropped.fastest, norm(state.velocity[i]));
  const DrawnCut drawn(model, state);
  dropped.lowest = INFINITY;
  for (const Vec3& v : drawn.vertex)
    dropped.inside = std::max(dropped.inside, ground - v.z), dropped.lowest = std::min(dropped.lowest, v.z - ground);
  dropped.state = std::move(state);
  return dropped;
}

TEST(CutContact, SlowACapRestsOnTheGroundWithItsCutFace) {
  Model model = testing::block_to_cut(6, 6, 4, 0.01);
  const double ground = -0.02;
  model.gravity = {0, 0, -9.81};
  model.obstacles = {{"ground", ObstacleKind::plane, {0, 0, ground}, {}, {}}};
  State state = rest_state(model);
  const auto flat = [](double t) {
    const double y = -0.06 + 0.12 * t;
    return straight_front({-0.06, y, 0.016}, {0.06, y, 0.02});
  };
  cut_along(model, flat, state);
  ASSERT_EQ(DrawnCut(model, state).pieces, 2);
  const Dropped dropped = drop(model, state, ground, 2500);
  std::printf("fastest %.3f mm/s, drawn %.3f mm inside the ground\n", 1e3 * dropped.fastest, 1e3 * dropped.inside);
  EXPECT_LT(dropped.fastest, 2e-3);
  EXPECT_LT(dropped.inside, 0.5e-3);
  EXPECT_GT(dropped.inside, 0);
}

TEST(CutContact, ACapRestsOnTheBedThatItWasCutFromWhereTheOrganMeetsItself) {
  Model model = testing::block_to_cut(5, 5, 4, 0.01);
  model.gravity = {0, 0, -9.81};
  model.organs[0].meets_itself = true;
  State state = rest_state(model);
  const auto flat = [](double t) {
    const double y = -0.06 + 0.12 * t;
    return straight_front({-0.06, y, 0.018}, {0.06, y, 0.018});
  };
  cut_along(model, flat, state);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.rest_position.z[i] > 0.018) state.position.add(i, {0.002, 0.001, 0.005});
  stepping::Stepper stepper(model);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(stepper.step(state, Inputs{}).status, stepping::StepStatus::ok);
  double fastest = 0, sunk = 0, aside = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    fastest = std::max(fastest, norm(state.velocity[i]));
    const Vec3 by = state.position[i] - model.rest_position[i];
    if (model.rest_position.z[i] > 0.018) sunk = std::max(sunk, -by.z), aside = std::max(aside, std::hypot(by.x, by.y));
  }
  std::printf("fastest %.3f mm/s, %.2f mm down, %.2f mm aside\n", 1e3 * fastest, 1e3 * sunk, 1e3 * aside);
  EXPECT_LT(fastest, 0.1e-3) << "it lies after a second, and stays";
  EXPECT_LT(sunk, 2e-3);
  EXPECT_LT(aside, 4e-3);
  model.organs[0].meets_itself = false;
  stepping::Stepper passes(model);
  for (int i = 0; i < 300; ++i) (void)passes.step(state, Inputs{});
  EXPECT_LT(state.position.z.back(), 0.0) << "without it, pieces pass through each other";
}

/// A blade cuts a cap off, which falls on the ground, and a ball comes down on its cut face.
Inputs cut_and_press(int tick) {
  Inputs inputs;
  if (tick < 150) {
    // The edge lies across the block.
    inputs.tool = 1, inputs.position = {-0.05, -0.06 + 8e-4 * tick, 0.019};
    inputs.world_from_tool = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};
  } else {
    inputs.tool = 0, inputs.position = {0.003, 0.002, 0.05 - 2e-4 * (tick - 150)};
  }
  return inputs;
}

Model block_on_ground(Integrator integrator) {
  Model model = testing::block_to_cut(5, 5, 4, 0.008);
  model.solver.integrator = integrator, model.solver.substeps = integrator == Integrator::leapfrog ? 8 : 1;
  model.gravity = {0, 0, -9.81};
  model.obstacles = {{"ground", ObstacleKind::plane, {0, 0, -0.006}, {}, {}}};
  return model;
}

class CutContactUnder : public ::testing::TestWithParam<Integrator> {};

/// The end of cut_and_press(); `before(tick, stepper)` is called at the start of each tick.
template <class Before>
State run_cut_and_press(const Model& model, int threads, bool& ball_touches, bool& ground_touches,
                        const Before& before) {
  const cutbody::CutPoints points(model);
  State state = rest_state(model);
  std::optional<stepping::Stepper> stepper;
  stepper.emplace(model, stepping::StepperOptions{threads});
  for (int tick = 0; tick < 420; ++tick) {
    before(tick, stepper);
    EXPECT_FALSE(stepping::is_refused(stepper->step(state, cut_and_press(tick)).status)) << tick;
    if (tick < 150) open_soon(state);
    for (const std::int32_t point : state.touched)
      if (points.contains(point)) (points.is_of_ball(point, 0) ? ball_touches : ground_touches) = true;
  }
  return state;
}

void expect_same(const State& one, const State& other) {
  EXPECT_EQ(one.position, other.position);
  EXPECT_EQ(one.velocity, other.velocity);
  EXPECT_EQ(one.touched, other.touched);
  EXPECT_EQ(one.grip, other.grip);
  EXPECT_EQ(one.kelvin_dent, other.kelvin_dent);
}

TEST_P(CutContactUnder, NeitherThreadsNorAFreshStartChangeABit) {
  const Model model = block_on_ground(GetParam());
  bool ball_touches = false, ground_touches = false;
  std::vector<State> runs;
  for (const auto& [threads, from_keyframes] : {std::pair{1, false}, {3, false}, {1, true}})
    runs.push_back(run_cut_and_press(model, threads, ball_touches, ground_touches,
                                     [&, fresh = from_keyframes](int tick, std::optional<stepping::Stepper>& stepper) {
                                       if (fresh && tick % 70 == 69) stepper.emplace(model);
                                     }));
  EXPECT_TRUE(ball_touches && ground_touches);
  expect_same(runs[0], runs[1]), expect_same(runs[0], runs[2]);
}

TEST_P(CutContactUnder, HowFastACutIsFollowedChangesNoBit) {
  Model model = block_on_ground(GetParam());
  model.obstacles.clear(), model.gravity = {};
  bool ball_touches = false, ground_touches = false;
  // The cut opens before tick 150, and is touched some 100 ticks later.
  const State at_once =
      run_cut_and_press(model, 1, ball_touches, ground_touches, [](int, std::optional<stepping::Stepper>&) {});
  EXPECT_TRUE(ball_touches);
  const State with_time =
      run_cut_and_press(model, 1, ball_touches, ground_touches, [](int tick, std::optional<stepping::Stepper>&) {
        if (tick == 151) std::this_thread::sleep_for(std::chrono::milliseconds(500));
      });
  expect_same(at_once, with_time);
  const State late =
      run_cut_and_press(model, 1, ball_touches, ground_touches, [&](int tick, std::optional<stepping::Stepper>& fresh) {
        if (tick >= 150 && tick % 15 == 0) fresh.emplace(model);
      });
  expect_same(at_once, late);
}

/// Notes the stages of a tick.
class Stages : public StageWatch {
 public:
  Stage enter(Stage stage) override {
    seen.push_back(stage);
    return std::exchange(now, stage);
  }
  bool take(Stage stage) const { return std::find(seen.begin(), seen.end(), stage) != seen.end(); }

  Stage now = Stage::solve;
  std::vector<Stage> seen;
};

TEST_P(CutContactUnder, ATickTellsWhenItCutsAndWhenItWaitsForACut) {
  Model model = block_on_ground(GetParam());
  model.obstacles.clear(), model.gravity = {};
  Stages stages;
  stepping::Stepper watched(model, {.watch = &stages}), alone(model);
  State state = rest_state(model), other = state;
  bool cuts = false, waits = false;
  for (int tick = 0; tick < 420; ++tick) {
    stages.seen.clear();
    const stepping::StepReport report = watched.step(state, cut_and_press(tick));
    EXPECT_EQ(stages.now, Stage::solve) << tick;
    EXPECT_TRUE(report.severed == 0 || stages.take(Stage::cut)) << tick;
    cuts = cuts || report.severed > 0;
    EXPECT_TRUE(tick >= 150 || !stages.take(Stage::cut_surface)) << "no ball is there yet, in tick " << tick;
    waits = waits || stages.take(Stage::cut_surface);
    (void)alone.step(other, cut_and_press(tick));
    if (tick < 150) open_soon(state), open_soon(other);
  }
  EXPECT_TRUE(cuts && waits);
  expect_same(state, other);
}

CTPM_UNDER_EACH_INTEGRATOR(CutContactUnder);

TEST(CutContact, ABallOnAClosedCutDoesNotWedgeItOpen) {
  const Model model = testing::block_to_cut(8, 8, 4, 0.01);
  const auto press = [&](const State& from) {
    stepping::Stepper stepper(model);
    State state = from;
    stepping::StepReport report;
    for (int i = 0; i <= 200; ++i)
      report = stepper.step(state, at({0.0013, 0.002, kTop + 0.01 - 2e-3 * std::min(1.0, i / 100.0)}));
    return report.tool_force.z;
  };
  State cut = rest_state(model);
  cut_along(
      model, [&](double t) { return upright(t, 0.0013, 0.012); }, cut);
  const double of_cut = press(cut), of_whole = press(rest_state(model));
  std::printf("on a closed cut %.4f N, on whole tissue %.4f N\n", of_cut, of_whole);
  EXPECT_GT(of_cut / of_whole, 0.5);
  EXPECT_LT(of_cut / of_whole, 1.0);
}

}  // namespace
}  // namespace ctpm
