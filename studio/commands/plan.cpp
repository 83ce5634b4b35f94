#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/model/fields.h"
#include "core/stepping/step.h"
#include "importers/text.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/fidelity/thickness.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/oddities.h"
#include "studio/loading/tick_time.h"
#include "studio/output/files.h"
#include "studio/output/json_writer.h"

namespace ctpm::commands {
namespace {

struct PlanArguments {
  std::string scene, script;
  bool json = false;
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
      {"damage limit", limits, limits ? "an organ has a limit" : "no organ has a limit", 0},
  };
}

/// The integrator and solver of a tick, in words.
std::string solver_of(const Model& model, const stepping::IntegratorChoice& choice) {
  std::string words = stepping::name_of(choice.integrator);
  if (choice.substeps > 1) words += ", " + std::to_string(choice.substeps) + " substeps a tick";
  if (choice.integrator == Integrator::leapfrog) return words;
  char limits[96];
  std::snprintf(limits, sizeof limits, ", conjugate gradients to a residual of %g, at most %d iterations",
                model.solver.tolerance, model.solver.max_iterations);
  return words + limits;
}

/// Tissue that is thinner than its spheres can carry, and parts without spheres: one warning an organ and kind.
Errors thin_parts_of(const loading::LoadedScene& scene) {
  Errors warnings;
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    const FilledOrgan& organ = scene.organs[i];
    const std::string at = "/organs/" + std::to_string(i) + "/fill";
    const fidelity::ThinParts thin = fidelity::find_thin_parts(organ);
    const double known = fidelity::kThicknessError * organ.spacing;
    if (thin.spheres > 0)
      warnings.push_back(scene.scene.places.error_at(
          at,
          std::to_string(thin.spheres) + " of " + std::to_string(organ.centre.size()) +
              " spheres lie in tissue thinner than two spacings (" +
              importers::mm_text(fidelity::kLeastSpacingsAcross * organ.spacing) +
              "), which they cannot carry; the thinnest is " +
              (thin.thinnest < known ? "less than " + importers::mm_text(known) : importers::mm_text(thin.thinnest)) +
              " at " + importers::place_text(thin.place),
          "a smaller radius_mm carries more of it"));
    for (const importers::Finding& finding : scene.reports[i].fill.findings)
      if (finding.code == "thin" || finding.code == "flat")
        warnings.push_back(scene.scene.places.error_at(at, finding.found, finding.remains));
  }
  return warnings;
}

int run_plan(const PlanArguments& arguments) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(arguments.scene, arguments.load);
  if (!scene) return print_errors(scene.errors());
  print_warnings(scene->scene.warnings);
  const Errors thin_parts = thin_parts_of(*scene);
  print_warnings(thin_parts);
  Errors oddities = *loading::find_oddities(*scene);
  if (!arguments.script.empty()) {
    const Result<std::string> text = output::read_text_file(arguments.script);
    if (!text) return print_errors(text.errors());
    std::vector<std::string> tools;
    for (const Tool& tool : scene->built.model.tools) tools.push_back(tool.name);
    const Result<scenes::Script> script = scenes::read_script(*text, arguments.script, tools);
    if (!script) return print_errors(script.errors());
    for (Error& miss : loading::find_misses(*scene, *script, arguments.script)) oddities.push_back(std::move(miss));
  }
  print_warnings(oddities);
  const Model& model = scene->built.model;
  const std::vector<Feature> features = features_of(scene->scene.spec, model, rest_state(model));
  std::size_t total = 0;
  for (const Feature& feature : features) total += feature.is_in ? feature.bytes : 0;
  const double tick = *loading::measure_tick(model);
  const stepping::IntegratorChoice& choice = scene->built.integrator;
  const std::string solver = solver_of(model, choice);
  if (arguments.json) {
    output::JsonWriter json;
    json.begin_object().member("scene", arguments.scene).member("spheres", model.sphere_count());
    json.member("elements", model.element_count()).member("memory_bytes", total).member("tick_s", model.tick);
    json.member("measured_tick_time_s", tick)
        .member("solver", solver)
        .member("solver_reason", choice.reason)
        .key("features")
        .begin_list();
    for (const Feature& f : features)
      json.begin_object()
          .member("name", f.name)
          .member("is_in", f.is_in)
          .member("why", f.why)
          .member("bytes", f.bytes)
          .end_object();
    json.end_list().key("thin_parts").begin_list();
    for (const Error& warning : thin_parts) json.value(std::string_view(warning.where + ": " + warning.message));
    json.end_list().key("oddities").begin_list();
    for (const Error& warning : oddities) json.value(std::string_view(warning.where + ": " + warning.message));
    std::fputs(json.end_list().end_object().text().c_str(), stdout);
    return exit_good;
  }
  for (const bool is_in : {true, false}) {
    print(is_in ? "needed:\n" : "left out:\n");
    for (const Feature& f : features)
      if (f.is_in == is_in)
        print("  %-30s %10s  %s\n", f.name.c_str(),
              f.bytes > 0 ? (std::to_string((f.bytes + 1023) / 1024) + " KiB").c_str() : "", f.why.c_str());
  }
  print("memory: %.1f KiB, %zu bytes a sphere\n", double(total) / 1024,
        total / std::max<std::size_t>(1, model.sphere_count()));
  print("solver: %s\n        because %s\n", solver.c_str(), choice.reason.c_str());
  print("time: %.3f ms a tick of %g ms at rest, measured now on this machine (median of %d)\n", tick * 1e3,
        model.tick * 1e3, loading::kMeasuredTicks);
  return exit_good;
}

}  // namespace

Command add_plan(CLI::App& program) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* app = program.add_subcommand(
      "plan",
      "Says what a scene needs and what is left out, memory, time, solver, and tissue too thin for its spheres.");
  app->footer("Example: ctpm plan scenes/liver.json");
  app->add_option("scene", arguments->scene, "Scene file (.json)")->required();
  app->add_option("--script", arguments->script, "Also run this script, and warn if it never touches or cuts");
  app->add_flag("--json", arguments->json, "Print JSON");
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_plan(*arguments); }};
}

}  // namespace ctpm::commands
