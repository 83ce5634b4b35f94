// Tissue meets a rigid mesh.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/contact/drawn_surfaces.h"
#include "core/stepping/step.h"
#include "core/surface/obstacle_shape.h"
#include "core/surface/rigid_mesh.h"
#include "tests/core/integrators.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

using surface::Inside;
using surface::RigidMesh;

/// A box as a mesh in its own frame, each face divided into 2 n^2 triangles.
Obstacle box_mesh(Vec3 half, int n) {
  Obstacle mesh{"mesh", ObstacleKind::mesh, {}, {}, {}};
  const double size[3] = {half.x, half.y, half.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto vertex = [&](int i, int j) {
        double at[3];
        at[axis] = side * size[axis], at[u] = size[u] * (2.0 * i / n - 1), at[v] = size[v] * (2.0 * j / n - 1);
        // Neighbouring faces share their corners.
        for (std::size_t k = 0; k < mesh.vertex.size(); ++k)
          if (norm(mesh.vertex[k] - Vec3{at[0], at[1], at[2]}) < 1e-9) return std::int32_t(k);
        mesh.vertex.push_back({at[0], at[1], at[2]});
        return std::int32_t(mesh.vertex.size() - 1);
      };
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const std::int32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
          if (side > 0)
            mesh.corner.insert(mesh.corner.end(), {a, b, c, a, c, d});
          else
            mesh.corner.insert(mesh.corner.end(), {a, c, b, a, d, c});
        }
    }
  return mesh;
}

TEST(MeshObstacle, OfABoxIsAsDeepEverywhereAsTheBox) {
  const Vec3 half{0.03, 0.02, 0.01};
  Obstacle mesh = box_mesh(half, 3), box{"box", ObstacleKind::box, {}, {}, half};
  mesh.position = box.position = {0.1, -0.2, 0.3};
  mesh.world_from_obstacle = box.world_from_obstacle = {0.5, 0.5, -0.1, 0.7};
  const surface::ObstacleShape as_mesh(mesh), as_box(box);
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto part = [&](int prime) { return 2.6 * std::fmod(i * std::sqrt(double(prime)), 1.0) - 1.3; };
    const Vec3 point =
        box.position + rotate(box.world_from_obstacle, {half.x * part(2), half.y * part(3), half.z * part(5)});
    const Inside expected = as_box.inside(point), found = as_mesh.inside(point);
    EXPECT_NEAR(found.depth, expected.depth, 1e-12);
    EXPECT_NEAR(norm(found.outward), 1, 1e-12);
    if (expected.depth > 0)
      EXPECT_NEAR(norm(point + found.depth * found.outward - (point + expected.depth * expected.outward)), 0,
                  2 * half.z);
    else
      EXPECT_NEAR(norm(found.outward - expected.outward), 0, 1e-6);
    inside += expected.depth > 0;
  }
  EXPECT_GT(inside, 1000);
}

