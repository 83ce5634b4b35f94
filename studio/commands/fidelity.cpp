#include "studio/fidelity/fidelity.h"

#include <memory>
#include <string>

#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/output/number_text.h"

namespace ctpm::commands {
namespace {

struct FidelityArguments {
  std::string folder, scene;
  fidelity::FidelityOptions options;
};

/// The goals that are missed, one a line.
void print_missed(const fidelity::FidelityResults& results) {
  for (const fidelity::Chapter& chapter : results.chapters)
    for (const fidelity::Figure& f : chapter.figures) {
      if (f.verdict() != reports::ReportVerdict::missed) continue;
      const std::string radius = f.radius > 0 ? ", r = " + output::short_number(1e3 * f.radius) + " mm" : "";
      const std::string unit = f.unit == "1" ? "" : " " + f.unit;
      print("missed: %s: %s%s: %s%s, should be %s\n", f.recipe.c_str(), f.name.c_str(), radius.c_str(),
            output::short_number(f.measured).c_str(), unit.c_str(), f.goal->text(f.unit).c_str());
    }
}

int run_fidelity_command(FidelityArguments arguments) {
  if (!arguments.scene.empty()) arguments.options.scene = arguments.scene;
  if (const Result<Done> ready = reports::check_folder(arguments.folder); !ready) return print_errors(ready.errors());
  const Result<fidelity::FidelityResults> results =
      fidelity::run_fidelity(arguments.options, [](const std::string& title, std::int64_t done, std::int64_t total) {
        print_remark("recipe " + std::to_string(done + 1) + " of " + std::to_string(total) + ": " + title);
      });
  if (!results) return print_errors(results.errors());
  if (const Result<Done> written = fidelity::write_fidelity_report(arguments.folder, *results); !written)
    return print_errors(written.errors());
  print_missed(*results);
  const std::int64_t met = results->count(reports::ReportVerdict::met),
                     missed = results->count(reports::ReportVerdict::missed);
  print("%lld goals met, %lld missed\nwritten: %s/report.html, results.json, results.csv\n", (long long)met,
        (long long)missed, arguments.folder.c_str());
  return missed == 0 ? exit_good : exit_bad_verdict;
}

std::string recipe_names() {
  std::string names;
  for (const fidelity::RecipeInfo& recipe : fidelity::fidelity_recipes())
    names += (names.empty() ? "" : ", ") + std::string(recipe.key);
  return names;
}

}  // namespace

Command add_fidelity(CLI::App& program) {
  auto arguments = std::make_shared<FidelityArguments>();
  arguments->options.shipped = CTPM_SOURCE_DIR "/scenes";
  CLI::App* app = program.add_subcommand(
      "fidelity", "Measures what a filled organ does against finite elements, closed forms and plain requirements.");
  app->footer(
      "Examples: ctpm fidelity -o out/fidelity\n          ctpm fidelity -o out/fidelity --only tension,drag "
      "--quick\n          ctpm fidelity -o out/my-liver my/liver.json\nExit code 1 if a goal is missed.\nRecipes: " +
      recipe_names());
  app->add_option(
      "scene", arguments->scene,
      "A scene (.json): its first organ is measured under its own first ball, instead of the standard bodies");
  app->add_option("-o,--output", arguments->folder,
                  "Folder for report.html, results.json and results.csv; made if missing")
      ->required();
  app->add_option("--only", arguments->options.recipes, "Only these recipes, separated by commas")->delimiter(',');
  app->add_flag("--quick", arguments->options.is_quick, "Coarse fillings, few places and turns");
  app->add_flag("--allow-outside-paths", arguments->options.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_fidelity_command(*arguments); }};
}

}  // namespace ctpm::commands
