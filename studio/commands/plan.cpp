#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/elements/parts.h"
#include "core/model/errors.h"
#include "core/model/fields.h"
#include "core/stepping/step.h"
#include "importers/text.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/script_checks.h"
#include "studio/commands/stop_signal.h"
#include "studio/fidelity/thickness.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/oddities.h"
#include "studio/loading/tick_time.h"
#include "studio/output/files.h"
#include "studio/output/json_writer.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"
#include "studio/session/session_cost.h"

namespace ctpm::commands {
namespace {

struct PlanArguments {
  std::string scene, script;
  bool json = false, is_quick = false;
  scenes::LoadOptions load;
};

/// One feature that a scene may need.
struct Feature {
  std::string name;
  bool is_in = false;
  std::string why;
  std::size_t bytes = 0;  ///< of Model and State together
};

template <class T>
std::size_t bytes_of(const std::vector<T>& array) {
  return array.size() * sizeof(T);
}

/// Bytes of all arrays of a Model or State whose name begins with `prefix`.
template <class Owner>
std::size_t bytes_of_fields(const Owner& owner, std::string_view prefix) {
  std::size_t bytes = 0;
  for_each_field(owner, [&](std::string_view name, const auto& member) {
    if constexpr (requires {
                    member.data();
                    typename std::remove_cvref_t<decltype(member)>::value_type;
                  })
      if (name.starts_with(prefix)) bytes += member.size() * sizeof(*member.data());
  });
  return bytes;
}

/// What of the tissue may sleep.
Feature sleep_of(const Model& model) {
  if (!(model.solver.sleep_bound > 0)) return {"sleep", false, "the scene does not ask for it", 0};
  const std::vector<parallel::SphereRange> parts = elements::parts_of(model);
  std::string words = parts.size() == 1 ? "one part, of " : std::to_string(parts.size()) + " parts, of ";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) words += i + 1 == parts.size() ? " and " : ", ";
    words += std::to_string(parts[i].end - parts[i].begin);
  }
  char bound[96];
  std::snprintf(bound, sizeof bound, " spheres, each while nothing in it is faster than %g mm/s",
                1e3 * model.solver.sleep_bound);
  return {"sleep", true, words + bound, parts.size() * sizeof(std::int32_t)};
}

