// Figs. 12 to 14: a kidney is cut along its top, and four points beside the cut are tracked.

#include <array>
#include <cmath>
#include <future>

#include "core/stepping/step.h"
#include "scenes/script.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/paper/paper.h"
#include "studio/paper/pictures.h"

namespace ctpm::paper {
namespace {

constexpr Variant kVariants[] = {{"mass-spring", network::Structure::mass_spring, false, ""},
                                 {"CTPM", network::Structure::ctpm, false, "kPa s"},
                                 {"CTPM", network::Structure::ctpm, true, "Pa s"}};
constexpr std::size_t kMassSpring = 0, kCtpm = 1;

/// The scene's probes: A and B are on one side of the cut, C and D on the other.
constexpr const char* kProbes[] = {"A", "B", "C", "D"};
constexpr int kSeconds = 8;
constexpr std::int32_t kSubsteps = 20;

struct CutRun {
  std::array<std::array<Vec3, kSeconds>, 4> place;  ///< displacement of A to D by the cut, 1 s to 8 s after it [mm]
  std::array<double, 2> gap_before, gap_after;      ///< A to C and B to D [mm]
  reports::Series way_of_a;                         ///< y of A over the time after the cut [s], [mm]
  State state;                                      ///< 1 s after the cut
  Model model;
  std::string integrator;  ///< the Model's own choice
};

Result<CutRun> run_kidney(const loading::LoadedScene& scene, const scenes::Script& script, const Variant& variant) {
  Result<scenes::BuiltScene> built = loading::build_changed(scene, [&](scenes::SceneSpec& s) {
    use_variant(s, variant);
    s.solver.tolerance = 1e-6, s.solver.velocity_floor = 1e-10;
  });
  if (!built) return built.errors();
  CutRun run;
  run.model = std::move(built->model);
  Model& model = run.model;
  State state = rest_state(model);
  stepping::Stepper(model).settle(state, std::llround(3 / model.tick));
  // Small steps from here on, because an implicit step of a whole tick would damp the motion of interest.
  model.solver.substeps = kSubsteps;
  stepping::resolve_integrator(model);
  stepping::Stepper stepper(model);
  run.integrator = stepping::name_of(stepper.integrator().integrator);
  const scenes::ScriptPlayer player(script, model.tools, model.tick);
  const auto at = [&](std::size_t probe) { return state.position[std::size_t(built->probe_sphere[probe])]; };
  std::array<Vec3, 4> before;
  for (std::size_t p = 0; p < 4; ++p) before[p] = at(p);
  std::int64_t cut_ends = 0;
  std::int32_t severed = 0;
  const auto per_second = std::int64_t(std::lround(1 / model.tick));
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
    const stepping::StepReport report = stepper.step(state, player.at(tick));
    if (stepping::is_refused(report.status))
      return Error{scene.path,
                   full_name(variant) + ": the run diverged at sphere " + std::to_string(report.worst_sphere), ""};
    severed += report.severed;
    if (report.severed > 0) cut_ends = tick, run.way_of_a = {};
    const std::int64_t since = tick - cut_ends;
    if (severed == 0) continue;
    if (since % 10 == 0)
      run.way_of_a.x.push_back(double(since) * model.tick), run.way_of_a.y.push_back(1e3 * (at(0).y - before[0].y));
    if (since == 0 || since % per_second != 0) continue;
    const auto second = std::size_t(since / per_second - 1);
    if (second >= kSeconds) break;
    for (std::size_t p = 0; p < 4; ++p) run.place[p][second] = 1e3 * (at(p) - before[p]);
    if (second == 0) run.state = state;
  }
  if (severed == 0) return Error{scene.path, "the script's cut severs nothing", ""};
  for (std::size_t side = 0; side < 2; ++side)
    run.gap_before[side] = 1e3 * norm(before[side] - before[side + 2]),
    run.gap_after[side] = 1e3 * norm(at(side) - at(side + 2));
  run.way_of_a.name = full_name(variant);
  return run;
}

/// Root mean square distance in y and z of a point's eight positions from their mean [mm].
double spread(const std::array<Vec3, kSeconds>& places) {
  Vec3 middle;
  for (const Vec3& p : places) middle += p / double(kSeconds);
  double sum = 0;
  for (const Vec3& p : places) sum += (p.y - middle.y) * (p.y - middle.y) + (p.z - middle.z) * (p.z - middle.z);
  return std::sqrt(sum / kSeconds);
}

/// Fig. 14: one point of both models in y and z.
reports::Plot place_plot(std::size_t probe, const std::array<CutRun, 3>& runs) {
  reports::Plot plot{.title = std::string("point ") + kProbes[probe] + ", each second from 1 s to 8 s after the cut",
                     .x_title = "y from before the cut [mm]",
                     .y_title = "z from before the cut [mm]"};
  constexpr int kColours[] = {1, 0, 4};
  for (const std::size_t i : {std::size_t(0), std::size_t(2), std::size_t(1)}) {
    reports::Series series{.name = runs[i].way_of_a.name, .stroke = reports::Stroke::path, .colour = kColours[i]};
    for (const Vec3& p : runs[i].place[probe]) series.x.push_back(p.y), series.y.push_back(p.z);
    plot.series.push_back(series);
  }
  return plot;
}

reports::Table place_table(const std::array<CutRun, 3>& runs) {
  reports::Table table;
  table.title = "Places of the points from 1 s to 8 s after the cut";
  table.columns = {{"model", "model"},
                   {"viscosity", "viscosity"},
                   {"point", "point"},
                   {"y_1s_mm", "y at 1 s [mm]"},
                   {"z_1s_mm", "z at 1 s [mm]"},
                   {"y_8s_mm", "y at 8 s [mm]"},
                   {"z_8s_mm", "z at 8 s [mm]"},
                   {"spread_mm", "spread of the 8 places [mm]", 2},
                   {"gap_before_mm", "across the cut, before [mm]"},
                   {"gap_after_mm", "after [mm]"},
                   {"integrator", "integrator"}};
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::size_t p = 0; p < 4; ++p) {
      const Vec3 first = runs[i].place[p].front(), last = runs[i].place[p].back();
      table.rows.push_back({std::string(kVariants[i].name), std::string(kVariants[i].reading), std::string(kProbes[p]),
                            first.y, first.z, last.y, last.z, spread(runs[i].place[p]), runs[i].gap_before[p % 2],
                            runs[i].gap_after[p % 2], runs[i].integrator});
    }
  return table;
}

