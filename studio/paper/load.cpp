// Figs. 9 to 11: a force on one surface sphere of a liver block, and a ball on the liver.

#include <algorithm>
#include <cmath>
#include <future>

#include "core/stepping/step.h"
#include "studio/output/number_text.h"
#include "studio/paper/paper.h"
#include "studio/paper/pictures.h"

namespace ctpm::paper {
namespace {

constexpr Variant kVariants[] = {{"mass-spring", network::Structure::mass_spring, false, ""},
                                 {"angle mass-spring", network::Structure::angle_mass_spring, false, ""},
                                 {"TPM", network::Structure::tpm, false, "kPa s"},
                                 {"TPM", network::Structure::tpm, true, "Pa s"},
                                 {"CTPM", network::Structure::ctpm, false, "kPa s"},
                                 {"CTPM", network::Structure::ctpm, true, "Pa s"}};
constexpr std::size_t kMassSpring = 0, kCtpm = 4;

/// A run of the block.
struct LoadRun {
  reports::Series depth;   ///< of the loaded sphere over time [s], [mm]
  std::string integrator;  ///< its Model's own choice
};

constexpr double kDuration = 1.0;  ///< [s]

Result<LoadRun> run_block(const loading::LoadedScene& scene, const Variant& variant, bool is_sudden) {
  const Result<scenes::BuiltScene> built = loading::build_changed(scene, [&](scenes::SceneSpec& s) {
    use_variant(s, variant);
    if (is_sudden) s.loads[0].ramp = 0;
  });
  if (!built) return built.errors();
  const Model& model = built->model;
  const auto c = std::size_t(built->probe_sphere[0]);
  stepping::Stepper stepper(model);
  LoadRun run;
  run.depth.name = full_name(variant), run.integrator = stepping::name_of(stepper.integrator().integrator);
  State state = rest_state(model);
  const auto ticks = std::int64_t(std::lround(kDuration / model.tick));
  for (std::int64_t tick = 1; tick <= ticks; ++tick) {
    const stepping::StepReport report = stepper.step(state, Inputs{});
    if (report.status != stepping::StepStatus::ok)
      return Error{scene.path,
                   full_name(variant) + ": the run diverged at sphere " + std::to_string(report.worst_sphere), ""};
    run.depth.x.push_back(double(tick) * model.tick),
        run.depth.y.push_back(1e3 * (model.rest_position.z[c] - state.position.z[c]));
  }
  return run;
}

/// All variants, two at a time.
Result<std::vector<LoadRun>> run_variants(const loading::LoadedScene& scene, bool is_sudden) {
  std::vector<LoadRun> runs;
  for (std::size_t i = 0; i < std::size(kVariants); i += 2) {
    std::future<Result<LoadRun>> other =
        std::async(std::launch::async, [&] { return run_block(scene, kVariants[i + 1], is_sudden); });
    Result<LoadRun> run = run_block(scene, kVariants[i], is_sudden), second = other.get();
    if (!run) return run.errors();
    if (!second) return second.errors();
    runs.push_back(std::move(*run)), runs.push_back(std::move(*second));
  }
  return runs;
}

reports::Table motion_layout(const std::string& title) {
  reports::Table table;
  table.title = title;
  table.columns = {{"model", "model"},
                   {"viscosity", "viscosity"},
                   {"rest_mm", "depth at rest [mm]", 3},
                   {"overshoot_percent", "overshoot [%]", 3},
                   {"reversals", "direction reversals in 1 s"},
                   {"settling_s", "settled to 5 % after [s]", 3},
                   {"integrator", "integrator"}};
  return table;
}

/// One kind of load: plots, a table, and the claims.
void add_runs(Experiment& experiment, const std::vector<LoadRun>& runs, const std::string& how) {
  reports::Section& section = experiment.section;
  reports::Plot compared{
      .title = "depth of the loaded sphere, load " + how, .x_title = "time [s]", .y_title = "depth [mm]"};
  reports::Plot others = compared;
  others.title = "the other models, load " + how;
  for (const std::size_t i : {std::size_t(0), std::size_t(5), std::size_t(4)}) compared.series.push_back(runs[i].depth);
  compared.series[0].colour = 1, compared.series[1].colour = 4, compared.series[2].colour = 0;
  for (const std::size_t i : {std::size_t(1), std::size_t(3), std::size_t(2)}) others.series.push_back(runs[i].depth);
  others.series[0].colour = 2, others.series[1].colour = 4, others.series[2].colour = 0;
  section.plots.push_back(compared), section.plots.push_back(others);
  reports::Table table = motion_layout("0.13 N, load " + how);
  std::vector<StepResponse> motions;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const StepResponse& m = motions.emplace_back(step_response_of(runs[i].depth));
    table.rows.push_back({std::string(kVariants[i].name), std::string(kVariants[i].reading), m.rest, 100 * m.overshoot,
                          std::int64_t(m.reversals), m.settling_time, runs[i].integrator});
  }
  section.tables.push_back(table);
  Claim claim{.experiment = "load",
              .organ = "liver block",
              .structure = "CTPM against mass-spring",
              .viscosity = "kPa s",
              .quantity = "direction reversals of CTPM, load " + how,
              .network = motions[kCtpm].reversals};
  claim.holds = 2 * motions[kCtpm].reversals < motions[kMassSpring].reversals,
  claim.note = "fewer than half of mass-spring's";
  experiment.claims.push_back(claim);
  claim.quantity = "overshoot of CTPM, load " + how + " [share of rest]", claim.network = motions[kCtpm].overshoot;
  claim.holds = motions[kCtpm].overshoot < 0.02 && motions[kCtpm].overshoot < motions[kMassSpring].overshoot,
  claim.note = "below 2 % and below mass-spring's: it creeps";
  experiment.claims.push_back(claim);
}

/// A ball that arrived at 100 mm/s and stays, and the tissue 20 ms after its sudden removal.
struct Press {
  State under, after;
  double depth = 0;  ///< of the pressed sphere under the ball [mm]
};
constexpr double kLeft = 0.02;  ///< after the ball was taken away [s]

/// Presses the sphere nearest to `place` straight down by `depth` [m] with the Model's first tool.
Result<Press> press_and_leave(Model model, const std::string& name, State state, Vec3 place, double depth) {
  constexpr double kSpeed = 0.1, kHold = 0.3;
  // An implicit step of a whole tick would damp the motion of interest.
  model.solver.substeps = 10;
  stepping::resolve_integrator(model);
  const auto c = std::size_t(scenes::nearest_sphere(model, place));
  const Vec3 touch = state.position[c] + Vec3{0, 0, model.tools[0].radius + model.contact_radius[c]};
  const auto ticks_of = [&](double t) { return std::int64_t(std::lround(t / model.tick)); };
  const std::int64_t down = ticks_of(depth / kSpeed), held = down + ticks_of(kHold), end = held + ticks_of(kLeft);
  stepping::Stepper stepper(model);
  Press press;
  for (std::int64_t tick = 1; tick <= end; ++tick) {
    Inputs inputs;
    if (tick <= held)
      inputs.tool = 0, inputs.position = touch - Vec3{0, 0, depth * std::min(1.0, double(tick) / double(down))};
    if (stepper.step(state, inputs).status == stepping::StepStatus::diverged)
      return Error{name, "the press diverged", ""};
    if (tick == held) press.under = state;
  }
  press.depth = 1e3 * (model.rest_position.z[c] - press.under.position.z[c]);
  press.after = std::move(state);
  return press;
}

/// Adds the pictures of one state, one camera each.
Result<Done> add_shot(reports::Section& section, const loading::LoadedScene& scene,
                      const std::vector<FilledOrgan>& organs, const render::Camera& camera, const PaperShot& shot) {
  Result<std::vector<reports::Picture>> pictures =
      draw_shots(scene.scene.spec, organs, scene.built.model, camera, {shot});
  if (!pictures) return pictures.errors();
  for (reports::Picture& picture : *pictures) section.pictures.push_back(std::move(picture));
  return Done{};
}

/// The Model of a scene in one variant.
Result<Model> model_of(const loading::LoadedScene& scene, const Variant& variant) {
  Result<scenes::BuiltScene> built = loading::build_changed(scene, [&](scenes::SceneSpec& s) {
    use_variant(s, variant);
    s.loads.clear();
  });
  if (!built) return built.errors();
  return std::move(built->model);
}

/// Fig. 9: surface and inside of the block in both models after the ball was removed.
Result<Done> add_block_pictures(reports::Section& section, const loading::LoadedScene& scene) {
  const render::Camera outer{{-0.05, -0.20, 0.16}, {0, 0.002, 0.056}, {0, 0, 1}, 32},
      inner{{-0.03, -0.24, 0.12}, {0, 0, 0.044}, {0, 0, 1}, 32};
  std::vector<FilledOrgan> organs = scene.organs;
  add_box_surface(organs[0], 3);
  for (const std::size_t i : {kMassSpring, kCtpm}) {
    const Result<Model> model = model_of(scene, kVariants[i]);
    if (!model) return model.errors();
    const Result<Press> press =
        press_and_leave(*model, scene.path, rest_state(*model), scene.scene.spec.probes[0].at, 12e-3);
    if (!press) return press.errors();
    const std::string what = "Fig. 9, " + full_name(kVariants[i]) + ": ",
                      when =
                          " 20 ms after a ball that was 12 mm deep is taken away, displacements drawn twice as large";
    const PaperShot surface{.state = press->after, .caption = what + "surface" + when + ".", .exaggeration = 2};
    const PaperShot inside{.state = press->after,
                           .caption = what + "inside" + when + "; the half before the middle is left out.",
                           .is_inside = true,
                           .exaggeration = 2,
                           .from_y = -1e-3};
    if (const Result<Done> added = add_shot(section, scene, organs, outer, surface); !added) return added;
    if (const Result<Done> added = add_shot(section, scene, organs, inner, inside); !added) return added;
  }
  return Done{};
}

/// Fig. 10: the shipped liver under a ball at the point of the stiffness fit, and after the ball's removal.
Result<Done> add_liver_pictures(reports::Section& section, const std::string& scenes) {
  const Result<loading::LoadedScene> scene = load_experiment(scenes, "liver.json");
  if (!scene) return scene.errors();
  const std::optional<scenes::FittedForSpec>& fitted = scene->scene.spec.organs[0].material.fitted_for;
  if (!fitted) return Error{scene->path, "its stiffness scale was fitted for no place", "fit its stiffness"};
  for (const std::size_t i : {kMassSpring, kCtpm}) {
    const Result<Model> model = model_of(*scene, kVariants[i]);
    if (!model) return model.errors();
    State state = rest_state(*model);
    stepping::Stepper(*model).settle(state, std::llround(scene->scene.spec.settle / model->tick));
    const Result<Press> press = press_and_leave(*model, scene->path, state, fitted->place, 9e-3);
    if (!press) return press.errors();
    const std::string what = "Fig. 10, " + full_name(kVariants[i]) + ": the liver ";
    const render::Camera camera{fitted->place + Vec3{-0.03, -0.13, 0.075}, fitted->place, {0, 0, 1}, 32};
    const PaperShot under{.state = press->under,
                          .caption = what + "with a ball " + output::fixed(press->depth, 1) + " mm deep.",
                          .show_tool = true},
        after{.state = press->after,
              .caption = what + "20 ms after the ball is taken away, displacements drawn 3 times as large.",
              .exaggeration = 3};
    for (const PaperShot& shot : {under, after})
      if (const Result<Done> added = add_shot(section, *scene, scene->organs, camera, shot); !added) return added;
  }
  return Done{};
}

}  // namespace

