#include <memory>
#include <string>

#include "studio/authoring/fit_scene.h"
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

void print_fit(const authoring::SceneFit& scene) {
  const authoring::StiffnessFit& fit = scene.fit;
  const scenes::FittedForSpec& f = fit.fitted_for;
  print("%s: stiffness_scale %.6g\n", scene.organ.c_str(), fit.scale);
  print("fitted with a ball of %.2f mm on spheres of %.2f mm, around (%.2f, %.2f, %.2f) mm\n\n", 1e3 * f.ball_radius,
        1e3 * f.sphere_radius, 1e3 * f.place.x, 1e3 * f.place.y, 1e3 * f.place.z);
  print("depth [mm]   force [N]   scatter [%%]   %s [N]   error [%%]\n",
        scene.is_of_table ? "Table 1, CTPM" : "closed form  ");
  for (const authoring::FitRow& row : fit.rows)
    print("%10.0f %11.4f %13.1f %19.4f %11.1f\n", 1e3 * row.depth, row.force, 100 * row.scatter, row.closed_form,
          100 * row.error());
  print("\nThe scale is fitted at 12 mm only; the other depths show how the shape of the curve differs.\n");
  if (!scene.is_of_table)
    print("The paper has no forces of this material: the closed form is that of its five spheres with these moduli.\n");
}

int run_fit(const FitArguments& arguments) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(arguments.scene, arguments.load);
  if (!scene) return print_errors(scene.errors());
  print_warnings(scene->scene.warnings);
  if (arguments.write)
    if (const Result<Done> writable = output::check_writable(arguments.scene); !writable)
      return print_errors(writable.errors());
  const Result<authoring::SceneFit> fit = authoring::fit_scene(*scene, arguments.organ);
  if (!fit) return print_errors(fit.errors());
  print_fit(*fit);
  if (!arguments.write) return exit_good;
  if (const Result<Done> written = output::write_text_file(arguments.scene, fit->text); !written)
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
