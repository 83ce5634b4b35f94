// Tissue meets the ground, a table, other tissue and itself.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/contact/drawn_surfaces.h"
#include "core/stepping/step.h"
#include "core/surface/obstacle_shape.h"
#include "core/surface/rigid_motion.h"
#include "core/surface/surface.h"
#include "tests/core/integrators.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kGravity = 9.81;

FilledOrgan block_at(int ni, int nj, int nk, Vec3 by, double edge = 0.003) {
  FilledOrgan organ = testing::make_block(ni, nj, nk);
  for (Vec3& centre : organ.centre) centre += by;
  testing::add_faces(organ, edge);
  return organ;
}

/// Unites two organs as two pieces of one.
FilledOrgan united(FilledOrgan a, const FilledOrgan& b, std::int32_t cells_up) {
  const auto vertices = std::int32_t(a.surface.vertex.size());
  for (auto cell : b.cell) a.cell.push_back({cell[0], cell[1], cell[2] + cells_up});
  a.centre.insert(a.centre.end(), b.centre.begin(), b.centre.end());
  a.layer.insert(a.layer.end(), b.layer.begin(), b.layer.end());
  a.depth.insert(a.depth.end(), b.depth.begin(), b.depth.end());
  a.surface.vertex.insert(a.surface.vertex.end(), b.surface.vertex.begin(), b.surface.vertex.end());
  for (auto t : b.surface.triangle) a.surface.triangle.push_back({t[0] + vertices, t[1] + vertices, t[2] + vertices});
  surface::bind_surface(a);
  return a;
}

void add(Model& model, const FilledOrgan& organ, int anchored = 0) {
  network::OrganSettings settings;
  settings.name = "organ " + std::to_string(model.organs.size());
  settings.structure = network::Structure::ctpm, settings.tiling = network::Tiling::two_spheres;
  settings.material = testing::liver_material(), settings.material.viscosity = 0.05e6;
  settings.inversion_resistance = 10;
  for (int i = 0; i < anchored; ++i) settings.anchored.push_back(i);
  CTPM_CHECK(bool(network::add_organ(model, organ, settings)), "a test's own organ is valid");
}

void finish(Model& model, Integrator integrator, double gravity = kGravity) {
  model.gravity = {0, 0, -gravity};
  model.contact_friction = 0.3;
  stepping::resolve_integrator(model, integrator);
  if (integrator == Integrator::leapfrog) model.solver.substeps = std::max(model.solver.substeps, 2);
  model.solver.tolerance = 1e-8, model.solver.velocity_floor = 1e-12;
}

void run(const Model& model, State& state, int ticks) {
  stepping::Stepper stepper(model);
  for (int i = 0; i < ticks; ++i) ASSERT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok) << i;
}

std::vector<Vec3> surface_of(const Model& model, const State& state, std::size_t organ) {
  std::vector<Vec3> vertex;
  surface::deform_surface(model.surfaces[organ], state.position, model.organs[organ].first, vertex);
  return vertex;
}

double lowest(const std::vector<Vec3>& points) {
  double least = points.front().z;
  for (const Vec3& p : points) least = std::min(least, p.z);
  return least;
}
double highest(const std::vector<Vec3>& points) {
  double most = points.front().z;
  for (const Vec3& p : points) most = std::max(most, p.z);
  return most;
}

struct Momentum {
  Vec3 linear, angular;
};
Momentum momentum_of(const Model& model, const State& state) {
  Momentum sum;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 p = model.mass[i] * state.velocity[i];
    sum.linear += p, sum.angular += cross(state.position[i], p);
  }
  return sum;
}

double fastest(const State& state) {
  double most = 0;
  for (std::size_t i = 0; i < state.velocity.size(); ++i) most = std::max(most, norm(state.velocity[i]));
  return most;
}

Vec3 centre_of(const Model& model, const State& state) {
  Vec3 sum;
  double mass = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    sum += model.mass[i] * state.position[i], mass += model.mass[i];
  return sum / mass;
}

class Meeting : public ::testing::TestWithParam<Integrator> {};

TEST_P(Meeting, AFallingOrganRestsOnTheGround) {
  Model model;
  add(model, block_at(4, 4, 3, {0, 0, 0.005}));
  model.obstacles.push_back({"ground", ObstacleKind::plane, {}, {}, {}});
  finish(model, GetParam());
  State state = rest_state(model);
  run(model, state, 1500);
  EXPECT_LT(fastest(state), 2e-3);
  EXPECT_GT(lowest(surface_of(model, state, 0)), -0.5e-3);
  EXPECT_LT(lowest(surface_of(model, state, 0)), 0);
}