StepResponse step_response_of(const reports::Series& series) {
  StepResponse motion;
  const std::vector<double>& y = series.y;
  const std::size_t tail = y.size() * 3 / 4;
  for (std::size_t i = tail; i < y.size(); ++i) motion.rest += y[i] / double(y.size() - tail);
  motion.overshoot = std::max(0.0, *std::max_element(y.begin(), y.end()) / motion.rest - 1);
  double extreme = y.front();
  bool is_rising = true;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (std::abs(y[i] - motion.rest) > 0.05 * std::abs(motion.rest)) motion.settling_time = series.x[i];
    if (is_rising ? y[i] > extreme : y[i] < extreme) extreme = y[i];
    if (std::abs(y[i] - extreme) <= 1e-3 * std::abs(motion.rest)) continue;
    ++motion.reversals, is_rising = !is_rising, extreme = y[i];
  }
  return motion;
}

Result<Experiment> run_load(const std::string& scenes, bool with_pictures) {
  Experiment experiment;
  reports::Section& section = experiment.section;
  section.key = "load", section.title = "A force on one surface sphere, mass-spring against CTPM: Figs. 9 to 11";
  const Result<loading::LoadedScene> scene = load_experiment(scenes, "paper/block-liver.json");
  if (!scene) return scene.errors();
  for (const bool is_sudden : {false, true}) {
    const Result<std::vector<LoadRun>> runs = run_variants(*scene, is_sudden);
    if (!runs) return runs.errors();
    add_runs(experiment, *runs, is_sudden ? "sudden" : "approached at 4 mm/s");
    if (!is_sudden || !with_pictures) continue;  // once is enough
    if (const Result<Done> drawn = add_block_pictures(section, *scene); !drawn) return drawn.errors();
    if (const Result<Done> drawn = add_liver_pictures(section, scenes); !drawn) return drawn.errors();
  }
  section.paragraphs = {
      "0.13 N pulls the middle surface sphere of a 9 x 9 x 7 block down, with the paper's liver moduli as "
      "they are (stiffness_scale 1), no gravity, the lowest spheres anchored. The paper lets the load come "
      "at 4 mm/s; it is read as a load that grows to its full size in the time in which 4 mm/s cover the "
      "depth at rest, 82 ms. A sudden load is shown beside it.",
      "Mass-spring overshoots and goes on swinging; CTPM with the viscosity in kPa s creeps to its depth. "
      "With Pa s, as printed, CTPM swings as well: only one reading of the viscosity gives the paper's Fig. "
      "11. "
      "A reversal counts when the sphere swings back by more than 0.1 % of its depth at rest. Steps are 0.1 "
      "ms "
      "or shorter; each Model's integrator stands in the table: leapfrog damps nothing, backward "
      "Euler "
      "damps fast oscillations a little itself.",
      "The pictures show both models just after a ball is taken away, when they differ most: mass-spring has "
      "swung beyond its rest, CTPM still has the ball's mark and comes back slowly."};
  return experiment;
}

}  // namespace ctpm::paper
