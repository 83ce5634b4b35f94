#include <algorithm>
#include <memory>
#include <string>

#include "core/model/errors.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/reports/report.h"
#include "studio/stability/stability.h"

namespace ctpm::commands {
namespace {

struct StabilityArguments {
  std::string folder;
  std::vector<std::string> keys;
  bool is_quick = false, is_auto_only = false;
};

/// The cases with the requested keys; all cases without keys. Errors: unknown keys.
Result<std::vector<stability::StabilityCase>> chosen_cases(const StabilityArguments& arguments) {
  std::vector<stability::StabilityCase> all = stability::stability_cases(arguments.is_quick), chosen;
  if (arguments.keys.empty()) return all;
  Errors errors;
  for (const std::string& key : arguments.keys) {
    const auto it =
        std::find_if(all.begin(), all.end(), [&](const stability::StabilityCase& c) { return c.key == key; });
    if (it != all.end())
      chosen.push_back(*it);
    else
      errors.push_back({"--case", "there is no case " + key, "results.csv of a whole run names them all"});
  }
  if (!errors.empty()) return errors;
  return chosen;
}

void print_runs(const std::vector<stability::StabilityRow>& rows) {
  std::int64_t automatic[4] = {0, 0, 0, 0}, named[4] = {0, 0, 0, 0};
  for (const stability::StabilityRow& row : rows)
    for (const stability::StabilityRun& run : row.runs) {
      ++(run.asked ? named : automatic)[int(run.verdict)];
      if (run.verdict == reports::ReportVerdict::missed)
        print("missed: %s under %s: %s\n", row.what->title.c_str(), stepping::name_of(run.asked), run.reason.c_str());
    }
  const auto of = [](const std::int64_t* counts, reports::ReportVerdict verdict) {
    return (long long)counts[int(verdict)];
  };
  using enum reports::ReportVerdict;
  print("%zu case%s: auto holds %lld and fails %lld\n", rows.size(), rows.size() == 1 ? "" : "s", of(automatic, met),
        (long long)stability::count_failures(rows));
  if (!rows.empty() && rows[0].runs.size() == 1) return;
  print("integrators that are named: %lld runs hold, %lld were refused beforehand, %lld ran and failed\n",
        of(named, met), of(named, refused), of(named, missed));
}

int run_stability_command(const StabilityArguments& arguments) {
  const Result<std::vector<stability::StabilityCase>> cases = chosen_cases(arguments);
  Errors errors;
  append(errors, cases);
  append(errors, reports::check_folder(arguments.folder));
  if (!errors.empty()) return print_errors(errors);
  const std::vector<stability::StabilityRow> rows = [&] {
    ProgressLine progress("running the stability cases");
    const std::size_t integrators = arguments.is_auto_only ? 1 : std::size(stability::kStabilityIntegrators);
    return stability::run_stability(*cases, integrators,
                                    [&](std::int64_t done, std::int64_t total) { progress.show(done, total); });
  }();
  if (const Result<Done> written = stability::write_stability_report(arguments.folder, rows); !written)
    return print_errors(written.errors());
  print_runs(rows);
  print("written: %s/report.html, results.json, results.csv\n", arguments.folder.c_str());
  return stability::count_failures(rows) == 0 ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_stability(CLI::App& program) {
  auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* app =
      program.add_subcommand("stability", "Runs stiff and extreme cases under every integrator and says what holds.");
  app->footer(
      "Example: ctpm stability -o out/stability\n"
      "Exit code 1 if the integrator that auto chooses fails any case.");
  app->add_option("-o,--output", arguments->folder,
                  "Folder for report.html, results.json and results.csv; made if missing")
      ->required();
  app->add_option("--case", arguments->keys, "Only the case of this key, as in results.csv; may be repeated");
  app->add_flag("--quick", arguments->is_quick, "Cuts the long cases down; their titles say so");
  app->add_flag("--auto-only", arguments->is_auto_only, "Only under the integrator that auto takes, which must hold");
  return {app, [arguments] { return run_stability_command(*arguments); }};
}

}  // namespace ctpm::commands
