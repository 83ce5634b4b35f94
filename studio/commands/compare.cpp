#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/model/errors.h"
#include "studio/commands/command.h"
#include "studio/commands/comparison_text.h"
#include "studio/commands/console.h"
#include "studio/commands/moment_pictures.h"
#include "studio/commands/physics_warning.h"
#include "studio/compare/compare_files.h"
#include "studio/reports/report.h"

namespace ctpm::commands {
namespace {

struct CompareArguments {
  std::string expert, trainee, folder;
  double force_limit_n = 0;
  bool has_force_limit = false, json = false;
  std::optional<bool> verify;
};

/// The worst moments of the trainee, and the expert at the same places.
Result<std::vector<compare::MomentPictures>> draw_worst(compare::ComparedFiles& files) {
  const compare::Comparison& comparison = files.comparison;
  std::vector<std::array<double, 2>> times;
  for (std::size_t i = 0; i < std::min(compare::kShownMoments, comparison.moments.size()); ++i) {
    const double at_s = comparison.moments[i].worst_s;
    times.push_back({at_s, compare::expert_time_at(comparison, at_s)});
  }
  return draw_moments(files.trainee, files.expert, times, !files.trainee_track.replays || !files.expert_track.replays);
}

/// A session that cannot be drawn, because another version wrote its scene, has a page without pictures.
Result<Done> write_page(const std::string& folder, compare::ComparedFiles& files, const std::string& to_see_worst) {
  Result<std::vector<compare::MomentPictures>> pictures = draw_worst(files);
  if (!pictures) print_remark("warning: the page has no pictures: " + pictures.errors()[0].message);
  return compare::write_comparison(folder, files.sessions(),
                                   pictures ? *pictures : std::vector<compare::MomentPictures>(), to_see_worst);
}

Result<compare::ComparedFiles> compare_opened(compare::OpenedFiles files, const CompareArguments& arguments) {
  compare::CompareFilesOptions options;
  if (arguments.has_force_limit) options.force_limit = arguments.force_limit_n;
  if (arguments.verify) options.replaying = *arguments.verify ? compare::Replaying::all : compare::Replaying::none;
  ProgressLine progress("comparing");
  options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  return compare::compare_files(std::move(files), options);
}

int run_compare(const CompareArguments& arguments) {
  Result<compare::OpenedFiles> opened = compare::open_files(arguments.expert, arguments.trainee);
  Errors errors;
  append(errors, opened);
  if (arguments.has_force_limit && !(arguments.force_limit_n > 0))
    errors.push_back({"--force-limit", "must be above 0 N", ""});
  if (!arguments.folder.empty()) append(errors, reports::check_folder(arguments.folder));
  if (!errors.empty()) return print_errors(errors);
  warn_of_physics(opened->expert), warn_of_physics(opened->trainee);
  Result<compare::ComparedFiles> files = compare_opened(*std::move(opened), arguments);
  if (!files) return print_errors(files.errors());
  // Created only now, so that refused sessions leave no folder behind.
  if (!arguments.folder.empty())
    if (const Result<Done> ready = reports::prepare_folder(arguments.folder); !ready)
      return print_errors(ready.errors());
  const compare::ComparedSessions compared = files->sessions();
  const std::string to_see_worst = worst_moment_command(compared);
  if (!arguments.folder.empty())
    if (const Result<Done> written = write_page(arguments.folder, *files, to_see_worst); !written)
      return print_errors(written.errors());
  for (const std::string& remark : compare::remarks_of(compared)) print_remark("warning: " + remark);
  print("%s", (arguments.json ? compare::comparison_json(compared) : comparison_text(compared, to_see_worst)).c_str());
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
                      "Force that should not be passed [N]; if not given the scene's, or 1 % above the expert's peak");
  const auto choose = [arguments](bool verifies) { return [=] { arguments->verify = verifies; }; };
  app->add_flag_callback("--verify", choose(true),
                         "Replay the sessions and take forces and depths from the replay; by default up to 30 s");
  app->add_flag_callback("--no-verify", choose(false), "Believe the forces and depths that the sessions state");
  app->add_flag("--json", arguments->json, "Print the results as JSON");
  return {app, [arguments, limit] {
            arguments->has_force_limit = limit->count() > 0;
            return run_compare(*arguments);
          }};
}

}  // namespace ctpm::commands
