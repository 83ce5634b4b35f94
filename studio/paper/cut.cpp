// Figs. 12 to 14: a kidney is cut along its top, and four points beside the cut are tracked.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/stepping/step.h"
#include "scenes/script.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/paper/jobs.h"
#include "studio/paper/paper.h"
#include "studio/paper/pictures.h"

namespace ctpm::paper {
namespace {

/// A run: a model, with or without tension in the capsule.
struct CutCase {
  Variant variant;
  bool has_tension;
  bool is_check = false;  ///< with leapfrog, to see what the integrator decides
};
constexpr Variant kMassSpringVariant{"mass-spring", network::Structure::mass_spring, false, ""},
    kCtpmVariant{"CTPM", network::Structure::ctpm, false, "kPa s"};
// Those that take longest come first, because two threads share the runs.
constexpr CutCase kCases[] = {{kCtpmVariant, true},
                              {kCtpmVariant, false},
                              {{"CTPM", network::Structure::ctpm, true, "Pa s"}, true},
                              {{"damped mass-spring", network::Structure::mass_spring, false, "kPa s", 1, true}, true},
                              {kMassSpringVariant, true},
                              {kMassSpringVariant, false},
                              {kMassSpringVariant, true, true}};
constexpr std::size_t kCtpm = 0, kCtpmLoose = 1, kCtpmPaS = 2, kWithDashpots = 3, kMassSpring = 4, kMassSpringLoose = 5,
                      kLeapfrog = 6;

/// The scene's probes: A and B are on one side of the cut, C and D on the other.
constexpr const char* kProbes[] = {"A", "B", "C", "D"};
constexpr int kSeconds = 8;
constexpr std::int32_t kSubsteps = 10;

struct CutRun {
  std::array<std::array<Vec3, kSeconds>, 4> place;  ///< displacement of A to D by the cut, 1 s to 8 s after it [mm]
  std::array<std::vector<Vec3>, 4> way;             ///< the same, every 10 ms from 1 s to 8 s after it [mm]
  std::array<double, 2> gap_before{};               ///< A to C and B to D, at rest [mm]
  std::array<double, 2> gap_after{};                ///< the same, mean from 1 s to 8 s after the cut [mm]
  reports::Series way_of_a;                         ///< y of A over the time after the cut [s], [mm]
  std::int32_t severed = 0;                         ///< elements
  State state;                                      ///< 1 s after the cut
  Model model;

