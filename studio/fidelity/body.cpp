#include "studio/fidelity/body.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <numbers>
#include <thread>

#include "core/contact/drawn_surfaces.h"
#include "core/stepping/integrator.h"
#include "importers/mesh.h"
#include "scenes/build_model.h"

namespace ctpm::fidelity {
namespace {

/// The point of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_point(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

}  // namespace

void use_slow_pace(scenes::SceneSpec& scene) {
  scene.tick = 0.05;
  scene.solver.integrator = scenes::IntegratorSpec::backward_euler;
  scene.solver.tolerance = 1e-7, scene.solver.velocity_floor = 1e-9, scene.solver.max_iterations = 5000;
}

scenes::SceneSpec scene_of(const Specimen& specimen) {
  scenes::SceneSpec scene;
  scene.name = "fidelity";
  scene.gravity = rotate(specimen.turn, specimen.gravity);
  scene.contact_friction = specimen.friction;
  scenes::OrganSpec organ;
  organ.name = "body", organ.mesh = specimen.mesh.path;
  organ.tiling = specimen.tiling;
  organ.material.preset = "liver", organ.material.density = specimen.density;
  organ.fill.radius = organ.fill.gap = specimen.radius;
  if (specimen.clamp) {
    organ.anchors.resize(1);
    organ.anchors[0].plane = scenes::PlaneRegion{rotate(specimen.turn, specimen.clamp->point) + specimen.shift,
                                                 rotate(specimen.turn, specimen.clamp->normal)};
  }
  if (specimen.pace == Pace::slow) organ.material.viscosity = 0, use_slow_pace(scene);
  scene.organs.push_back(organ);
  for (const double radius : specimen.balls) {
    scenes::ToolSpec ball;
    ball.name = "ball-" + std::to_string(scene.tools.size()), ball.kind = ToolKind::ball, ball.radius = radius;
    scene.tools.push_back(ball);
  }
  return scene;
}

Result<importers::Filling> fill_mesh(const scenes::OrganSpec& organ, const importers::RawMesh& mesh,
                                     importers::FillOptions options) {
  importers::RepairOptions repair;
  repair.all_parts = organ.all_parts;
  const Result<importers::CheckedMesh> checked = importers::repair_mesh(mesh, 1.0, repair);
  if (!checked) return checked.errors();
  options.sphere_radius = organ.fill.radius, options.gap = organ.fill.gap, options.threads = 1;
  return importers::fill_organ(*checked, options);
}

Result<Body> make_body(const scenes::SceneSpec& scene, const importers::RawMesh& mesh, Quat turn, Vec3 shift,
                       importers::FillOptions options) {
  importers::RawMesh placed = mesh;
  for (Vec3& v : placed.vertex) v = rotate(turn, v) + shift;
  Result<importers::Filling> filling = fill_mesh(scene.organs[0], placed, options);
  if (!filling) return filling.errors();
  Result<scenes::BuiltScene> built = scenes::build_model(scene, {&filling->organ, 1});
  if (!built) return built.errors();
  return Body{std::move(filling->organ), std::move(built->model), std::move(filling->report), turn, shift};
}

Result<Body> make_body(const Specimen& specimen) {
  return make_body(scene_of(specimen), specimen.mesh, specimen.turn, specimen.shift);
}

void hold(Model& model, const std::vector<std::int32_t>& spheres, std::uint8_t axes) {
  for (const std::int32_t i : spheres) model.held_axes[std::size_t(i)] |= axes;
}

stepping::StepReport settle(stepping::Stepper& stepper, State& state, const Inputs& hand, std::int64_t most,
                            double still) {
  stepping::StepReport report;
  for (std::int64_t tick = 0; tick < most; ++tick) {
    const Vec3Array before = state.position;
    report = stepper.step(state, hand);
    if (stepping::is_refused(report.status)) return report;
    double moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i) moved = std::max(moved, norm(state.position[i] - before[i]));
    if (moved < still) return report;
  }
  report.status = stepping::StepStatus::not_converged;
  return report;
}