std::vector<Feature> features_of(const scenes::SceneSpec& scene, const Model& m, const State& s) {
  const auto counted = [](std::size_t count, const char* what, const char* none) {
    return count > 0 ? std::to_string(count) + " " + what : std::string(none);
  };
  const bool cuts = m.has_tool(ToolKind::scalpel);
  const bool limits = std::any_of(scene.organs.begin(), scene.organs.end(), [](const scenes::OrganSpec& organ) {
    return organ.damage_depth > 0 || organ.damage_force > 0;
  });
  const AxialElements& axial = m.axial;
  const std::size_t tpms = axial.internal_count(), springs = axial.size() - tpms;
  const std::size_t internal = bytes_of(axial.kelvin_k) + bytes_of(axial.internal) + bytes_of(s.kelvin_elongation);
  const std::size_t of_axial = bytes_of_fields(m, "axial.") - bytes_of(axial.kelvin_k) - bytes_of(axial.internal) -
                               bytes_of(axial.c) - bytes_of(axial.third);
  return {
      {"spheres", true, std::to_string(m.sphere_count()) + " spheres",
       bytes_of_fields(m, "rest_position") + bytes_of(m.mass) + bytes_of(m.held_axes) + bytes_of(m.contact_radius) +
           bytes_of(m.layer) + bytes_of_fields(m, "cell.") + bytes_of_fields(s, "position") +
           bytes_of_fields(s, "velocity")},
      {"springs and Kelvin units", springs > 0, counted(springs, "elements", "no elements"),
       axial.size() > 0 ? of_axial * springs / axial.size() : 0},
      {"viscosity", !axial.c.empty(), axial.c.empty() ? "no element has a dashpot" : "the material is viscous",
       bytes_of(axial.c)},
      {"two-sphere TPMs", tpms > 0,
       counted(tpms, "with one internal variable each", "no line has an element left over"),
       internal + (axial.size() > 0 ? of_axial * tpms / axial.size() : 0)},
      {"constraint", m.constraints.size() > 0, counted(m.constraints.size(), "five-sphere lines", "the model has none"),
       bytes_of_fields(m, "constraints.")},
      {"softening", m.has_softening,
       m.has_softening ? "forces are divided by 1 + tan(theta)" : "no element tilts or it is switched off",
       bytes_of(axial.third)},
      {"angle springs", m.angle_springs.size() > 0, counted(m.angle_springs.size(), "springs", "the model has none"),
       bytes_of_fields(m, "angle_springs.")},
      {"resistance to inversion", m.tissue_cells.size() > 0,
       counted(m.tissue_cells.size(), "tissue cells", "no organ asks for it"), bytes_of_fields(m, "tissue_cells.")},
      {"gravity", !(m.gravity == Vec3{}), m.gravity == Vec3{} ? "the scene has none" : "the scene asks for it", 0},
      {"ball contact", m.has_tool(ToolKind::ball), m.has_tool(ToolKind::ball) ? "a tool presses" : "no tool presses",
       0},
      {"contact with obstacles", !m.obstacles.empty(), counted(m.obstacles.size(), "obstacles", "the scene has none"),
       bytes_of_fields(m, "obstacles")},
      {"contact of tissue with tissue", m.has_meeting_tissue(),
       m.has_meeting_tissue() ? "organs meet each other or themselves" : "organs pass through each other", 0},
      {"pin", m.has_tool(ToolKind::pin), m.has_tool(ToolKind::pin) ? "a tool holds a sphere" : "no tool holds a sphere",
       0},
      {"cutting", cuts, cuts ? "a tool cuts" : "no tool cuts",
       bytes_of_fields(s, "axial_") + bytes_of_fields(s, "constraint_severed") + bytes_of_fields(s, "angle_severed")},
      {"second hand", m.hands > 1, m.hands > 1 ? "two hands hold tools" : "one hand holds a tool", 0},
      {"loads", m.loads.size() > 0, counted(m.loads.size(), "forces from outside", "no forces from outside"),
       bytes_of_fields(m, "loads.")},
      sleep_of(m),
      {"damage limit", limits, limits ? "an organ has a limit" : "no organ has a limit", 0},
  };
}

/// The integrator and solver of a tick, in words.
std::string solver_of(const Model& model, const stepping::IntegratorChoice& choice) {
  std::string words = stepping::name_of(choice.integrator);
  if (choice.substeps > 1) words += ", " + std::to_string(choice.substeps) + " substeps a tick";
  if (choice.integrator == Integrator::leapfrog) return words;
  const SolverSettings& solver = model.solver;
  char limits[240];
  std::snprintf(limits, sizeof limits,
                ", conjugate gradients to a residual of %g or below %g mm/s (velocity_floor_mm_per_s)",
                solver.tolerance, 1e3 * solver.velocity_floor);
  words += limits;
  if (solver.velocity_enough > solver.velocity_floor) {
    std::snprintf(limits, sizeof limits, " or, after an iteration, %g mm/s (velocity_enough_mm_per_s)",
                  1e3 * solver.velocity_enough);
    words += limits;
  }
  return words + ", whichever is first, at most " + std::to_string(solver.max_iterations) + " iterations";
}

/// Tissue that is thinner than its spheres can carry, and parts without spheres: one warning an organ and kind.
Errors thin_parts_of(const loading::LoadedScene& scene) {
  Errors warnings;
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    const std::string at = "/organs/" + std::to_string(i) + "/fill";
    if (const std::string thin = fidelity::thin_parts_text(scene.organs[i]); !thin.empty())
      warnings.push_back(scene.scene.places.error_at(at, thin, "a smaller radius_mm carries more of it"));
    for (const importers::Finding& finding : scene.reports[i].fill.findings)
      if (finding.code == "flat") warnings.push_back(scene.scene.places.error_at(at, finding.found, finding.remains));
  }
  return warnings;
}