void add_claims(Experiment& experiment, const std::array<CutRun, 3>& runs) {
  for (std::size_t p = 0; p < 4; ++p) {
    Claim claim{.experiment = "cut",
                .organ = "kidney",
                .structure = "CTPM against mass-spring",
                .viscosity = "kPa s",
                .quantity = std::string("spread of ") + kProbes[p] + " [mm]",
                .network = spread(runs[kCtpm].place[p])};
    claim.holds = 10 * spread(runs[kCtpm].place[p]) < spread(runs[kMassSpring].place[p]);
    claim.note = "less than a tenth of mass-spring's " + output::short_number(spread(runs[kMassSpring].place[p]), 2) +
                 " mm: it settles where mass-spring wanders";
    experiment.claims.push_back(claim);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    Claim claim{.experiment = "cut",
                .organ = "kidney",
                .structure = "CTPM",
                .viscosity = "kPa s",
                .quantity = std::string("opening between ") + (side == 0 ? "A and C" : "B and D") + " [mm]",
                .network = runs[kCtpm].gap_after[side] - runs[kCtpm].gap_before[side]};
    claim.holds = *claim.network > 0, claim.note = "the banks separate";
    experiment.claims.push_back(claim);
  }
}

Result<Done> add_pictures(reports::Section& section, const loading::LoadedScene& scene,
                          const std::array<CutRun, 3>& runs) {
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

  std::array<CutRun, 3> runs;
  std::future<Result<CutRun>> other =
      std::async(std::launch::async, [&] { return run_kidney(*scene, *script, kVariants[1]); });
  Result<CutRun> first = run_kidney(*scene, *script, kVariants[0]), third = run_kidney(*scene, *script, kVariants[2]),
                 second = other.get();
  Errors errors;
  for (Result<CutRun>* run : {&first, &second, &third}) {
    if (!*run) errors.insert(errors.end(), run->errors().begin(), run->errors().end());
  }
  if (!errors.empty()) return errors;
  runs = {std::move(*first), std::move(*second), std::move(*third)};

  Experiment experiment;
  reports::Section& section = experiment.section;
  section.key = "cut", section.title = "A kidney is cut, mass-spring against CTPM: Figs. 12 to 14";
  for (std::size_t p = 0; p < 4; ++p) section.plots.push_back(place_plot(p, runs));
  reports::Plot ways{.title = "y of point A after the cut",
                     .x_title = "time after the cut [s]",
                     .y_title = "y from before the cut [mm]",
                     .series = {runs[0].way_of_a, runs[2].way_of_a, runs[1].way_of_a}};
  ways.series[0].colour = 1, ways.series[1].colour = 4, ways.series[2].colour = 0;
  section.plots.push_back(ways);
  section.tables = {place_table(runs)};
  add_claims(experiment, runs);
  section.paragraphs = {
      "The shipped scene of the incision: a kidney under gravity, its lowest spheres anchored, whose capsule is under "
      "tension, as our choice, so that the cut gapes. The scalpel of the shipped script cuts 70 mm along x over its "
      "top, "
      "17 mm deep. A and B lie on one bank, C and D on the other. "
      "Each is followed once a second from 1 s to 8 s after the last element was severed; larger dots are "
      "the places at 1 s.",
      "The mass-spring points go on wandering; the CTPM points have moved apart and stay. Steps are 0.05 ms "
      "or "
      "shorter; each Model's integrator stands in the table. "
      "The paper does not say the size of its kidney, of its cut or where its points are, so only the "
      "behaviour can be compared, not the coordinates."};
  if (with_pictures)
    if (const Result<Done> drawn = add_pictures(section, *scene, runs); !drawn) return drawn.errors();
  return experiment;
}

}  // namespace ctpm::paper
