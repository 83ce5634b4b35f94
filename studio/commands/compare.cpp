#include <memory>
#include <string>

#include "studio/commands/command.h"
#include "studio/commands/comparison_text.h"
#include "studio/commands/console.h"
#include "studio/commands/physics_warning.h"
#include "studio/compare/report.h"
#include "studio/loading/loaded_scene.h"
#include "studio/reports/report.h"

namespace ctpm::commands {
namespace {

struct CompareArguments {
  std::string expert, trainee, folder;
  double force_limit_n = 0;
  bool has_force_limit = false, json = false;
};

int run_compare(const CompareArguments& arguments) {
  if (arguments.has_force_limit && !(arguments.force_limit_n > 0))
    return print_errors({{"--force-limit", "must be above 0 N", ""}});
  Result<recordings::SessionReader> expert = recordings::SessionReader::open(arguments.expert);
  Result<recordings::SessionReader> trainee = recordings::SessionReader::open(arguments.trainee);
  Errors errors;
  for (const auto* session : {&expert, &trainee})
    if (!*session) errors.insert(errors.end(), session->errors().begin(), session->errors().end());
  if (!errors.empty()) return print_errors(errors);
  if (const Result<Done> same = compare::check_same_scene(*expert, *trainee); !same) return print_errors(same.errors());
  warn_of_physics(*expert), warn_of_physics(*trainee);
  const Result<compare::SessionTrack> expert_track = compare::read_track(*expert);
  const Result<compare::SessionTrack> trainee_track = compare::read_track(*trainee);
  for (const auto* track : {&expert_track, &trainee_track})
    if (!*track) errors.insert(errors.end(), track->errors().begin(), track->errors().end());
  if (!errors.empty()) return print_errors(errors);
  // Created only now, so that refused sessions leave no folder behind.
  if (!arguments.folder.empty())
    if (const Result<Done> ready = reports::prepare_folder(arguments.folder); !ready)
      return print_errors(ready.errors());

  compare::CompareOptions options;
  if (arguments.has_force_limit) options.force_limit = arguments.force_limit_n;
  const recordings::SessionStart& scene = expert->start();
  // A scene text of another version may be unreadable; only the limit is needed from it.
  if (const Result<scenes::SceneText> text = scenes::read_scene(scene.scene_text, arguments.expert); text)
    options.damage_force = loading::damage_force_of(text->spec);
  const compare::Comparison comparison = compare::compare_sessions(*expert_track, *trainee_track, scene, options);
  const compare::ComparedSessions compared{*expert_track, *trainee_track, scene, comparison};
  const std::string to_see_worst = worst_moment_command(compared);
  if (!arguments.folder.empty())
    if (const Result<Done> written = compare::write_comparison(arguments.folder, compared, to_see_worst); !written)
      return print_errors(written.errors());
  for (const std::string& remark : compare::remarks_of(compared)) print_remark("warning: " + remark);
  std::fputs((arguments.json ? compare::comparison_json(compared) : comparison_text(compared, to_see_worst)).c_str(),
             stdout);
  if (!arguments.folder.empty()) print_remark("written: " + arguments.folder + "/report.html, results.json");
  return exit_good;
}

}  // namespace

Command add_compare(CLI::App& program) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* app =
      program.add_subcommand("compare", "Measures a trainee's session against an expert's of the same scene.");
  app->footer("Example: ctpm compare expert.ctpm trainee.ctpm -o out/compare");
  app->add_option("expert", arguments->expert, "Session file of the expert (.ctpm)")->required();
  app->add_option("trainee", arguments->trainee, "Session file of the trainee (.ctpm)")->required();
  app->add_option("-o,--output", arguments->folder, "Folder for report.html and results.json; made if missing");
  const CLI::Option* limit =
      app->add_option("--force-limit", arguments->force_limit_n,
                      "Force that should not be passed [N]; if not given the scene's, or the expert's peak");
  app->add_flag("--json", arguments->json, "Print the results as JSON");
  return {app, [arguments, limit] {
            arguments->has_force_limit = limit->count() > 0;
            return run_compare(*arguments);
          }};
}

}  // namespace ctpm::commands