/// That the script of a session never touched or never cut, though it takes up a tool that would.
Errors misses_of(const scenes::Script& script, const session::SessionCost& cost, const Model& model,
                 const std::string& where) {
  const bool takes_blade = std::any_of(script.steps.begin(), script.steps.end(), [&](const scenes::ScriptStep& step) {
    return step.take && std::any_of(model.tools.begin(), model.tools.end(), [&](const Tool& tool) {
             return tool.name == step.take->tool && tool.kind == ToolKind::scalpel;
           });
  });
  Errors misses = find_misses(cost.outcome.statistics, takes_blade, where);
  if (stepping::is_refused(cost.outcome.run.status))
    misses.push_back({where, "the simulation is refused before its end", ""});
  return misses;
}

/// The shape error of each organ that fills a mesh.
void write_shapes(output::JsonWriter& json, const loading::LoadedScene& scene) {
  json.begin_list();
  for (std::size_t i = 0; i < scene.reports.size(); ++i) {
    const importers::ImportReport& report = scene.reports[i];
    if (report.path.empty()) continue;
    json.begin_object().member("organ", scene.scene.spec.organs[i].name);
    json.member("p95_mm", report.fill.shape.p95 * 1e3).member("largest_mm", report.fill.shape.largest * 1e3);
    json.end_object();
  }
  json.end_list();
}

void print_shapes(const loading::LoadedScene& scene) {
  for (std::size_t i = 0; i < scene.reports.size(); ++i)
    if (!scene.reports[i].path.empty())
      print("shape of %s, %s\n", output::printable(scene.scene.spec.organs[i].name).c_str(),
            importers::to_text(scene.reports[i].fill.shape).c_str());
}

/// What is told of a scene.
struct Plan {
  const loading::LoadedScene& scene;
  std::vector<Feature> features;
  std::size_t bytes = 0;  ///< of all features
  Errors thin_parts, oddities;
  double rest = 0;                           ///< median time of a tick at rest [s]
  std::optional<session::SessionCost> cost;  ///< of a session; none where it was not asked for
  std::optional<session::FittingRadius> fitting;

  double tick() const { return scene.built.model.tick; }
  /// Whether what was measured says more than that the rate is held.
  bool is_told() const { return cost && cost->is_own(); }
  bool holds() const { return cost && !stepping::is_refused(cost->outcome.run.status) && cost->dearest() <= tick(); }
};

/// The script that `record` would run: the one that is named, else the default one.
session::ScriptOf script_of(const PlanArguments& arguments) {
  if (arguments.script.empty())
    return [](const loading::LoadedScene& scene) -> Result<scenes::Script> {
      return scenes::default_script(scene.scene.spec, scene.organs);
    };
  return [file = arguments.script](const loading::LoadedScene& scene) { return read_script(file, scene); };
}

/// Runs the session of a plan, and if its ticks are too dear, those of coarser fillings.
Result<Done> measure(const PlanArguments& arguments, Plan& plan) {
  const StopSignal stop;
  const session::ScriptOf script = script_of(arguments);
  session::RunOptions running;
  running.should_stop = [&] { return stop.came(); };
  const auto told = [&](ProgressLine& line) {
    running.progress = [&line](std::int64_t done, std::int64_t total) { line.show(done, total); };
  };
  {
    ProgressLine line("a session");
    told(line);
    Result<session::SessionCost> cost = session::measure_session(plan.scene, script, running);
    if (!cost) return cost.errors();
    plan.cost = *std::move(cost);
  }
  if (plan.holds() || !plan.is_told()) return Done{};
  ProgressLine line("coarser spheres");
  told(line);
  Result<std::optional<session::FittingRadius>> fitting =
      session::find_fitting_radius(plan.scene, arguments.load, script, *plan.cost, running);
  if (!fitting) return fitting.errors();
  plan.fitting = *std::move(fitting);
  return Done{};
}

