// Bodies that meet: they rest on the ground and on each other, keep their momentum, and rub.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/contact/drawn_surfaces.h"
#include "core/stepping/integrator.h"
#include "scenes/build_model.h"
#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"

namespace ctpm::fidelity {
namespace {

constexpr double kGravity = 9.81, kBallRadius = 40e-3, kDrop = 10e-3;  // [m/s^2], [m], [m]
constexpr double kRestTime = 4.0, kCollisionTime = 0.4, kSpeed = 0.3;  // [s], [s], [m/s]
constexpr double kFriction = 0.3, kFlatSlope = 10, kSteepSlope = 35;   // [1], [degrees]
constexpr double kHeldTime = 2.0, kSlideTime = 0.3;                    // [s]

/// Organs of liver, each from a mesh in the world.
struct Organs {
  Model model;
  std::vector<FilledOrgan> filled;
};

Result<Organs> make_organs(scenes::SceneSpec scene, const std::vector<importers::RawMesh>& meshes, double radius) {
  Organs organs;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    scenes::OrganSpec& organ = scene.organs[i];
    organ.name = "organ " + std::to_string(i + 1), organ.mesh = meshes[i].path, organ.material.preset = "liver";
    organ.fill.radius = organ.fill.gap = radius;
    Result<importers::Filling> filling = fill_mesh(organ, meshes[i]);
    if (!filling) return filling.errors();
    organs.filled.push_back(std::move(filling->organ));
  }
  scene.name = "fidelity", scene.contact_friction = kFriction;
  Result<scenes::BuiltScene> built = scenes::build_model(scene, organs.filled);
  if (!built) return built.errors();
  organs.model = std::move(built->model);
  return organs;
}

scenes::SceneSpec scene_with(std::size_t organs, double gravity) {
  scenes::SceneSpec scene;
  scene.organs.resize(organs);
  scene.gravity = {0, 0, -gravity};
  scene.organs_meet = organs > 1;
  return scene;
}

scenes::ObstacleSpec ground() { return {"ground", scenes::PlaneRegion{{}, {0, 0, 1}}, {}}; }

importers::RawMesh moved(importers::RawMesh mesh, Vec3 by) {
  for (Vec3& v : mesh.vertex) v += by;
  return mesh;
}

importers::RawMesh ball_at_place(Vec3 centre, double radius) {
  return moved(ball_mesh(kBallRadius, 0.75 * radius), centre);
}

std::vector<Vec3> drawn(const Organs& organs, const State& state, std::size_t organ) {
  std::vector<Vec3> vertex;
  contact::DrawnSurfaces(organs.model).place(organ, organs.filled[organ].surface, state, vertex);
  return vertex;
}

double fastest(const State& state) {
  double most = 0;
  for (std::size_t i = 0; i < state.velocity.size(); ++i) most = std::max(most, norm(state.velocity[i]));
  return most;
}

/// Height of a surface above or below (x, y) [m]: its highest point there; -infinity where it has none.
double height_at(const Surface& surface, const std::vector<Vec3>& vertex, double x, double y) {
  double highest = -INFINITY;
  for (const auto& t : surface.triangle) {
    const Vec3 a = vertex[std::size_t(t[0])], b = vertex[std::size_t(t[1])], c = vertex[std::size_t(t[2])];
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    const double v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area,
                 w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) highest = std::max(highest, a.z + v * (b.z - a.z) + w * (c.z - a.z));
  }
  return highest;
}

/// A ball organ that falls on the ground, or on another organ whose lower side is held.
Result<MeetingResult::Rest> measure_rest(bool on_organ, double radius) {
  scenes::SceneSpec scene = scene_with(on_organ ? 2 : 1, kGravity);
  std::vector<importers::RawMesh> meshes{ball_at_place({0.003, 0.002, kBallRadius + kDrop}, radius)};
  if (on_organ) {
    meshes.push_back(box_mesh({-60e-3, -60e-3, -48e-3}, {60e-3, 60e-3, 0}, 0.75 * radius));
    scene.organs[1].anchors.resize(1);
    scene.organs[1].anchors[0].plane = scenes::PlaneRegion{{0, 0, -42e-3}, {0, 0, 1}};
  } else {
    scene.obstacles.push_back(ground());
  }
  const Result<Organs> organs = make_organs(scene, meshes, radius);
  if (!organs) return organs.errors();
  State state = rest_state(organs->model);
  run_for(organs->model, state, kRestTime);
  MeetingResult::Rest rest;
  rest.on = on_organ ? "another organ" : "the ground", rest.speed = fastest(state), rest.overlap = -INFINITY;
  const std::vector<Vec3> upper = drawn(*organs, state, 0),
                          lower = on_organ ? drawn(*organs, state, 1) : std::vector<Vec3>{};
  for (const Vec3& v : upper)
    rest.overlap =
        std::max(rest.overlap, (on_organ ? height_at(organs->filled[1].surface, lower, v.x, v.y) : 0.0) - v.z);
  return rest;
}

