#include <memory>
#include <string>
#include <vector>

#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/oddities.h"

namespace ctpm::commands {
namespace {

struct CheckArguments {
  std::vector<std::string> scenes;
  scenes::LoadOptions load;
};

int run_check(const CheckArguments& arguments) {
  int code = exit_good;
  for (const std::string& path : arguments.scenes) {
    const Result<loading::LoadedScene> scene = loading::load_whole_scene(path, arguments.load);
    if (!scene) {
      code = print_errors(scene.errors());
      continue;
    }
    print_warnings(scene->scene.warnings);
    print_warnings(*loading::find_oddities(*scene));
    print("%s: good, %zu spheres, %zu elements\n", path.c_str(), scene->built.model.sphere_count(),
          scene->built.model.element_count());
  }
  return code;
}

}  // namespace

Command add_check(CLI::App& program) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* app = program.add_subcommand(
      "check", "Validates scenes with their meshes; all errors at once. Settles them, and warns of what is odd.");
  app->footer("Example: ctpm check scenes/liver.json");
  app->add_option("scenes", arguments->scenes, "Scene files (.json)")->required();
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_check(*arguments); }};
}

}  // namespace ctpm::commands
