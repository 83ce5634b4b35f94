// A ball that enters a viscoelastic block and stays, against Lee & Radok.

#include <algorithm>
#include <cmath>

#include "studio/fidelity/recipes.h"
#include "studio/fidelity/references.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kHeight = 60e-3, kBall = 20e-3, kDepth = 4e-3;
constexpr double kHold = 1.5;  // [s], 9 time constants: 1e-4 of what relaxes is left
/// Lee & Radok know no inertia: at 4 mm in 5 ms tissue of 1060 kg/m^3 would push back with about its final force (the
/// ball's area times speed times wave impedance), of 1 kg/m^3 with 3 % of it.
constexpr double kDensity = 1;

/// Force [N] of each tick: the depth grows evenly for `ramp` [s] and stays for kHold.
std::vector<double> ramp_and_hold(const Body& body, const PressSite& site, double ramp) {
  stepping::Stepper stepper(body.model);
  State state = rest_state(body.model);
  std::vector<double> forces;
  const auto ticks = std::int64_t(std::llround(ramp / body.model.tick));
  const auto all = ticks + std::int64_t(std::llround(kHold / body.model.tick));
  for (std::int64_t t = 1; t <= all; ++t) {
    const double depth = kDepth * std::min(1.0, double(t) / double(ticks));
    forces.push_back(stepper.step(state, ball_at(0, ball_centre(body, 0, site, depth))).tool_force.z);
  }
  return forces;
}

}  // namespace

Result<RelaxationResult> measure_relaxation(std::span<const double> radii, std::span<const double> ramps) {
  RelaxationResult result;
  for (const double radius : radii) {
    Specimen specimen = block({96e-3, 96e-3, kHeight}, radius, Pace::live, {kBall});
    specimen.friction = 0, specimen.density = kDensity;
    const Result<Body> body = make_body(specimen);
    if (!body) return body.errors();
    std::vector<PressSite> sites;
    for (const double share : {0.0, 0.25, 0.5})
      sites.push_back({{share * body->spacing(), share * body->spacing(), kHeight}, {0, 0, -1}});
    std::vector<std::vector<double>> forces(ramps.size() * sites.size());
    in_parallel(forces.size(), [&](std::size_t job) {
      forces[job] = ramp_and_hold(*body, sites[job % sites.size()], ramps[job / sites.size()]);
    });
    for (std::size_t r = 0; r < ramps.size(); ++r) {
      RelaxationResult::Row row{.radius = radius, .ramp = ramps[r], .ratios = {}, .force = {}};
      const auto end = std::size_t(std::llround(ramps[r] / body->model.tick)) - 1;
      for (std::size_t s = 0; s < sites.size(); ++s) {
        const std::vector<double>& force = forces[r * sites.size() + s];
        row.ratios.push_back(force[end] / force.back());
        row.final_force += force.back() / double(sites.size());
        if (s > 0) continue;
        for (std::size_t t = 0; t < force.size(); t += t < 2 * end + 20 ? 1 : 10)
          row.force.x.push_back(double(t + 1) * body->model.tick), row.force.y.push_back(force[t] / force.back());
      }
      result.rows.push_back(row);
    }
  }
  return result;
}

Chapter chapter_of(const RelaxationResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "relaxation", section.title = "Relaxation under a ball";
  section.paragraphs = {
      "A block of 96 x 96 x 60 mm with the preset's viscosity; a ball of 20 mm enters it without friction by 4 mm, "
      "evenly, and stays for 1.5 s, at three places over a lattice cell. A linear viscoelastic half space with G(t) = "
      "G(inf) (1 + exp(-t / tau)), tau = 1/6 s, has the ratio of Lee & Radok, whatever its modulus. Their theory has "
      "no inertia, so the block here has the density of a gas, 1 kg/m^3."};
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},
                   {"ramp_ms", "ramp [ms]"},
                   {"ratio", "force at its end over final force"},
                   {"least", "least of the places"},
                   {"most", "most"},
                   {"lee_radok", "Lee & Radok"},
                   {"final_n", "mean final force [N]"}};
  reports::Plot plot{
      .title = "force after the ramp of 50 ms", .x_title = "time [s]", .y_title = "force over final force"};
  for (const RelaxationResult::Row& row : result.rows) {
    const auto ramp =
        std::find_if(std::begin(kRamps), std::end(kRamps), [&](const Ramp& r) { return r.time == row.ramp; });
    const Spread spread = spread_of(row.ratios);
    Figure figure{
        .recipe = "relaxation",
        .name = "force at the end of a ramp of " + output::short_number(1e3 * row.ramp) + " ms over final force",
        .radius = row.radius,
        .measured = spread.mean};
    reports::Cell reference;
    if (ramp != std::end(kRamps)) {
      reference = ramp->ratio.value;
      figure.reference = ramp->ratio.value, figure.source = ramp->ratio.source;
      figure.goal = Goal{0.95 * ramp->ratio.value, 1.05 * ramp->ratio.value};
    }
    table.rows.push_back(
        {1e3 * row.radius, 1e3 * row.ramp, spread.mean, spread.least, spread.most, reference, row.final_force});
    chapter.figures.push_back(figure);
    if (row.ramp != 0.05) continue;
    reports::Series series = row.force;
    series.name = "r = " + output::short_number(1e3 * row.radius) + " mm";
    plot.series.push_back(series);
  }
  section.tables = {table};
  if (!plot.series.empty()) {
    reports::Series ideal{.name = "Lee & Radok after the ramp", .stroke = reports::Stroke::dashed};
    for (double t = 0.05; t <= 1.0; t += 0.01)
      ideal.x.push_back(t), ideal.y.push_back(1 + (kRamps[1].ratio.value - 1) * std::exp(-(t - 0.05) / kRelaxation));
    plot.series.push_back(ideal);
    plot.x_range = {{0, 1}};
    section.plots = {plot};
  }
  return chapter;
}

}  // namespace ctpm::fidelity