TEST_P(Meeting, AFastOrganDoesNotPassThroughTheGround) {
  Model model;
  add(model, block_at(4, 4, 3, {0, 0, 0.005}));
  model.obstacles.push_back({"ground", ObstacleKind::plane, {}, {}, {}});
  finish(model, GetParam());
  State state = rest_state(model);
  for (double& v : state.velocity.z) v = -3;
  run(model, state, 100);
  EXPECT_GT(lowest(surface_of(model, state, 0)), -2e-3);
  EXPECT_GT(momentum_of(model, state).linear.z, -0.02) << "it had -0.26 kg m/s";
}

/// Turned about y by `degrees`.
Quat slope(double degrees) {
  const double half = 0.5 * degrees * std::numbers::pi / 180;
  return {std::cos(half), 0, std::sin(half), 0};
}

/// How far an organ goes down a slope in `ticks` after it has come to rest on the level, with the slope made by gravity
/// [m].
double slides(Integrator integrator, double degrees, int ticks, bool on_box) {
  Model model;
  add(model, block_at(4, 4, 2, {0, 0, 1e-4}));
  if (on_box)
    model.obstacles.push_back({"table", ObstacleKind::box, {0, 0, -0.01}, {}, {0.3, 0.2, 0.01}});
  else
    model.obstacles.push_back({"ground", ObstacleKind::plane, {}, {}, {}});
  finish(model, integrator);
  State state = rest_state(model);
  run(model, state, 800);
  model.gravity = rotate(slope(-degrees), model.gravity);
  const Vec3 before = centre_of(model, state);
  run(model, state, ticks);
  return std::abs((centre_of(model, state) - before).x);
}

TEST_P(Meeting, FrictionHoldsAnOrganOnAFlatSlopeAndLetsItSlideOnASteepOne) {
  for (const bool on_box : {false, true}) {
    EXPECT_LT(slides(GetParam(), 10, 500, on_box), 2e-3) << "tan 10 degrees is 0.18, below the coefficient of 0.3";
    const double angle = 35 * std::numbers::pi / 180, t = 0.3;
    const double free = 0.5 * kGravity * (std::sin(angle) - 0.3 * std::cos(angle)) * t * t;
    EXPECT_NEAR(slides(GetParam(), 35, 300, on_box), free, 0.1 * free) << "Coulomb";
  }
}

TEST_P(Meeting, AnOrganWithoutASurfaceRestsOnItsSpheres) {
  Model model;
  add(model, testing::make_block(3, 3, 3));
  for (double& z : model.rest_position.z) z += 0.01;
  model.contact_k = 2000;
  model.obstacles.push_back({"ground", ObstacleKind::plane, {}, {}, {}});
  finish(model, GetParam());
  State state = rest_state(model);
  run(model, state, 1500);
  double least = 1;
  for (const double z : state.position.z) least = std::min(least, z);
  EXPECT_NEAR(least, model.contact_radius[0], 0.5e-3);
}

TEST_P(Meeting, AnOrganRestsOnAnOrgan) {
  Model model;
  add(model, block_at(6, 6, 3, {}), 36);
  add(model, block_at(4, 3, 3, {0.002, 0.001, 0.024 + 0.004}));
  model.organs_meet = true;
  finish(model, GetParam());
  State state = rest_state(model);
  run(model, state, 1500);
  EXPECT_LT(fastest(state), 5e-3);
  const double gap = lowest(surface_of(model, state, 1)) - highest(surface_of(model, state, 0));
  EXPECT_LT(std::abs(gap), 1.5e-3) << gap << ": the lower one's rim stands a little above the place pressed";
}