  double opening(std::size_t side) const { return gap_after[side] - gap_before[side]; }
};

Result<CutRun> run_kidney(const loading::LoadedScene& scene, const scenes::Script& script, const CutCase& which) {
  Result<scenes::BuiltScene> built = build_variant(scene, which.variant, [&](scenes::SceneSpec& s) {
    if (which.is_check) s.solver.integrator = scenes::IntegratorSpec::leapfrog;
    s.solver.tolerance = 1e-6, s.solver.velocity_floor = 1e-10;
    // A step of a whole tick would damp the motion of interest.
    s.solver.substeps = kSubsteps;
    if (!which.has_tension)
      for (scenes::LayerSpec& layer : s.organs[0].layers) layer.material.prestrain = 0;
  });
  if (!built) return built.errors();
  CutRun run;
  run.model = std::move(built->model);
  const Model& model = run.model;
  const std::string name = scene.path + ", " + full_name(which.variant);
  Result<State> start = settled(model, name);
  if (!start) return start.errors();
  State state = std::move(*start);
  stepping::Stepper stepper(model);
  const scenes::ScriptPlayer player(script, model.tools, model.tick);
  const auto at = [&](std::size_t probe) { return state.position[std::size_t(built->probe_sphere[probe])]; };
  const auto gap = [&](std::size_t side) { return 1e3 * norm(at(side) - at(side + 2)); };
  std::array<Vec3, 4> before;
  for (std::size_t p = 0; p < 4; ++p) before[p] = at(p);
  run.gap_before = {gap(0), gap(1)};
  std::int64_t cut_ends = 0;
  const auto per_second = std::int64_t(std::lround(1 / model.tick));
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
    const stepping::StepReport report = stepper.step(state, player.at(tick));
    if (stepping::is_refused(report.status))
      return Error{name, "the run diverged at sphere " + std::to_string(report.worst_sphere), ""};
    run.severed += report.severed;
    if (report.severed > 0) cut_ends = tick, run.way_of_a = {}, run.way = {}, run.gap_after = {};
    const std::int64_t since = tick - cut_ends;
    if (run.severed == 0) continue;
    if (since % 10 == 0)
      run.way_of_a.x.push_back(double(since) * model.tick), run.way_of_a.y.push_back(1e3 * (at(0).y - before[0].y));
    if (since >= per_second && since <= kSeconds * per_second && since % 10 == 0)
      for (std::size_t p = 0; p < 4; ++p) run.way[p].push_back(1e3 * (at(p) - before[p]));
    if (since == 0 || since % per_second != 0) continue;
    const auto second = std::size_t(since / per_second - 1);
    if (second >= kSeconds) break;
    for (std::size_t p = 0; p < 4; ++p) run.place[p][second] = 1e3 * (at(p) - before[p]);
    for (std::size_t side = 0; side < 2; ++side) run.gap_after[side] += gap(side) / kSeconds;
    if (second == 0) run.state = state;
  }
  if (run.severed == 0) return Error{name, "the script's cut severs nothing", ""};
  run.way_of_a.name = full_name(which.variant);
  return run;
}

Vec3 mean_of(std::span<const Vec3> places) {
  Vec3 middle;
  for (const Vec3& p : places) middle += p / double(places.size());
  return middle;
}

/// Root mean square distance in y and z of a point's positions from their mean [mm].
double spread(std::span<const Vec3> places) {
  const Vec3 middle = mean_of(places);
  double sum = 0;
  for (const Vec3& p : places) sum += (p.y - middle.y) * (p.y - middle.y) + (p.z - middle.z) * (p.z - middle.z);
  return std::sqrt(sum / double(places.size()));
}

/// Largest displacement along the cut of a point's eight positions [mm].
double largest_x(const std::array<Vec3, kSeconds>& places) {
  double largest = 0;
  for (const Vec3& p : places) largest = std::max(largest, std::abs(p.x));
  return largest;
}

/// Range of a series from `from` to `to` [s], peak to peak.
double range_of(const reports::Series& series, double from, double to) {
  double low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (series.x[i] >= from && series.x[i] <= to) low = std::min(low, series.y[i]), high = std::max(high, series.y[i]);
  return high - low;
}

constexpr std::pair<std::size_t, int> kPlotted[] = {
    {kMassSpring, 1}, {kCtpmPaS, 4}, {kWithDashpots, 2}, {kCtpm, 0}};  // run, colour

/// Fig. 14: one point in y and z.
reports::Plot place_plot(std::size_t probe, const std::vector<CutRun>& runs) {
  reports::Plot plot{.title = std::string("point ") + kProbes[probe] + ", each second from 1 s to 8 s after the cut",
                     .x_title = "y from before the cut [mm]",
                     .y_title = "z from before the cut [mm]"};
  for (const auto& [run, colour] : kPlotted) {
    reports::Series series{.name = runs[run].way_of_a.name, .stroke = reports::Stroke::path, .colour = colour};
    for (const Vec3& p : runs[run].place[probe]) series.x.push_back(p.y), series.y.push_back(p.z);
    plot.series.push_back(series);
  }
  return plot;
}

std::string tension_of(std::size_t i) { return kCases[i].has_tension ? "yes" : "no"; }

reports::Table place_table(const std::vector<CutRun>& runs) {
  reports::Table table;
  table.title = "Places of the points from 1 s to 8 s after the cut";
  table.columns = {{"model", "model"},
                   {"viscosity", "viscosity"},
                   {"capsule_tension", "capsule under tension"},
                   {"integrator", "integrator"},
                   {"point", "point"},
                   {"y_1s_mm", "y at 1 s [mm]"},
                   {"z_1s_mm", "z at 1 s [mm]"},
                   {"y_8s_mm", "y at 8 s [mm]"},
                   {"z_8s_mm", "z at 8 s [mm]"},
                   {"spread_mm", "spread of the 8 places [mm]", 2},
                   {"way_spread_mm", "spread all the while [mm]", 2},
                   {"x_mm", "largest move along x [mm]", 2}};
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::size_t p = 0; p < 4; ++p) {
      const Vec3 first = runs[i].place[p].front(), last = runs[i].place[p].back();
      table.rows.push_back({std::string(kCases[i].variant.name), std::string(kCases[i].variant.reading), tension_of(i),
                            std::string(stepping::name_of(runs[i].model.solver.integrator)), std::string(kProbes[p]),
                            first.y, first.z, last.y, last.z, spread(runs[i].place[p]), spread(runs[i].way[p]),
                            largest_x(runs[i].place[p])});
    }
  table.caption =
      "An undamped network is chaotic: with leapfrog, and with any other step, the mass-spring points go other ways. "
      "Their spread is of the same size; their coordinates mean nothing. Eight places are few: the spread all the "
      "while, every 10 ms "
      "from 1 s to 8 s, hardly depends on when one looks.";
  return table;
}

