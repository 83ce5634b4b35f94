#include "studio/calibrate/experiment.h"

#include <algorithm>
#include <cmath>

#include "core/stepping/step.h"
#include "studio/rig/press_rig.h"
#include "studio/rig/site.h"

namespace ctpm::calibrate {
namespace {

constexpr double kMostTicks = 10000;  ///< of a run over time; a finer tick changes nothing that can be measured
constexpr double kLeastRamp = 0.05;   ///< of a load [s]; a step would make the spheres swing

/// The tissue's model with a material; backward Euler also damps the swinging of the spheres beside the pressed one.
Result<scenes::BuiltScene> build(const loading::LoadedScene& tissue, const scenes::MaterialSpec& material, double tick,
                                 const std::vector<scenes::LoadSpec>& loads) {
  return loading::build_changed(tissue, [&](scenes::SceneSpec& scene) {
    scene.organs[0].material = material, scene.tick = tick, scene.loads = loads;
    scene.solver.integrator = scenes::IntegratorSpec::backward_euler;
  });
}

double tick_of(const Measurement& measurement) {
  return std::max(1e-3, std::ceil(1e3 * measurement.rows.back().time / kMostTicks) * 1e-3);
}

/// Depth that a relaxation imposes at a time, from 0 mm at 0 s along its rows [mm].
double depth_at(const std::vector<Row>& rows, double time) {
  Row before;
  for (const Row& row : rows) {
    if (time <= row.time)
      return row.time > before.time
                 ? before.imposed + (time - before.time) / (row.time - before.time) * (row.imposed - before.imposed)
                 : row.imposed;
    before = row;
  }
  return before.imposed;
}

Vec3 pressed_place(const scenes::BuiltScene& built) {
  return built.model.rest_position[std::size_t(built.probe_sphere[0])];
}

/// Inputs with which the pin holds its sphere that deep [mm].
Inputs pressed_to(Vec3 place, double depth) {
  Inputs inputs = rig::pressed_to(depth);
  inputs.position = inputs.position + place;
  return inputs;
}

/// Crept tissue: without its viscosity it comes to rest at once.
std::optional<std::vector<double>> press_slowly(const loading::LoadedScene& tissue, scenes::MaterialSpec material,
                                                const std::vector<Row>& rows) {
  material.viscosity = 0;
  const Result<scenes::BuiltScene> built = build(tissue, material, 10e-3, {});
  if (!built) return std::nullopt;
  constexpr double kSpeed = 10, kHold = 1.5;  // [mm/s], [s]
  stepping::Stepper stepper(built->model);
  State state = rest_state(built->model);
  const Vec3 place = pressed_place(*built);
  std::vector<double> force;
  double depth = 0;
  for (const Row& row : rows) {
    stepping::StepReport report;
    for (double held = 0; held < kHold; held += depth < row.imposed ? 0 : built->model.tick) {
      depth = std::min(row.imposed, depth + kSpeed * built->model.tick);
      report = stepper.step(state, pressed_to(place, depth));
      if (report.status != stepping::StepStatus::ok) return std::nullopt;
    }
    force.push_back(report.tool_force.z);
  }
  return force;
}

/// Steps until each row's time; `value` is read after each tick and interpolated.
template <class Inputs_, class Value>
std::optional<std::vector<double>> run_over_time(const Model& model, const std::vector<Row>& rows,
                                                 const Inputs_& inputs, const Value& value) {
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  std::vector<double> values;
  double before = 0;
  for (std::int64_t tick = 1; values.size() < rows.size(); ++tick) {
    const double time = double(tick) * model.tick;
    const stepping::StepReport report = stepper.step(state, inputs(time));
    if (report.status != stepping::StepStatus::ok) return std::nullopt;
    const double now = value(state, report);
    while (values.size() < rows.size() && rows[values.size()].time <= time + 1e-9) {
      const double share = 1 - (time - rows[values.size()].time) / model.tick;
      values.push_back(before + share * (now - before));
    }
    before = now;
  }
  return values;
}

}  // namespace

Parameters parameters_of(const scenes::MaterialSpec& material) {
  scenes::OrganSpec organ;
  organ.material = material;
  const rig::Site site = rig::site_of(organ);
  return {rig::p2(site), site.constraint / rig::p2(site), site.kelvin / site.spring, rig::p1(site)};
}

scenes::MaterialSpec with_moduli(scenes::MaterialSpec material, const Parameters& parameters) {
  material.spring = 1e6 * parameters.spring(), material.kelvin = 1e6 * parameters.kelvin();
  material.constraint = 1e6 * parameters.prime(), material.viscosity = 1e6 * parameters.viscosity();
  return material;
}

std::optional<std::vector<double>> simulate(const loading::LoadedScene& tissue, const scenes::MaterialSpec& material,
                                            const Measurement& measurement) {
  const std::vector<Row>& rows = measurement.rows;
  if (measurement.kind == Kind::indentation) return press_slowly(tissue, material, rows);
  const bool is_creep = measurement.kind == Kind::creep;
  std::vector<scenes::LoadSpec> loads;
  if (is_creep) {
    const double load = rows.back().imposed;
    const auto full = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.imposed >= load; });
    loads.push_back({pressed_place(tissue.built), {0, 0, -load}, 0, std::max(kLeastRamp, full->time)});
  }
  const Result<scenes::BuiltScene> built = build(tissue, material, tick_of(measurement), loads);
  if (!built) return std::nullopt;
  const auto c = std::size_t(built->probe_sphere[0]);
  const Vec3 place = pressed_place(*built);
  return run_over_time(
      built->model, rows, [&](double time) { return is_creep ? Inputs{} : pressed_to(place, depth_at(rows, time)); },
      [&](const State& state, const stepping::StepReport& report) {
        return is_creep ? 1e3 * (place.z - state.position.z[c]) : report.tool_force.z;
      });
}

}  // namespace ctpm::calibrate
