// A bar that is pulled, against the closed form.

#include <algorithm>
#include <cmath>

#include "core/stepping/integrator.h"
#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/references.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kSide = 48e-3, kLength = 96e-3, kStrain = 0.01;

/// Spheres within 3/4 of a spacing of an end, or beyond it: at least one layer, wherever the lattice lies.
std::vector<std::int32_t> spheres_at_end(const Body& body, double sign) {
  std::vector<std::int32_t> spheres;
  for (std::size_t i = 0; i < body.model.sphere_count(); ++i)
    if (sign * body.model.rest_position[i].z > 0.5 * kLength - 0.75 * body.spacing())
      spheres.push_back(std::int32_t(i));
  return spheres;
}

/// Force [N] of the body on held spheres along z at rest: they are let go for a microsecond, and the momentum that they
/// gain is the force times that time. Whatever the elements are, this needs only public ticks.
double force_along_z(const Model& held, const State& at_rest, const std::vector<std::int32_t>& spheres) {
  Model free = held;
  for (const std::int32_t i : spheres) free.held_axes[std::size_t(i)] = 0;
  free.tick = 1e-6;
  (void)stepping::resolve_integrator(free);
  State state = rest_state(free);
  state.position = at_rest.position, state.kelvin_elongation = at_rest.kelvin_elongation;
  stepping::Stepper stepper(free);
  (void)stepper.step(state, {});
  double momentum = 0;
  for (const std::int32_t i : spheres) momentum += free.mass[std::size_t(i)] * state.velocity[std::size_t(i)].z;
  return momentum / free.tick;
}

/// Mean contraction of the drawn sides at half length, over half the width and over the strain.
double poisson_of(const Body& body, const State& state) {
  const std::vector<Vec3> drawn = drawn_at(body, state);
  double narrowed = 0;
  int count = 0;
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    const Vec3 rest = body.organ.surface.vertex[v];
    if (std::abs(rest.z) > 0.125 * kLength) continue;
    for (const auto& [before, after] : {std::pair{rest.x, drawn[v].x}, std::pair{rest.y, drawn[v].y}})
      if (std::abs(before) > 0.5 * kSide - 1e-9) narrowed += 1 - after / before, ++count;
  }
  return narrowed / count / kStrain;
}

Result<TensionResult::Row> pull(double radius) {
  Specimen bar;
  bar.mesh = box_mesh(0.5 * Vec3{-kSide, -kSide, -kLength}, 0.5 * Vec3{kSide, kSide, kLength}, 4e-3);
  bar.radius = radius;
  Result<Body> body = make_body(bar);
  if (!body) return body.errors();
  const std::vector<std::int32_t> upper = spheres_at_end(*body, 1), lower = spheres_at_end(*body, -1);
  hold(body->model, upper, 4), hold(body->model, lower, 4);
  State state = rest_state(body->model);
  for (double& z : state.position.z) z *= 1 + kStrain;
  stepping::Stepper stepper(body->model);
  settle(stepper, state, {}, 400, 1e-10);
  const double force = -force_along_z(body->model, state, upper);
  return TensionResult::Row{radius, body->model.sphere_count(), force, force / kBarForce.value,
                            poisson_of(*body, state)};
}

}  // namespace

Result<TensionResult> measure_tension(std::span<const double> radii) {
  TensionResult result;
  for (const double radius : radii) {
    const Result<TensionResult::Row> row = pull(radius);
    if (!row) return row.errors();
    result.rows.push_back(*row);
  }
  return result;
}

Chapter chapter_of(const TensionResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "tension", section.title = "Tension of a bar";
  section.paragraphs = {
      "A bar of 48 x 48 x 96 mm; the spheres at both ends are held along z only and 1 % further apart. The force comes "
      "from the momentum that the upper end gains when it is let go for a microsecond; Poisson's ratio from the drawn "
      "sides."};
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},     {"spheres", "spheres"},
                   {"force_n", "force [N]"},    {"reference_n", "E0 A strain [N]"},
                   {"modulus_ratio", "E / E0"}, {"poisson", "Poisson's ratio", 3}};
  std::vector<double> radii, errors;
  for (const TensionResult::Row& row : result.rows) {
    table.rows.push_back(
        {1e3 * row.radius, std::int64_t(row.spheres), row.force, kBarForce.value, row.modulus_ratio, row.poisson});
    chapter.figures.push_back({.recipe = "tension",
                               .name = "E / E0",
                               .radius = row.radius,
                               .measured = row.modulus_ratio,
                               .reference = 1.0,
                               .source = kBarForce.source,
                               .goal = Goal{0.95, 1.05}});
    chapter.figures.push_back({.recipe = "tension",
                               .name = "Poisson's ratio",
                               .radius = row.radius,
                               .measured = row.poisson,
                               .reference = kPoisson,
                               .source = "closed form: cubic lattice",
                               .goal = Goal{0.2375, 0.2625}});
    radii.push_back(row.radius), errors.push_back(std::abs(row.modulus_ratio - 1));
  }
  section.tables = {table};
  if (radii.size() > 1)
    chapter.figures.push_back({.recipe = "tension",
                               .name = "order of convergence of E",
                               .measured = order_of(radii, errors),
                               .reference = 2.0,
                               .source = "linear elements",
                               .goal = Goal{1.5, {}}});
  return chapter;
}

}  // namespace ctpm::fidelity