TEST_P(Meeting, OrgansThatDentEachOtherAreDrawnSideBySide) {
  Model model;
  add(model, block_at(6, 6, 3, {}), 36);
  add(model, block_at(3, 3, 3, {0.002, 0.001, 0.024 + 1e-4}));
  model.organs_meet = true;
  for (double& m : model.mass) m *= 3;
  finish(model, GetParam());
  State state = rest_state(model);
  run(model, state, 600);
  // Around the middle of the upper one's lower face.
  const auto range = [](const std::vector<Vec3>& points, double z) {
    double least = 1, most = -1;
    for (const Vec3& p : points)
      if (std::abs(p.x - 0.002) < 0.008 && std::abs(p.y - 0.001) < 0.008 && std::abs(p.z - z) < 0.006)
        least = std::min(least, p.z), most = std::max(most, p.z);
    return std::pair{least, most};
  };
  contact::DrawnSurfaces drawn(model);
  std::vector<Vec3> lower, upper;
  drawn.place(0, model.surfaces[0], state, lower), drawn.place(1, model.surfaces[1], state, upper);
  const double carried =
      range(surface_of(model, state, 0), 0.024).second - range(surface_of(model, state, 1), 0.024).first;
  EXPECT_GT(carried, 2e-4) << "the lattices overlap";
  const double seen = range(lower, 0.024).second - range(upper, 0.024).first;
  EXPECT_LT(std::abs(seen), 0.25 * carried);
}

TEST_P(Meeting, AFastOrganDoesNotPassThroughAnother) {
  Model model;
  add(model, block_at(6, 6, 3, {}), 36);
  add(model, block_at(4, 4, 3, {0.002, 0.001, 0.024 + 0.005}));
  model.organs_meet = true;
  finish(model, GetParam());
  State state = rest_state(model);
  for (std::size_t i = std::size_t(model.organs[1].first); i < model.sphere_count(); ++i) state.velocity.z[i] = -3;
  run(model, state, 100);
  EXPECT_GT(lowest(surface_of(model, state, 1)), 0.008) << "the lower one is 24 mm high and gives way";
  EXPECT_GT(momentum_of(model, state).linear.z, -0.02) << "it had -0.26 kg m/s";
}

TEST_P(Meeting, TwoOrgansThatCollideKeepTheirMomentum) {
  Model model;
  add(model, block_at(3, 3, 3, {}));
  add(model, block_at(3, 3, 3, {0.007, 0.004, 0.026}));
  model.organs_meet = true;
  finish(model, GetParam(), 0);
  State state = rest_state(model);
  for (std::size_t i = 0; i < model.sphere_count(); ++i) state.velocity.z[i] = i < 27 ? 0.3 : -0.3;
  const Momentum before = momentum_of(model, state);
  run(model, state, 100);
  const Momentum after = momentum_of(model, state);
  const double scale = 27 * model.mass[0] * 0.3;
  // An implicit solve leaves a residual.
  const double rounding = GetParam() == Integrator::leapfrog ? 1e-12 : 1e-6;
  EXPECT_LT(norm(after.linear - before.linear), rounding * scale);
  // Friction acts where both are. An implicit step turns forces and places by what it moves them.
  const double turned = GetParam() == Integrator::leapfrog ? 1e-12 : 0.02;
  EXPECT_LT(norm(after.angular - before.angular), turned * scale * 0.012);
  double up = 0;
  for (std::size_t i = 27; i < 54; ++i) up += model.mass[i] * state.velocity.z[i];
  EXPECT_GT(up, -0.1 * scale) << "the upper one was stopped";
  EXPECT_GT(lowest(surface_of(model, state, 1)) - highest(surface_of(model, state, 0)), -3e-3);
}

TEST_P(Meeting, PartsOfOneOrganMeetIfItAsksForIt) {
  for (const bool meets : {false, true}) {
    Model model;
    const FilledOrgan lower = block_at(5, 5, 2, {}), upper = block_at(3, 3, 3, {0, 0, 0.012 + 0.03});
    add(model, united(lower, upper, 4), 25);
    model.organs[0].meets_itself = meets;
    finish(model, GetParam());
    State state = rest_state(model);
    run(model, state, 600);
    double least = 1;
    for (std::size_t i = 50; i < model.sphere_count(); ++i) least = std::min(least, state.position.z[i]);
    if (meets)
      EXPECT_GT(least, 0.010);
    else
      EXPECT_LT(least, -0.5) << "it falls through";
  }
}

TEST_P(Meeting, AnOrganAloneDoesNotMeetItself) {
  Model model;
  add(model, block_at(5, 5, 3, {}), 25);
  finish(model, GetParam());
  State plain = rest_state(model), meets = plain;
  testing::shake(plain, 1e-3, 0), testing::shake(meets, 1e-3, 0);
  run(model, plain, 20);
  model.organs[0].meets_itself = true;
  run(model, meets, 20);
  EXPECT_EQ(plain.position, meets.position) << "surroundings and the far side are no contact";
  EXPECT_TRUE(meets.touched.empty());
}