void write_times(output::JsonWriter& json, const session::SessionCost& cost) {
  json.begin_list();
  for (const session::Deed deed : session::kDeeds)
    json.begin_object()
        .member("deed", std::string_view(session::name_of(deed)))
        .member("ticks", cost.of(deed).ticks)
        .member("p50_s", cost.of(deed).p50)
        .member("p99_s", cost.of(deed).p99)
        .member("own_p99_s", cost.of(deed).own_p99)
        .end_object();
  json.end_list();
}

void write_warnings(output::JsonWriter& json, const Errors& warnings) {
  json.begin_list();
  for (const Error& warning : warnings) json.value(std::string_view(warning.where + ": " + warning.message));
  json.end_list();
}

void print_json(const std::string& path, const Plan& plan, const std::string& solver) {
  const Model& model = plan.scene.built.model;
  output::JsonWriter json;
  json.begin_object().member("scene", path).member("spheres", model.sphere_count());
  json.member("elements", model.element_count()).member("memory_bytes", plan.bytes).member("tick_s", model.tick);
  json.member("tick_time_at_rest_s", plan.rest);
  if (plan.cost) {
    json.member("threads", plan.cost->threads).member("processor_share", plan.cost->processor_share);
    json.member("lost_share", plan.cost->lost_share);
    if (plan.holds() || plan.is_told()) json.member("holds_rate", plan.holds());
    json.key("tick_times");
    write_times(json, *plan.cost);
  }
  if (plan.fitting) {
    json.key("holds_rate_with").begin_object().member("radius_factor", plan.fitting->factor);
    json.member("spheres", plan.fitting->spheres).key("tick_times");
    write_times(json, plan.fitting->cost);
    json.end_object();
  }
  json.member("solver", solver)
      .member("solver_reason", plan.scene.built.integrator.reason)
      .key("features")
      .begin_list();
  for (const Feature& f : plan.features)
    json.begin_object()
        .member("name", f.name)
        .member("is_in", f.is_in)
        .member("why", f.why)
        .member("bytes", f.bytes)
        .end_object();
  json.end_list().key("shape_errors"), write_shapes(json, plan.scene);
  json.key("thin_parts"), write_warnings(json, plan.thin_parts);
  json.key("oddities"), write_warnings(json, plan.oddities);
  std::fputs(json.end_object().text().c_str(), stdout);
}

/// The radii that hold the rate, organ by organ.
std::string radii_text(const Plan& plan) {
  std::string text;
  for (const scenes::OrganSpec& organ : plan.scene.scene.spec.organs)
    if (!organ.mesh.empty())
      text += (text.empty() ? "" : ", ") + organ.name + " " + importers::mm_text(organ.fill.radius) + " -> " +
              importers::mm_text(plan.fitting->factor * organ.fill.radius);
  return text;
}

/// "in contact 0.654 ms, in a cut 0.806 ms", of what happened.
std::string p99_text(const session::SessionCost& cost) {
  std::string text;
  for (const session::Deed deed : session::kDeeds)
    if (const session::DeedTimes times = cost.of(deed); times.ticks > 0)
      text += (text.empty() ? "" : ", ") + std::string(session::name_of(deed)) + " " +
              output::fixed(1e3 * times.own_p99, 3) + " ms";
  return text;
}

/// Share of the time of ticks that other programs may take before it is spoken of.
constexpr double kFewLost = 0.02;

/// ", of its own 0.654 ms" where other programs made a p99 longer than it is.
std::string own_text(const session::DeedTimes& times) {
  return times.own_p99 < (1 - kFewLost) * times.p99 ? ", of its own " + output::fixed(1e3 * times.own_p99, 3) + " ms"
                                                    : std::string();
}