reports::Table gap_table(const std::vector<CutRun>& runs) {
  reports::Table table;
  table.title = "Distance across the cut; after it, the mean of the 8 seconds";
  table.columns = {{"model", "model"},
                   {"viscosity", "viscosity"},
                   {"capsule_tension", "capsule under tension"},
                   {"integrator", "integrator"},
                   {"ac_before_mm", "A to C, before [mm]"},
                   {"ac_after_mm", "after [mm]"},
                   {"bd_before_mm", "B to D, before [mm]"},
                   {"bd_after_mm", "after [mm]"},
                   {"severed", "elements severed"}};
  for (std::size_t i = 0; i < runs.size(); ++i)
    table.rows.push_back({std::string(kCases[i].variant.name), std::string(kCases[i].variant.reading), tension_of(i),
                          std::string(stepping::name_of(runs[i].model.solver.integrator)), runs[i].gap_before[0],
                          runs[i].gap_after[0], runs[i].gap_before[1], runs[i].gap_after[1],
                          std::int64_t(runs[i].severed)});
  return table;
}

std::string millimetres(double value) {
  return std::abs(value) < 1e-3 ? "less than 0.001 mm" : output::short_number(value, 2) + " mm";
}

/// Figs. 12 and 14: mass-spring goes on oscillating, CTPM stays.
void add_motion_claims(Experiment& experiment, const std::vector<CutRun>& runs) {
  Claim claim{.kind = ClaimKind::behaviour, .experiment = "cut", .figure = "Fig. 12", .organ = "kidney"};
  claim.structure = "mass-spring", claim.quantity = "y of A, range from 7 s to 8 s over range from 1 s to 2 s [share]";
  claim.network = range_of(runs[kMassSpring].way_of_a, 7, 8) / range_of(runs[kMassSpring].way_of_a, 1, 2);
  claim.holds = *claim.network >= 0.5, claim.note = "met if half or more: it goes on oscillating";
  experiment.claims.push_back(claim);
  claim.figure = "Fig. 14", claim.structure = "CTPM";
  for (const std::size_t i : {kCtpm, kCtpmPaS})
    for (std::size_t p = 0; p < 4; ++p) {
      const double own = spread(runs[i].place[p]), other = spread(runs[kMassSpring].place[p]);
      claim.viscosity = kCases[i].variant.reading, claim.quantity = std::string("spread of ") + kProbes[p] + " [mm]";
      claim.network = own, claim.holds = own < other,
      claim.note = "met if less than mass-spring's " + millimetres(other);
      experiment.claims.push_back(claim);
    }
}

