#include <memory>
#include <string>
#include <vector>

#include "core/model/errors.h"
#include "scenes/course.h"
#include "studio/cohort/cohort.h"
#include "studio/cohort/gather.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/script_checks.h"
#include "studio/compare/measure_table.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/oddities.h"
#include "studio/output/printable.h"
#include "studio/sources/open_file.h"

namespace ctpm::commands {
namespace {

struct CheckArguments {
  std::vector<std::string> scenes, scripts;
  scenes::LoadOptions load;
};

/// The errors of the scripts that belong to a scene.
Errors errors_of_scripts(const CheckArguments& arguments, const std::string& scene) {
  const Result<scenes::SceneDraft> draft = scenes::load_draft(scene, arguments.load);
  Errors all;
  for (const std::string& script : arguments.scripts) {
    append(all, sources::check_script(script, draft ? *draft : scenes::unknown_scene(scene)));
  }
  return all;
}

/// As the page of the studio counts them: ", 2 warnings"; nothing where there are none.
std::string counted_warnings(std::size_t count) {
  return count == 0 ? "" : ", " + std::to_string(count) + (count == 1 ? " warning" : " warnings");
}

/// Whether a course is good, with its experts' sessions and its scenes; prints what is wrong.
bool is_good_course(const std::string& path, const scenes::LoadOptions& load) {
  const Result<scenes::CourseSpec> course = scenes::load_course(path, compare::measure_keys());
  if (!course) return print_errors(course.errors()), false;
  const cohort::CourseFindings scenes = cohort::find_other_scenes(*course, load);
  Errors errors;
  const cohort::CourseFindings marks = cohort::find_hard_marks(*course);
  append(errors, marks.errors);
  append(errors, scenes.errors);
  if (!errors.empty()) return print_errors(errors), false;
  Errors warnings = scenes.warnings;
  append(warnings, marks.warnings);
  print_warnings(warnings);
  const std::size_t tasks = course->tasks.size();
  print("%s: good, %zu %s; %s%s\n", path.c_str(), tasks, tasks == 1 ? "task" : "tasks",
        course->evidence.empty() ? "not validated" : ("validated by " + output::printable(course->evidence)).c_str(),
        counted_warnings(warnings.size()).c_str());
  return true;
}

Result<loading::LoadedScene> load(const std::string& path, const scenes::LoadOptions& options) {
  ProgressLine line("filling");
  return loading::load_whole_scene(
      path, options, {}, {}, [&](const std::string&, double share) { line.show(std::int64_t(1000 * share), 1000); });
}

Errors oddities_of(const loading::LoadedScene& scene) {
  ProgressLine line("settling");
  return *loading::find_oddities(scene, [&] { return line.show(1, 0), false; });
}

/// What is odd about a good scene and its good scripts.
Errors warnings_of(const CheckArguments& arguments, const loading::LoadedScene& scene) {
  Errors warnings = scene.scene.warnings;
  append(warnings, oddities_of(scene));
  for (const std::string& file : arguments.scripts)
    if (const Result<scenes::Script> script = read_script(file, scene))  // a pipe is empty by now
      append(warnings, find_far_script(*script, scene.built.model, file));
  return warnings;
}

int run_check(const CheckArguments& arguments) {
  if (!arguments.scripts.empty() && arguments.scenes.size() > 1)
    return print_errors({{"--script", "belongs to one scene, got " + std::to_string(arguments.scenes.size()), ""}});
  int code = exit_good;
  for (const std::string& path : arguments.scenes) {
    if (scenes::is_course(path)) {
      if (!is_good_course(path, arguments.load)) code = exit_bad_input;
      continue;
    }
    const Errors of_scripts = errors_of_scripts(arguments, path);
    const Result<loading::LoadedScene> scene = load(path, arguments.load);
    if (!scene || !of_scripts.empty()) {
      Errors errors;
      append(errors, scene), append(errors, of_scripts);
      code = print_errors(errors);
      continue;
    }
    const Errors warnings = warnings_of(arguments, *scene);
    print_warnings(warnings);
    print("%s: good, %zu spheres, %zu elements%s\n", path.c_str(), scene->built.model.sphere_count(),
          scene->built.model.element_count(), counted_warnings(warnings.size()).c_str());
  }
  return code;
}

}  // namespace

Command add_check(CLI::App& program) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* app = program.add_subcommand("check",
                                         "Validates scenes with their meshes and scripts, and courses; all errors at "
                                         "once. Settles scenes, and warns of what "
                                         "is odd, and of scripts whose tools never come near an organ.");
  app->footer(
      "Examples: ctpm check scenes/liver.json\n"
      "          ctpm check scenes/liver.json --script scenes/scripts/liver-cut.json");
  app->add_option("scenes", arguments->scenes, "Scene or course files (.json)")->required();
  app->add_option("--script", arguments->scripts, "Script of the scene (.json; repeatable)");
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_check(*arguments); }};
}

}  // namespace ctpm::commands