/// Two ball organs that fly at each other, past each other by half their radius.
Result<Done> measure_collision(MeetingResult& result) {
  const double gap = 2e-3, aside = 0.5 * kBallRadius, apart = std::sqrt(4 * kBallRadius * kBallRadius - aside * aside);
  const Result<Organs> organs = make_organs(
      scene_with(2, 0), {ball_at_place({}, result.radius), ball_at_place({aside, 0.001, apart + gap}, result.radius)},
      result.radius);
  if (!organs) return organs.errors();
  const Model& model = organs->model;
  result.integrator = stepping::name_of(model.solver.integrator);
  State state = rest_state(model);
  const auto first = std::size_t(model.organs[0].count);
  double scale = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    state.velocity.z[i] = i < first ? kSpeed : -kSpeed;
    if (i < first) scale += model.mass[i] * kSpeed;
  }
  const auto momentum = [&] {
    std::pair<Vec3, Vec3> sum;
    for (std::size_t i = 0; i < model.sphere_count(); ++i) {
      const Vec3 p = model.mass[i] * state.velocity[i];
      sum.first += p, sum.second += cross(state.position[i], p);
    }
    return sum;
  };
  const auto before = momentum();
  run_for(model, state, kCollisionTime);
  const auto after = momentum();
  result.momentum = norm(after.first - before.first) / scale;
  result.angular_momentum = norm(after.second - before.second) / (scale * kBallRadius);
  double lower = 0;
  for (std::size_t i = 0; i < first; ++i) lower += model.mass[i] * state.velocity.z[i];
  result.rebound = -lower / scale;
  return Done{};
}

/// How far a block of 48 x 48 x 24 mm slides in `time` [s] on a slope of `degrees`, after it came to rest on the level
/// [m].
Result<double> measure_slide(double degrees, double time, double radius) {
  scenes::SceneSpec scene = scene_with(1, kGravity);
  scene.obstacles.push_back(ground());
  Result<Organs> organs =
      make_organs(scene, {box_mesh({-24e-3, -24e-3, 0.1e-3}, {24e-3, 24e-3, 24.1e-3}, 0.75 * radius)}, radius);
  if (!organs) return organs.errors();
  Model& model = organs->model;
  State state = rest_state(model);
  run_for(model, state, 1.0);
  const double angle = degrees * std::numbers::pi / 180;
  model.gravity = {kGravity * std::sin(angle), 0, -kGravity * std::cos(angle)};
  const double before = centre_of_mass(model, state.position).x;
  run_for(model, state, time);
  return centre_of_mass(model, state.position).x - before;
}

}  // namespace

Result<MeetingResult> measure_meeting(double radius) {
  MeetingResult result;
  result.radius = radius;
  for (const bool on_organ : {false, true}) {
    const Result<MeetingResult::Rest> rest = measure_rest(on_organ, radius);
    if (!rest) return rest.errors();
    result.rests.push_back(*rest);
  }
  if (const Result<Done> done = measure_collision(result); !done) return done.errors();
  const Result<double> held = measure_slide(kFlatSlope, kHeldTime, radius),
                       slides = measure_slide(kSteepSlope, kSlideTime, radius);
  if (!held) return held.errors();
  if (!slides) return slides.errors();
  const double angle = kSteepSlope * std::numbers::pi / 180;
  result.creep = *held;
  result.slide = *slides / (0.5 * kGravity * (std::sin(angle) - kFriction * std::cos(angle)) * kSlideTime * kSlideTime);
  return result;
}

Chapter chapter_of(const MeetingResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "meeting", section.title = "Bodies that meet";
  section.paragraphs = {
      "Ticks of 1 ms with the integrator that `auto` takes (" + result.integrator +
      "). A ball organ of 40 mm radius falls by 10 mm and is looked at 4 s later. Two such organs fly at each other "
      "with "
      "0.3 m/s each, past each other by half a radius. A block of 48 x 48 x 24 mm lies on a slope of 10 degrees, which "
      "friction (0.3) holds, and on one of 35 degrees, which it does not."};
  const auto add = [&](const std::string& name, double measured, const std::string& unit, double reference,
                       const std::string& source, Goal goal) {
    chapter.figures.push_back({.recipe = "meeting",
                               .name = name,
                               .radius = result.radius,
                               .measured = measured,
                               .unit = unit,
                               .reference = reference,
                               .source = source,
                               .goal = goal});
  };
  for (const MeetingResult::Rest& rest : result.rests) {
    add("drawn surface inside " + rest.on, 1e3 * rest.overlap, "mm", 0, "requirement", {-0.5, 0.5});
    add("speed on " + rest.on + " after 4 s", 1e3 * rest.speed, "mm/s", 0, "requirement", {{}, 2.0});
  }
  add("momentum of a colliding pair lost", result.momentum, "1", 0, "conservation", {{}, 1e-12});
  add("angular momentum of a colliding pair lost", result.angular_momentum, "1", 0, "conservation", {{}, 0.01});
  add("creep on a slope below the friction angle in 2 s", 1e3 * result.creep, "mm", 0, "Coulomb", {{}, 0.5});
  add("slide down a slope beyond it over Coulomb's", result.slide, "1", 1, "closed form", {0.9, 1.1});
  reports::Table table;
  table.columns = {{"figure", "figure"}, {"value", "value", 6}};
  for (const Figure& figure : chapter.figures)
    table.rows.push_back({figure.name + (figure.unit == "1" ? "" : " [" + figure.unit + "]"), figure.measured});
  table.rows.push_back({std::string("speed after the collision over before"), result.rebound});
  section.tables = {table};
  return chapter;
}

}  // namespace ctpm::fidelity
