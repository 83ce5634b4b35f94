#include <memory>
#include <string>

#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/paper/paper.h"

namespace ctpm::commands {
namespace {

struct PaperArguments {
  std::string folder, scenes = std::string(CTPM_SOURCE_DIR) + "/scenes";
};

int run_paper(const PaperArguments& arguments) {
  if (const Result<Done> ready = reports::check_folder(arguments.folder); !ready) return print_errors(ready.errors());
  Result<paper::PaperResults> results = [&] {
    ProgressLine progress("running the paper's experiments");
    return paper::run_paper_experiments(arguments.scenes,
                                        [&](std::int64_t done, std::int64_t total) { progress.show(done, total); });
  }();
  if (!results) return print_errors(results.errors());
  if (const Result<Done> written = paper::write_paper_report(arguments.folder, *results); !written)
    return print_errors(written.errors());
  for (const paper::Claim& claim : results->claims)
    if (paper::must_hold(claim.kind) && claim.verdict() == reports::ReportVerdict::missed)
      print("missed: %s, %s %s %s: %s\n", claim.experiment.c_str(), claim.organ.c_str(), claim.structure.c_str(),
            claim.viscosity.c_str(), claim.quantity.c_str());
  for (const paper::Sentence& sentence : paper::headline(results->claims)) print("%s\n", sentence.text.c_str());
  print("written: %s/report.html, results.json, results.csv\n", arguments.folder.c_str());
  return paper::network_holds(results->claims) ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_paper(CLI::App& program) {
  auto arguments = std::make_shared<PaperArguments>();
  CLI::App* app = program.add_subcommand(
      "paper", "Runs every experiment of the paper on the network and writes a report of what agrees.");
  app->footer("Example: ctpm paper -o out/paper");
  app->add_option("-o,--output", arguments->folder,
                  "Folder for report.html, results.json and results.csv; made if missing")
      ->required();
  app->add_option("--scenes", arguments->scenes, "Folder of the shipped scenes");
  return {app, [arguments] { return run_paper(*arguments); }};
}

}  // namespace ctpm::commands