void print_times(const Plan& plan) {
  const std::string rate = output::short_number(1e-3 / plan.tick()) + " kHz";
  if (!plan.cost) {
    print("time: %.3f ms a tick of %g ms at rest, measured now on this machine (median of %d)\n", plan.rest * 1e3,
          plan.tick() * 1e3, loading::kMeasuredTicks);
    return;
  }
  print("time of a tick of %g ms in a session, measured now on this machine with %s:\n", plan.tick() * 1e3,
        importers::counted(plan.cost->threads, "thread").c_str());
  for (const session::Deed deed : session::kDeeds)
    if (const session::DeedTimes times = plan.cost->of(deed); times.ticks > 0)
      print("  %-18s p50 %.3f ms, p99 %.3f ms%s, %lld ticks\n", session::name_of(deed), 1e3 * times.p50,
            1e3 * times.p99, own_text(times).c_str(), (long long)times.ticks);
  if (!plan.holds() && !plan.is_told())
    return print(
        "whether it holds %s at p99 cannot be told: other programs held processors that its %d threads share\n",
        rate.c_str(), plan.cost->threads);
  const bool is_alone = plan.cost->lost_share < kFewLost;
  print("%s %s at p99%s\n", plan.holds() ? "holds" : "does not hold", rate.c_str(),
        is_alone ? "" : ", if other programs leave it a processor");
  if (plan.holds()) return;
  if (plan.fitting)
    print("holds it with radius_mm and gap_mm times %g (%s; %zu spheres): p99 %s\n", plan.fitting->factor,
          radii_text(plan).c_str(), plan.fitting->spheres, p99_text(plan.fitting->cost).c_str());
  else
    print("no coarser filling of its meshes was found that does\n");
}

void print_text(const Plan& plan, const std::string& solver) {
  for (const bool is_in : {true, false}) {
    print(is_in ? "needed:\n" : "left out:\n");
    for (const Feature& f : plan.features)
      if (f.is_in == is_in)
        print("  %-30s %10s  %s\n", f.name.c_str(),
              f.bytes > 0 ? (std::to_string((f.bytes + 1023) / 1024) + " KiB").c_str() : "", f.why.c_str());
  }
  print_shapes(plan.scene);
  print("memory: %.1f KiB, %zu bytes a sphere\n", double(plan.bytes) / 1024,
        plan.bytes / std::max<std::size_t>(1, plan.scene.built.model.sphere_count()));
  print("solver: %s\n        because %s\n", solver.c_str(), plan.scene.built.integrator.reason.c_str());
  print_times(plan);
}

int run_plan(const PlanArguments& arguments) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(arguments.scene, arguments.load);
  if (!scene) return print_errors(scene.errors());
  print_warnings(scene->scene.warnings);
  const Model& model = scene->built.model;
  const session::ScriptOf script = script_of(arguments);
  const Result<scenes::Script> steps = script(*scene);
  if (!steps) return print_errors(steps.errors());
  Plan plan{*scene,
            features_of(scene->scene.spec, model, rest_state(model)),
            0,
            thin_parts_of(*scene),
            *loading::find_oddities(*scene),
            0,
            {},
            {}};
  for (const Feature& feature : plan.features) plan.bytes += feature.is_in ? feature.bytes : 0;
  print_warnings(plan.thin_parts);
  if (arguments.is_quick)
    plan.rest = *loading::measure_tick(model, session::start_session(*scene).initial_state);
  else if (const Result<Done> measured = measure(arguments, plan); !measured)
    return print_errors(measured.errors());
  if (plan.cost && !arguments.script.empty())
    append(plan.oddities, misses_of(*steps, *plan.cost, model, arguments.script));
  print_warnings(plan.oddities);
  const std::string solver = solver_of(model, scene->built.integrator);
  if (arguments.json)
    print_json(arguments.scene, plan, solver);
  else
    print_text(plan, solver);
  return exit_good;
}

}  // namespace

Command add_plan(CLI::App& program) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* app = program.add_subcommand(
      "plan",
      "Says what a scene needs and what is left out, memory, solver, tissue too thin for its spheres, and what the "
      "ticks of a session cost.");
  app->footer("Example: ctpm plan scenes/liver.json");
  app->add_option("scene", arguments->scene, "Scene file (.json)")->required();
  CLI::Option* const script =
      app->add_option("--script", arguments->script,
                      "Measure a session of this script instead of the default one's press and cut, and "
                      "warn if it never touches or cuts");
  app->add_flag("--quick", arguments->is_quick, "Measure ticks at rest alone, not a session")->excludes(script);
  app->add_flag("--json", arguments->json, "Print JSON");
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_plan(*arguments); }};
}

}  // namespace ctpm::commands
