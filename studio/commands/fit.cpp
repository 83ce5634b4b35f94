#include <memory>
#include <string>

#include "scenes/presets.h"
#include "studio/authoring/fit_stiffness.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/files.h"

namespace ctpm::commands {
namespace {

struct FitArguments {
  std::string scene, organ;
  bool write = false;
  scenes::LoadOptions load;
};

/// Index of the organ of that name; of the first if the name is empty.
Result<std::size_t> find_organ(const scenes::SceneSpec& scene, const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    if (name.empty() || scene.organs[i].name == name) return i;
    known += (known.empty() ? "" : ", ") + scene.organs[i].name;
  }
  return Error{"--organ", "the scene has no organ '" + name + "'", "it has: " + known};
}

/// Whether the paper's Table 1 has the forces of a material.
bool is_of_table(const scenes::MaterialSpec& material) {
  const scenes::MaterialPreset* preset = scenes::find_preset(material.preset);
  return preset && preset->is_of_paper && !material.spring && !material.kelvin && !material.constraint;
}

void print_fit(const scenes::OrganSpec& organ, const authoring::StiffnessFit& fit) {
  const scenes::FittedForSpec& f = fit.fitted_for;
  print("%s: stiffness_scale %.6g\n", organ.name.c_str(), fit.scale);
  print("fitted with a ball of %.2f mm on spheres of %.2f mm, around (%.2f, %.2f, %.2f) mm\n\n", 1e3 * f.ball_radius,
        1e3 * f.sphere_radius, 1e3 * f.place.x, 1e3 * f.place.y, 1e3 * f.place.z);
  const bool is_printed = is_of_table(organ.material);
  print("depth [mm]   force [N]   scatter [%%]   %s [N]   error [%%]\n",
        is_printed ? "Table 1, CTPM" : "closed form  ");
  for (const authoring::FitRow& row : fit.rows)
    print("%10.0f %11.4f %13.1f %19.4f %11.1f\n", 1e3 * row.depth, row.force, 100 * row.scatter, row.closed_form,
          100 * row.error());
  print("\nThe scale is fitted at 12 mm only; the other depths show how the shape of the curve differs.\n");
  if (!is_printed)
    print("The paper has no forces of this material: the closed form is that of its five spheres with these moduli.\n");
}

int run_fit(const FitArguments& arguments) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(arguments.scene, arguments.load);
  if (!scene) return print_errors(scene.errors());
  print_warnings(scene->scene.warnings);
  scenes::SceneSpec spec = scene->scene.spec;
  const Result<std::size_t> organ = find_organ(spec, arguments.organ);
  if (!organ) return print_errors(organ.errors());
  if (arguments.write)
    if (const Result<Done> writable = output::check_writable(arguments.scene); !writable)
      return print_errors(writable.errors());
  const Result<authoring::StiffnessFit> fit = authoring::fit_stiffness(spec, *organ, scene->organs[*organ]);
  if (!fit) {
    Errors errors = fit.errors();
    for (Error& error : errors) error.where = arguments.scene + ": " + error.where;
    return print_errors(errors);
  }
  print_fit(spec.organs[*organ], *fit);
  if (!arguments.write) return exit_good;
  authoring::apply_fit(spec.organs[*organ], *fit);
  if (const Result<Done> written =
          output::write_text_file(arguments.scene, scenes::rewrite_scene(scene->scene.text, scene->scene.spec, spec));
      !written)
    return print_errors(written.errors());
  print("written: %s\n", arguments.scene.c_str());
  return exit_good;
}

}  // namespace

Command add_fit(CLI::App& program) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* app = program.add_subcommand("fit", "Fits an organ's stiffness: the paper's ball at 12 mm meets Table 1.");
  app->footer("Example: ctpm fit my/liver.json --write");
  app->add_option("scene", arguments->scene, "Scene file (.json)")->required();
  app->add_option("--organ", arguments->organ, "Name of the organ; the first if not given");
  app->add_flag("--write", arguments->write,
                "Store the scale and what it was fitted for in the scene; its comments and layout stay");
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_fit(*arguments); }};
}

}  // namespace ctpm::commands
