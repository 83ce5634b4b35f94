// Figs. 9 to 11: a force on one surface sphere of a liver block, and a ball on the liver.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/stepping/step.h"
#include "studio/output/number_text.h"
#include "studio/paper/jobs.h"
#include "studio/paper/paper.h"
#include "studio/paper/pictures.h"

namespace ctpm::paper {
namespace {

constexpr Variant kVariants[] = {{"mass-spring", network::Structure::mass_spring, false, ""},
                                 {"damped mass-spring", network::Structure::mass_spring, false, "kPa s", 1, true},
                                 {"damped mass-spring", network::Structure::mass_spring, true, "Pa s", 1, true},
                                 {"angle mass-spring", network::Structure::angle_mass_spring, false, ""},
                                 {"TPM", network::Structure::tpm, false, "kPa s", kTpmStiffness},
                                 {"TPM", network::Structure::tpm, true, "Pa s", kTpmStiffness},
                                 {"CTPM", network::Structure::ctpm, false, "kPa s"},
                                 {"CTPM", network::Structure::ctpm, true, "Pa s"}};
constexpr std::size_t kMassSpring = 0, kWithDashpots = 1, kCtpm = 6, kCtpmPaS = 7;

/// How a run of the block is integrated.
struct Stepping {
  scenes::IntegratorSpec integrator = kIntegrator;
  int finer = 1;  ///< divides the scene's substep
};

/// A run of the block.
struct LoadRun {
  reports::Series depth;  ///< of the loaded sphere over time [s], [mm]
  double rest = 0;        ///< static depth [mm]
  StepResponse motion;
  double step = 0;  ///< substep [ms]
  std::string integrator;
};

constexpr double kDuration = 1.0;  ///< [s]

Result<LoadRun> run_block(const loading::LoadedScene& scene, const Variant& variant, bool is_sudden,
                          const Stepping& how) {
  const Result<scenes::BuiltScene> built = build_variant(scene, variant, [&](scenes::SceneSpec& s) {
    s.solver.integrator = how.integrator;
    s.solver.substeps = how.finer * s.solver.substeps.value_or(1);
    if (is_sudden) s.loads[0].ramp = 0;
  });
  if (!built) return built.errors();
  const Model& model = built->model;
  const auto c = std::size_t(built->probe_sphere[0]);
  const auto depth = [&](const State& state) { return 1e3 * (model.rest_position.z[c] - state.position.z[c]); };
  const Result<double> rest = at_rest(model, scene.path + ", " + full_name(variant), depth);
  if (!rest) return rest.errors();
  stepping::Stepper stepper(model);
  LoadRun run;
  run.depth.name = full_name(variant), run.rest = *rest;
  run.integrator = stepping::name_of(model.solver.integrator), run.step = 1e3 * model.tick / model.solver.substeps;
  State state = rest_state(model);
  const auto ticks = std::int64_t(std::lround(kDuration / model.tick));
  for (std::int64_t tick = 1; tick <= ticks; ++tick) {
    const stepping::StepReport report = stepper.step(state, Inputs{});
    if (report.status != stepping::StepStatus::ok)
      return Error{scene.path,
                   full_name(variant) + ": the run diverged at sphere " + std::to_string(report.worst_sphere), ""};
    run.depth.x.push_back(double(tick) * model.tick), run.depth.y.push_back(depth(state));
  }
  run.motion = step_response_of(run.depth, run.rest);
  return run;
}

/// All variants.
Result<std::vector<LoadRun>> run_variants(const loading::LoadedScene& scene, bool is_sudden) {
  return run_jobs<LoadRun>(std::size(kVariants),
                           [&](std::size_t i) { return run_block(scene, kVariants[i], is_sudden, {}); });
}

/// The integrators and steps beside kIntegrator and the scene's step, to see what they decide.
constexpr struct {
  std::size_t variant;
  Stepping how;
} kChecks[] = {{kMassSpring, {kIntegrator, 1}},
               {kMassSpring, {kIntegrator, 2}},
               {kMassSpring, {scenes::IntegratorSpec::leapfrog, 1}},
               {kMassSpring, {scenes::IntegratorSpec::backward_euler, 1}},
               {kCtpm, {kIntegrator, 1}},
               {kCtpm, {kIntegrator, 2}},
               {kCtpm, {scenes::IntegratorSpec::backward_euler, 1}}};

/// The sudden load under other integrators and steps.
Result<reports::Table> check_integrators(const loading::LoadedScene& scene) {
  const Result<std::vector<LoadRun>> runs = run_jobs<LoadRun>(std::size(kChecks), [&](std::size_t i) {
    return run_block(scene, kVariants[kChecks[i].variant], true, kChecks[i].how);
  });
  if (!runs) return runs.errors();
  reports::Table table;
  table.title = "What the integrator and the step decide, load sudden";
  table.columns = {{"model", "model"},
                   {"integrator", "integrator"},
                   {"step_ms", "step [ms]"},
                   {"overshoot_percent", "overshoot [%]", 3},
                   {"reversals", "direction reversals in 1 s"},
                   {"late_swing_percent", "largest swing after 0.5 s [% of rest]", 3}};
  for (std::size_t i = 0; i < runs->size(); ++i) {
    const LoadRun& run = (*runs)[i];
    table.rows.push_back({full_name(kVariants[kChecks[i].variant]), run.integrator, run.step,
                          100 * run.motion.overshoot, std::int64_t(run.motion.reversals), 100 * run.motion.late_swing});
  }
  table.caption =
      "Half the step changes next to nothing, and leapfrog, which damps nothing, gives mass-spring the same motion: "
      "numerical damping decides nothing here. Under backward Euler it would.";
  return table;
}

reports::Table motion_table(const std::string& title, const std::vector<LoadRun>& runs) {
  reports::Table table;
  table.title = title;
  table.columns = {{"model", "model"},
                   {"viscosity", "viscosity"},
                   {"stiffness_factor", "factor on its moduli"},
                   {"rest_mm", "static depth [mm]", 4},
                   {"after_1s_mm", "depth after 1 s [mm]", 4},
                   {"overshoot_percent", "overshoot [%]", 3},
                   {"reversals", "direction reversals in 1 s"},
                   {"late_swing_percent", "largest swing after 0.5 s [% of rest]", 3},
                   {"settling_s", "settled to 5 % after [s]", 3}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const StepResponse& m = runs[i].motion;
    table.rows.push_back({std::string(kVariants[i].name), std::string(kVariants[i].reading), kVariants[i].stiffness,
                          runs[i].rest, runs[i].depth.y.back(), 100 * m.overshoot, std::int64_t(m.reversals),
                          100 * m.late_swing, m.settling_time});
  }
  return table;
}

/// What Fig. 11 says of CTPM, against mass-spring under the same load.
void add_claims(Experiment& experiment, const std::vector<LoadRun>& runs, const std::string& how) {
  constexpr double kCreeps = 0.02;  // largest overshoot of a response that is called creep [share of rest]
  const StepResponse& other = runs[kMassSpring].motion;
  for (const std::size_t i : {kCtpm, kCtpmPaS}) {
    const StepResponse& own = runs[i].motion;
    const auto add = [&](const std::string& quantity, double value, bool holds, const std::string& note) {
      experiment.claims.push_back({.kind = ClaimKind::behaviour,
                                   .experiment = "load",
                                   .figure = "Fig. 11",
                                   .organ = "liver block",
                                   .structure = "CTPM",
                                   .viscosity = kVariants[i].reading,
                                   .quantity = quantity + ", load " + how,
                                   .network = value,
                                   .holds = holds,
                                   .note = note});
    };
    const auto than = [&](double value) { return "met if less than mass-spring's " + output::short_number(value, 4); };
    add("overshoot [share of rest]", own.overshoot, own.overshoot < other.overshoot, than(other.overshoot));
    add("largest swing after 0.5 s [share of rest]", own.late_swing, own.late_swing < other.late_swing,
        than(other.late_swing));
    add("direction reversals in 1 s", own.reversals, own.reversals < other.reversals, than(other.reversals));
    add("overshoot of 2 % at most [share of rest]", own.overshoot, own.overshoot <= kCreeps, "met if it creeps");
  }
}

/// One kind of load: plots, a table, and the claims.
void add_runs(Experiment& experiment, const std::vector<LoadRun>& runs, const std::string& how) {
  reports::Section& section = experiment.section;
  const auto plot_of = [&](const std::string& title, std::initializer_list<std::pair<std::size_t, int>> shown) {
    reports::Plot plot{.title = title, .x_title = "time [s]", .y_title = "depth [mm]"};
    for (const auto& [run, colour] : shown) plot.series.push_back(runs[run].depth), plot.series.back().colour = colour;
    section.plots.push_back(plot);
  };
  plot_of("depth of the loaded sphere, load " + how, {{kMassSpring, 1}, {kCtpmPaS, 4}, {kWithDashpots, 2}, {kCtpm, 0}});
  plot_of("the other models, load " + how, {{3, 2}, {2, 1}, {5, 4}, {4, 0}});
  section.tables.push_back(motion_table(
      "0.13 N, load " + how + ", " + integrator_name() + ", steps of " + output::short_number(runs[0].step) + " ms",
      runs));
  add_claims(experiment, runs, how);
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
  // A step of a whole tick would damp the motion of interest.
  model.solver.substeps = 10;
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
  Result<scenes::BuiltScene> built = build_variant(scene, variant, [](scenes::SceneSpec& s) { s.loads.clear(); });
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
    const Result<State> state = settled(*model, scene->path);
    if (!state) return state.errors();
    const Result<Press> press = press_and_leave(*model, scene->path, *state, fitted->place, 9e-3);
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

StepResponse step_response_of(const reports::Series& series, double rest) {
  StepResponse motion;
  const std::vector<double>& y = series.y;
  motion.overshoot = std::max(0.0, *std::max_element(y.begin(), y.end()) / rest - 1);
  double extreme = y.front(), last_turn = y.front();
  bool is_rising = true;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (std::abs(y[i] - rest) > 0.05 * std::abs(rest)) motion.settling_time = series.x[i];
    if (is_rising ? y[i] > extreme : y[i] < extreme) extreme = y[i];
    if (std::abs(y[i] - extreme) <= 1e-3 * std::abs(rest)) continue;
    if (motion.reversals > 0 && 2 * i >= y.size())
      motion.late_swing = std::max(motion.late_swing, std::abs((extreme - last_turn) / rest));
    ++motion.reversals, is_rising = !is_rising, last_turn = extreme, extreme = y[i];
  }
  return motion;
}

namespace {

/// What the two loads show, in numbers of this run.
std::vector<std::string> findings(const std::vector<LoadRun>& approached, const std::vector<LoadRun>& sudden) {
  const auto percent = [](double share) { return output::short_number(100 * share, 2) + " %"; };
  const auto count = [](const LoadRun& run) { return std::to_string(run.motion.reversals); };
  const auto both = [&](const std::vector<LoadRun>& runs, const auto& value) {
    return value(runs[kCtpm]) + " for CTPM against " + value(runs[kMassSpring]) + " for mass-spring";
  };
  const auto overshoot = [&](const LoadRun& run) { return percent(run.motion.overshoot); };
  const auto swing = [&](const LoadRun& run) { return percent(run.motion.late_swing); };
  const bool turns_less = sudden[kCtpm].motion.reversals < sudden[kMassSpring].motion.reversals;
  return {
      "Fig. 11 says that mass-spring has very obvious fluctuations and that CTPM creeps. With the viscosity in kPa s "
      "the overshoot under the sudden load is " +
          both(sudden, overshoot) + ", and the largest swing after 0.5 s " + both(sudden, swing) +
          ". The number of reversals is " + both(sudden, count) + ": that CTPM turns round less often " +
          (turns_less ? "holds. " : "does not hold; what it does is swing by less. ") +
          "With the load that comes at 4 mm/s the overshoot is " + both(approached, overshoot) + ", the reversals " +
          both(approached, count) + ".",
      "With the viscosity in Pa s, as printed, CTPM overshoots the sudden load by " + overshoot(sudden[kCtpmPaS]) +
          ", hardly less than mass-spring: only the reading in kPa s gives Fig. 11.",
      "Dashpots are enough for a creep without overshoot: damped mass-spring, with the dashpot v1 beside every spring, "
      "overshoots by " +
          overshoot(sudden[kWithDashpots]) + " and turns round " + count(sudden[kWithDashpots]) +
          " times. The paper gives its mass-spring network no damping at all (Eq. 1), so its Fig. 11 compares a damped "
          "network with an undamped one, and not one structure with another."};
}

}  // namespace

Result<Experiment> run_load(const std::string& scenes, bool with_pictures) {
  Experiment experiment;
  reports::Section& section = experiment.section;
  section.key = "load", section.title = "A force on one surface sphere, mass-spring against CTPM: Figs. 9 to 11";
  const Result<loading::LoadedScene> scene = load_experiment(scenes, "paper/block-liver.json");
  if (!scene) return scene.errors();
  const Result<std::vector<LoadRun>> approached = run_variants(*scene, false);
  if (!approached) return approached.errors();
  const Result<std::vector<LoadRun>> sudden = run_variants(*scene, true);
  if (!sudden) return sudden.errors();
  Result<reports::Table> checks = check_integrators(*scene);
  if (!checks) return checks.errors();
  add_runs(experiment, *approached, "approached at 4 mm/s"), add_runs(experiment, *sudden, "sudden");
  section.tables.push_back(std::move(*checks));
  if (with_pictures) {
    if (const Result<Done> drawn = add_block_pictures(section, *scene); !drawn) return drawn.errors();
    if (const Result<Done> drawn = add_liver_pictures(section, scenes); !drawn) return drawn.errors();
  }
  section.paragraphs = {
      "0.13 N pulls the middle surface sphere of a 9 x 9 x 7 block down, with the paper's liver moduli, no gravity, "
      "the lowest spheres anchored. The paper lets the load come at 4 mm/s; it is read as a load that grows to its "
      "full size in the time in which 4 mm/s cover the depth at rest, 82 ms. A sudden load is shown beside it.",
      std::string("All models are integrated alike, with ") + integrator_name() +
          ", and compared at equal static stiffness: a spring of mass-spring is 2 P2, which is K1 and K2 themselves "
          "where they are equal, as in the paper's organs, and the moduli and the viscosity of TPM are doubled (two "
          "TPMs one behind the other are P2 / 2 over the two spacings over which a triple is P2). Angle mass-spring "
          "has no such factor: its angle springs resist the dent of a single sphere and not the stretch of the block. "
          "The static depths in the tables show what is left: the constraint and the softening of CTPM, and the "
          "two-sphere TPM in which its lines of an even number of spheres end. Overshoot is a share of each model's "
          "own static depth; a reversal counts beyond 0.1 % of it."};
  for (const std::string& finding : findings(*approached, *sudden)) section.paragraphs.push_back(finding);
  section.paragraphs.push_back(
      "The pictures are what Figs. 9 and 10 show, and no number of them is printed: both models just after a ball is "
      "taken away, when they differ most. Mass-spring has swung beyond its rest, CTPM still has the ball's mark and "
      "comes back slowly.");
  return experiment;
}

}  // namespace ctpm::paper