TEST(MeshObstacle, KnowsItsInsideAtEdgesAndCornersThatPointInwards) {
  // A tetrahedron with a dent: the apex of its base is pushed in.
  const std::vector<Vec3> vertex{{0, 0, 0.5}, {1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {0, 0, 1.5}};
  const std::vector<RigidMesh::Triangle> triangle{{1, 2, 4}, {2, 3, 4}, {3, 1, 4}, {2, 1, 0}, {3, 2, 0}, {1, 3, 0}};
  const RigidMesh mesh(vertex, triangle);
  EXPECT_GT(mesh.inside({0, 0, 0.6}).depth, 0) << "above the dent's apex";
  EXPECT_LT(mesh.inside({0, 0, 0.4}).depth, 0) << "in the dent";
  EXPECT_LT(mesh.inside({0, 0, 0.1}).depth, 0);
  EXPECT_NEAR(mesh.inside({0, 0, 1.7}).depth, -0.2, 1e-12);
}

void add(Model& model, Vec3 by) {
  FilledOrgan organ = testing::make_block(4, 4, 3);
  for (Vec3& centre : organ.centre) centre += by;
  testing::add_faces(organ, 0.003);
  network::OrganSettings settings;
  settings.name = "organ", settings.material = testing::liver_material();
  settings.structure = network::Structure::ctpm, settings.tiling = network::Tiling::two_spheres;
  settings.material.viscosity = 0.05e6;
  CTPM_CHECK(bool(network::add_organ(model, organ, settings)), "a test's own organ is valid");
}

class OnMesh : public ::testing::TestWithParam<Integrator> {
 protected:
  static Model model_on(const Obstacle& obstacle) {
    Model model;
    add(model, {0, 0, 1e-3});
    model.obstacles = {obstacle};
    model.gravity = {0, 0, -9.81}, model.contact_friction = 0.3;
    stepping::resolve_integrator(model, GetParam());
    if (GetParam() == Integrator::leapfrog) model.solver.substeps = std::max(model.solver.substeps, 2);
    model.solver.tolerance = 1e-8, model.solver.velocity_floor = 1e-12;
    return model;
  }
  static Obstacle table() {
    Obstacle table = box_mesh({0.2, 0.2, 0.02}, 5);
    table.position = {0.003, 0.002, -0.02};
    return table;
  }
  static void run(const Model& model, State& state, int ticks) {
    stepping::Stepper stepper(model);
    for (int i = 0; i < ticks; ++i) ASSERT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok) << i;
  }
  static Vec3 momentum(const Model& model, const State& state) {
    Vec3 sum;
    for (std::size_t i = 0; i < model.sphere_count(); ++i) sum += model.mass[i] * state.velocity[i];
    return sum;
  }
};

TEST_P(OnMesh, AnOrganRestsAsOnAPlane) {
  const Model on_mesh = model_on(table()), on_plane = model_on({"ground", ObstacleKind::plane, {}, {}, {}});
  State mesh = rest_state(on_mesh), plane = rest_state(on_plane);
  run(on_mesh, mesh, 400), run(on_plane, plane, 400);
  EXPECT_GT(mesh.touched.size(), 3u);
  EXPECT_EQ(mesh.touched, plane.touched);
  for (std::size_t i = 0; i < mesh.position.size(); ++i)
    ASSERT_NEAR(norm(mesh.position[i] - plane.position[i]), 0, 1e-7) << i;
  std::vector<Vec3> drawn;
  contact::DrawnSurfaces(on_mesh).place(0, on_mesh.surfaces[0], mesh, drawn);
  for (const Vec3& p : drawn) EXPECT_GT(p.z, -1e-9) << "nothing is drawn inside";
}

TEST_P(OnMesh, FrictionHoldsOnASlopeBelowItsAngleAndSlidesBeyond) {
  for (const double degrees : {10.0, 35.0}) {
    Model model = model_on(table());
    State state = rest_state(model);
    run(model, state, 600);
    const double angle = degrees * std::numbers::pi / 180, t = 0.2;
    model.gravity = {9.81 * std::sin(angle), 0, -9.81 * std::cos(angle)};
    run(model, state, 200);
    double mass = 0;
    for (const double m : model.mass) mass += m;
    const double speed = momentum(model, state).x / mass;
    if (degrees < 20)
      EXPECT_LT(std::abs(speed), 0.01);
    else
      EXPECT_NEAR(speed, 9.81 * (std::sin(angle) - 0.3 * std::cos(angle)) * t, 0.1 * speed) << "Coulomb";
  }
}

TEST_P(OnMesh, ThreadsChangeNoBit) {
  const Model model = model_on(table());
  State one = rest_state(model), two = one;
  stepping::Stepper single(model, {1, elements::InstructionSet::baseline}), team(model, {2});
  for (int i = 0; i < 60; ++i) (void)single.step(one, {}), (void)team.step(two, {});
  EXPECT_FALSE(one.touched.empty());
  EXPECT_EQ(one.position, two.position);
}

CTPM_UNDER_EACH_INTEGRATOR(OnMesh);

}  // namespace
}  // namespace ctpm