TEST_P(Meeting, ThreadsAndInstructionSetsChangeNoBit) {
  Model model;
  add(model, block_at(6, 6, 3, {}));
  add(model, block_at(4, 3, 3, {0.002, 0.001, 0.0245}));
  model.organs_meet = true, model.organs[0].meets_itself = true;
  model.obstacles = {{"ground", ObstacleKind::plane, {0, 0, -1e-4}, slope(3), {}},
                     {"wall", ObstacleKind::box, {0.06, 0, 0}, {}, {0.0302, 0.1, 0.1}}};
  finish(model, GetParam());
  State one = rest_state(model), two = one;
  stepping::Stepper single(model, {1, elements::InstructionSet::baseline}), team(model, {2});
  for (int i = 0; i < 60; ++i) (void)single.step(one, {}), (void)team.step(two, {});
  EXPECT_GT(one.touched.size(), 20u);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.touched, two.touched);
  EXPECT_EQ(one.grip, two.grip);
}

CTPM_UNDER_EACH_INTEGRATOR(Meeting);

TEST(RigidMotion, IsFoundUnderDeformation) {
  Model model;
  add(model, block_at(4, 4, 3, {0.01, 0.02, 0.03}));
  const Quat turn{0.5, 0.5, -0.1, 0.7};  // a unit quaternion
  State state = rest_state(model);
  const Vec3 from = centre_of(model, state), to{0.3, -0.1, 0.2};
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    Vec3 p = state.position[i] - from;
    p = {1.1 * p.x, 0.8 * p.y, p.z};  // a stretch along the axes does not turn
    state.position.set(i, to + rotate(turn, p));
  }
  std::vector<std::int32_t> spheres(model.sphere_count());
  std::iota(spheres.begin(), spheres.end(), 0);
  const surface::RigidMotion motion = surface::rigid_motion(model, spheres, state.position);
  for (const Vec3 p : {Vec3{0.01, 0, 0}, Vec3{0, 0.02, 0}, Vec3{0.01, -0.01, 0.03}})
    EXPECT_NEAR(norm(motion(from + p) - (to + rotate(turn, p))), 0, 1e-14);
}

TEST(RigidMotion, AFreeOrgansDepthDoesNotCountItsOwnWay) {
  Model model;
  add(model, block_at(4, 4, 3, {}));
  model.tools = {testing::ball(0.01)};
  finish(model, Integrator::leapfrog, 0);
  State state = rest_state(model);
  for (double& v : state.velocity.x) v = 0.1;
  run(model, state, 500);  // 50 mm away
  stepping::Stepper stepper(model);
  Inputs inputs;
  inputs.tool = 0, inputs.position = {0.05, 0, 0.024 + 0.01 - 0.001};
  const stepping::StepReport report = stepper.step(state, inputs);
  EXPECT_GT(report.contacts, 0);
  EXPECT_NEAR(report.depth, 0.001, 0.0002);
}

TEST(Obstacle, SaysHowDeepAPointIsAndTheShortestWayOut) {
  const Obstacle plane{"plane", ObstacleKind::plane, {0, 0, 0.1}, slope(90), {}};  // normal along x
  EXPECT_NEAR(surface::ObstacleShape(plane).inside({-0.02, 5, 7}).depth, 0.02, 1e-14);
  EXPECT_NEAR(surface::ObstacleShape(plane).inside({0.03, 0, 0}).depth, -0.03, 1e-14);
  EXPECT_NEAR(surface::ObstacleShape(plane).inside({0, 0, 0}).outward.x, 1, 1e-14);
  const Obstacle box{"box", ObstacleKind::box, {1, 2, 3}, slope(90), {0.1, 0.2, 0.3}};  // its z is the world's x
  const surface::Inside inside = surface::ObstacleShape(box).inside({1.25, 2.1, 3});
  EXPECT_NEAR(inside.depth, 0.05, 1e-12);
  EXPECT_NEAR(norm(inside.outward - Vec3{1, 0, 0}), 0, 1e-12);
  const surface::Inside corner = surface::ObstacleShape(box).inside({1.33, 2.24, 3});
  EXPECT_NEAR(corner.depth, -0.05, 1e-12);
  EXPECT_NEAR(norm(corner.outward - Vec3{0.6, 0.8, 0}), 0, 1e-12);
}

}  // namespace
}  // namespace ctpm