/// Figs. 13 and 14: the sides separate, and x stays.
void add_place_claims(Experiment& experiment, const std::vector<CutRun>& runs) {
  Claim claim{.kind = ClaimKind::behaviour, .experiment = "cut", .organ = "kidney", .structure = "CTPM"};
  claim.viscosity = "kPa s";
  for (const std::size_t i : {kCtpmLoose, kCtpm})
    for (std::size_t side = 0; side < 2; ++side) {
      const bool has_tension = kCases[i].has_tension;
      const double other = runs[has_tension ? kMassSpring : kMassSpringLoose].opening(side);
      claim.figure = "Fig. 14";
      claim.quantity = std::string("opening between ") + (side == 0 ? "A and C" : "B and D") +
                       (has_tension ? ", capsule under tension" : ", no tension") + " [mm]";
      claim.network = runs[i].opening(side);
      // The tension is our addition, so the paper's claim is not judged by it.
      claim.holds = has_tension ? std::nullopt : std::optional(*claim.network > 0);
      claim.note = std::string(has_tension ? "our addition to the paper" : "met if more than 0: the sides separate") +
                   "; mass-spring: " + millimetres(other);
      experiment.claims.push_back(claim);
    }
  claim.figure = "Fig. 13", claim.holds = {}, claim.network = 0;
  for (const auto& places : runs[kCtpm].place) claim.network = std::max(*claim.network, largest_x(places));
  claim.quantity = "largest move of a point along x [mm]";
  claim.note = "the paper says that x remains unchanged, and not how closely";
  experiment.claims.push_back(claim);
}

Result<Done> add_pictures(reports::Section& section, const loading::LoadedScene& scene,
                          const std::vector<CutRun>& runs) {
  const render::Camera camera{{-0.03, -0.12, 0.15}, {0, -0.004, 0.028}, {0, 0, 1}, 32};
  for (const std::size_t i : {kMassSpring, kCtpm}) {
    const std::string what = "Figs. 12 and 13, " + runs[i].way_of_a.name + ": ";
    const std::string when = " 1 s after the cut.";
    const Result<std::vector<reports::Picture>> pictures =
        draw_shots(scene.scene.spec, scene.organs, runs[i].model, camera,
                   {{.state = runs[i].state, .caption = what + "surface" + when},
                    {.state = runs[i].state, .caption = what + "inside" + when, .is_inside = true}});
    if (!pictures) return pictures.errors();
    section.pictures.insert(section.pictures.end(), pictures->begin(), pictures->end());
  }
  return Done{};
}

/// Smallest and largest spread of the four points, "0.27 mm to 0.46 mm".
std::string spreads(const CutRun& run) {
  double low = INFINITY, high = 0;
  for (const auto& places : run.place) low = std::min(low, spread(places)), high = std::max(high, spread(places));
  return (high < 1e-3 ? "" : millimetres(low) + " to ") + millimetres(high);
}

std::string openings(const CutRun& run) {
  return output::short_number(run.opening(0), 2) + " and " + output::short_number(run.opening(1), 2) + " mm";
}