void run_for(const Model& model, State& state, double time) {
  stepping::Stepper stepper(model);
  for (std::int64_t t = 0; t < std::llround(time / model.tick); ++t) (void)stepper.step(state, {});
}

Vec3 centre_of_mass(const Model& model, const Vec3Array& position) {
  Vec3 sum;
  double mass = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) sum += model.mass[i] * position[i], mass += model.mass[i];
  return sum / mass;
}

std::vector<Vec3> drawn_at(const Body& body, const State& state) {
  std::vector<Vec3> vertex;
  contact::DrawnSurfaces(body.model).place(0, body.organ.surface, state, vertex);
  return vertex;
}

double distance_to(const Surface& surface, const std::vector<Vec3>& vertex, Vec3 point) {
  double least = INFINITY;
  for (const auto& [a, b, c] : surface.triangle) {
    const Vec3 apart =
        point - nearest_point(vertex[std::size_t(a)], vertex[std::size_t(b)], vertex[std::size_t(c)], point);
    least = std::min(least, dot(apart, apart));
  }
  return std::sqrt(least);
}

CellCount count_cells(const Body& body, const State& state) {
  std::map<std::array<std::int32_t, 3>, std::size_t> sphere_at;
  for (std::size_t i = 0; i < body.organ.cell.size(); ++i) sphere_at[body.organ.cell[i]] = i;
  CellCount count;
  for (const auto& [cell, first] : sphere_at) {
    std::size_t corner[2][2][2];
    bool is_whole = true;
    for (int n = 0; n < 8 && is_whole; ++n) {
      const auto it = sphere_at.find({cell[0] + (n & 1), cell[1] + (n >> 1 & 1), cell[2] + (n >> 2 & 1)});
      is_whole = it != sphere_at.end();
      if (is_whole) corner[n & 1][n >> 1 & 1][n >> 2 & 1] = it->second;
    }
    if (!is_whole) continue;
    ++count.cells;
    bool is_inside_out = false;
    for (int n = 0; n < 8; ++n) {
      const int i = n & 1, j = n >> 1 & 1, k = n >> 2 & 1;
      const Vec3 apex = state.position[corner[i][j][k]];
      // Each edge points the way of its axis, so a cell at rest has positive volumes at all corners.
      const Vec3 u = (1.0 - 2 * i) * (state.position[corner[1 - i][j][k]] - apex);
      const Vec3 v = (1.0 - 2 * j) * (state.position[corner[i][1 - j][k]] - apex);
      const Vec3 w = (1.0 - 2 * k) * (state.position[corner[i][j][1 - k]] - apex);
      is_inside_out = is_inside_out || dot(cross(u, v), w) <= 0;
    }
    count.inside_out += is_inside_out;
  }
  return count;
}

Quat turn_about(Vec3 axis, double angle) {
  const Vec3 n = std::sin(0.5 * angle) / norm(axis) * axis;
  return {std::cos(0.5 * angle), n.x, n.y, n.z};
}

std::vector<Quat> twelve_turns() {
  constexpr double kDegree = std::numbers::pi / 180;
  std::vector<Quat> turns{{},
                          turn_about({1, 0, 0}, 15 * kDegree),
                          turn_about({1, 0, 0}, 30 * kDegree),
                          turn_about({1, 0, 0}, 45 * kDegree),
                          turn_about({1, -1, 0}, std::acos(1 / std::sqrt(3.0)))};  // a cube stands on its corner
  // Axes evenly over the sphere (a golden spiral), angles evenly over 90 degrees.
  constexpr int kOthers = 7;
  for (int i = 0; i < kOthers; ++i) {
    const double z = 1 - (2 * i + 1.0) / kOthers, around = std::numbers::pi * (1 + std::sqrt(5.0)) * (i + 0.5);
    const double flat = std::sqrt(1 - z * z);
    turns.push_back(
        turn_about({flat * std::cos(around), flat * std::sin(around), z}, (20 + 60.0 * i / (kOthers - 1)) * kDegree));
  }
  return turns;
}

void in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency())); ++i)
    others.emplace_back(run);
  run();
  for (std::thread& other : others) other.join();
}

}  // namespace ctpm::fidelity
