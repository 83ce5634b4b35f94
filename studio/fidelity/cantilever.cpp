// A beam that sags under its own weight, against finite elements.

#include <cmath>
#include <numbers>

#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/references.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kSide = 24e-3, kLength = 120e-3, kClamped = 12e-3, kGravity = 0.0981;

Specimen beam(double radius, const CantileverResult::Pose& pose) {
  Specimen beam;
  beam.mesh = box_mesh({0, -0.5 * kSide, -0.5 * kSide}, {kLength, 0.5 * kSide, 0.5 * kSide}, 4e-3);
  beam.radius = radius, beam.gravity = {0, 0, -kGravity};
  // Rounding of a turned plane must not decide whether a sphere on it is clamped.
  beam.clamp = scenes::PlaneRegion{{kClamped + 1e-6, 0, 0}, {1, 0, 0}};
  beam.turn = pose.turn, beam.shift = 3 * radius * pose.shift;
  return beam;
}

/// Way of the drawn end's middle along gravity [m].
double sag_of(const Body& body, const State& state) {
  const std::vector<Vec3> drawn = drawn_at(body, state);
  const Vec3 end = body.to_world({kLength, 0, 0});
  std::size_t nearest = 0;
  for (std::size_t v = 0; v < drawn.size(); ++v)
    if (norm(body.organ.surface.vertex[v] - end) < norm(body.organ.surface.vertex[nearest] - end)) nearest = v;
  const Vec3 way = drawn[nearest] - body.organ.surface.vertex[nearest];
  return dot(way, body.model.gravity) / norm(body.model.gravity);
}

}  // namespace

Result<CantileverResult> measure_cantilever(std::span<const double> radii) {
  constexpr double kDegree = std::numbers::pi / 180;
  const std::vector<CantileverResult::Pose> poses{
      {"along the lattice", {}, {}},
      {"shifted by a quarter of a spacing", {}, {0, 0.25, 0.25}},
      {"shifted by half a spacing", {}, {0, 0.5, 0.5}},
      {"turned 45 degrees about its length", turn_about({1, 0, 0}, 45 * kDegree), {}},
      {"turned 30 degrees in the plane of its sag", turn_about({0, 1, 0}, 30 * kDegree), {}}};
  CantileverResult result;
  result.rows.resize(radii.size() * poses.size());
  std::vector<Errors> errors(result.rows.size());
  in_parallel(result.rows.size(), [&](std::size_t job) {
    const double radius = radii[job / poses.size()];
    const CantileverResult::Pose& pose = poses[job % poses.size()];
    const Result<Body> body = make_body(beam(radius, pose));
    if (!body) {
      errors[job] = body.errors();
      return;
    }
    State state = rest_state(body->model);
    stepping::Stepper stepper(body->model);
    const stepping::StepReport report = settle(stepper, state, {}, 400, 1e-9);
    result.rows[job] = {radius, pose.name, body->model.sphere_count(), sag_of(*body, state),
                        report.status == stepping::StepStatus::ok};
  });
  for (const Errors& e : errors)
    if (!e.empty()) return e;
  return result;
}

Chapter chapter_of(const CantileverResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "cantilever", section.title = "Cantilever under its own weight";
  section.paragraphs = {
      "A beam of 24 x 24 x 120 mm; all spheres with x <= 12 mm are anchored; gravity 0.0981 m/s^2. The sag is that of "
      "the drawn vertex in the middle of the end. CalculiX gives " +
      output::short_number(1e3 * kCantileverSag.value, 5) + " mm (" +
      output::short_number(1e3 * kCantileverSagOnCoarseMesh, 5) +
      " mm on a mesh twice as coarse). Shifts change nothing while the lattice follows the mesh's box."};
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"}, {"pose", "pose"},           {"spheres", "spheres"},
                   {"sag_mm", "sag [mm]"},  {"ratio", "over CalculiX"}, {"rests", "at rest"}};
  for (const CantileverResult::Row& row : result.rows) {
    const double ratio = row.sag / kCantileverSag.value;
    table.rows.push_back({1e3 * row.radius, row.pose, std::int64_t(row.spheres), 1e3 * row.sag, ratio,
                          std::string(row.rests ? "yes" : "no")});
    chapter.figures.push_back({.recipe = "cantilever",
                               .name = "sag of the end, " + row.pose,
                               .radius = row.radius,
                               .measured = 1e3 * row.sag,
                               .unit = "mm",
                               .reference = 1e3 * kCantileverSag.value,
                               .source = kCantileverSag.source,
                               .goal = Goal{0.9e3 * kCantileverSag.value, 1.1e3 * kCantileverSag.value},
                               .note = row.rests ? "" : "still moved"});
  }
  section.tables = {table};
  std::vector<double> radii, errors;
  for (const CantileverResult::Row& row : result.rows)
    if (row.pose == result.rows[0].pose)
      radii.push_back(row.radius), errors.push_back(std::abs(row.sag / kCantileverSag.value - 1));
  if (radii.size() > 1)
    chapter.figures.push_back({.recipe = "cantilever",
                               .name = "order of convergence, " + result.rows[0].pose,
                               .measured = order_of(radii, errors),
                               .reference = 2.0,
                               .source = "linear elements",
                               .goal = Goal{1.5, {}}});
  return chapter;
}

}  // namespace ctpm::fidelity