std::vector<std::string> paragraphs_of(const std::vector<CutRun>& runs, bool settles_as_said) {
  const bool separates = runs[kCtpmLoose].opening(0) > 0 && runs[kCtpmLoose].opening(1) > 0;
  return {
      "The shipped scene of the incision: a kidney under gravity, its lowest spheres anchored. The scalpel of the "
      "shipped script cuts 70 mm along x over its top, 17 mm deep. A and B lie on one side, C and D on the other. Each "
      "is followed once a second from 1 s to 8 s after the last element was severed; larger dots are the places at 1 "
      "s.",
      std::string("All models are integrated alike, with ") + integrator_name() + " and steps of " +
          output::short_number(1e3 * runs[0].model.tick / kSubsteps) +
          " ms; one run of mass-spring with leapfrog, which damps nothing, checks that the integrator decides nothing. "
          "All have the same static stiffness up to the constraint and softening of CTPM, and all are at rest before "
          "the cut, so that only what the cut sets free is seen.",
      "Fig. 12 says that mass-spring goes on oscillating and CTPM remains relatively stable, Fig. 14 that the points "
      "of mass-spring go back and forth without order. On the network the points of mass-spring spread over " +
          spreads(runs[kMassSpring]) + " (with leapfrog " + spreads(runs[kLeapfrog]) + "), those of CTPM over " +
          spreads(runs[kCtpm]) + " with the viscosity in kPa s and " + spreads(runs[kCtpmPaS]) +
          " with Pa s. Without tension in the capsule it is " + spreads(runs[kMassSpringLoose]) +
          " for mass-spring and " + spreads(runs[kCtpmLoose]) + " for CTPM. Both claims are " +
          (settles_as_said ? "met." : "not met at every point."),
      "Is the comparison fair? Mass-spring has no damping at all in the paper (Eq. 1) and nothing that could stop it. "
      "With the dashpot v1 beside every spring (damped mass-spring) its points spread over " +
          spreads(runs[kWithDashpots]) +
          ": dashpots are enough for what Figs. 12 and 14 show, and the structure of CTPM is not needed for it.",
      "Fig. 14 also says that in CTPM the points of both sides separate naturally, by gravity and creep (Fig. 12). "
      "Without tension in the capsule, of which the paper says nothing, the distance between the sides of CTPM changes "
      "by " +
          openings(runs[kCtpmLoose]) +
          (separates ? "." : ": on our kidney they do not separate, and the claim is missed.") +
          " The scene therefore puts the capsule under tension, as our choice; then it changes by " +
          openings(runs[kCtpm]) + ", and that of mass-spring by " + openings(runs[kMassSpring]) +
          ": separation is the tension's doing, and tells no model from the other.",
      "The paper prints neither the size of its kidney and of its cut nor where its points are, and no coordinates but "
      "those in its plots, so only the behaviour can be compared. Its caption of Fig. 14 calls panel (a) B and panel "
      "(b) A; its text calls both A."};
}

}  // namespace

Result<Experiment> run_cut(const std::string& scenes, bool with_pictures) {
  const Result<loading::LoadedScene> scene = load_experiment(scenes, "incision.json");
  if (!scene) return scene.errors();
  const std::string script_file = scenes + "/scripts/incision-cut.json";
  const Result<std::string> text = output::read_text_file(script_file);
  if (!text) return text.errors();
  std::vector<std::string> tools;
  for (const scenes::ToolSpec& tool : scene->scene.spec.tools) tools.push_back(tool.name);
  const Result<scenes::Script> script = scenes::read_script(*text, script_file, tools);
  if (!script) return script.errors();

  const Result<std::vector<CutRun>> all =
      run_jobs<CutRun>(std::size(kCases), [&](std::size_t i) { return run_kidney(*scene, *script, kCases[i]); });
  if (!all) return all.errors();
  const std::vector<CutRun>& runs = *all;

  Experiment experiment;
  reports::Section& section = experiment.section;
  section.key = "cut", section.title = "A kidney is cut, mass-spring against CTPM: Figs. 12 to 14";
  for (std::size_t p = 0; p < 4; ++p) section.plots.push_back(place_plot(p, runs));
  reports::Plot ways{.title = "y of point A after the cut",
                     .x_title = "time after the cut [s]",
                     .y_title = "y from before the cut [mm]"};
  for (const auto& [run, colour] : kPlotted)
    ways.series.push_back(runs[run].way_of_a), ways.series.back().colour = colour;
  section.plots.push_back(ways);
  section.tables = {place_table(runs), gap_table(runs)};
  add_motion_claims(experiment, runs);
  const bool settles_as_said = count_claims(experiment.claims, ClaimKind::behaviour).missed == 0;
  add_place_claims(experiment, runs);
  section.paragraphs = paragraphs_of(runs, settles_as_said);
  if (with_pictures)
    if (const Result<Done> drawn = add_pictures(section, *scene, runs); !drawn) return drawn.errors();
  return experiment;
}

}  // namespace ctpm::paper
