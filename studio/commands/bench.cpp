#include <memory>
#include <string>

#include "studio/bench/bench.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"

namespace ctpm::commands {
namespace {

struct BenchArguments {
  std::string folder;
  bench::BenchOptions options;
};

/// All studies, each with its own progress. For named scenes only the study in time runs.
Result<std::vector<bench::BenchStudy>> run_studies(const bench::BenchOptions& options) {
  const auto line = [](ProgressLine& progress) {
    return [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  };
  std::vector<bench::BenchStudy> studies;
  {
    ProgressLine progress("integrators, substeps and tolerances");
    Result<std::vector<bench::BenchStudy>> time = bench::run_bench_time(options, line(progress));
    if (!time) return time.errors();
    studies = std::move(*time);
  }
  if (!options.scenes.empty()) return studies;
  for (const auto& [title, run] :
       {std::pair{"sphere radius", &bench::run_bench_space}, std::pair{"structure", &bench::run_bench_structure},
        std::pair{"tiling", &bench::run_bench_tiling}}) {
    ProgressLine progress(title);
    Result<bench::BenchStudy> study = run(options, line(progress));
    if (!study) return study.errors();
    studies.push_back(std::move(*study));
  }
  return studies;
}

int run_bench(const BenchArguments& arguments) {
  if (const Result<Done> ready = reports::prepare_folder(arguments.folder); !ready) return print_errors(ready.errors());
  const Result<std::vector<bench::BenchStudy>> studies = run_studies(arguments.options);
  if (!studies) return print_errors(studies.errors());
  if (const Result<Done> written = bench::write_bench_report(arguments.folder, *studies); !written)
    return print_errors(written.errors());
  for (const bench::BenchStudy& study : *studies)
    for (const std::string& sentence : study.sentences) print("%s\n", sentence.c_str());
  print("written: %s/report.html, results.json, results.csv\n", arguments.folder.c_str());
  return exit_good;
}

}  // namespace

Command add_bench(CLI::App& program) {
  auto arguments = std::make_shared<BenchArguments>();
  arguments->options.take_warnings = print_warnings;
  arguments->options.shipped = std::string(CTPM_SOURCE_DIR) + "/scenes";
  CLI::App* app = program.add_subcommand(
      "bench", "Measures error against run time: integrators and steps, sphere radius, structure, tiling.");
  app->footer(
      "Examples: ctpm bench -o out/bench\n"
      "          ctpm bench my/liver.json -o out/bench");
  app->add_option("SCENE", arguments->options.scenes,
                  "Scenes to study in time; without any, the shipped ones in all ways");
  app->add_option("-o,--output", arguments->folder,
                  "Folder for report.html, results.json and results.csv; made if missing")
      ->required();
  app->add_option("--scenes", arguments->options.shipped, "Folder of the shipped scenes");
  app->add_flag("--quick", arguments->options.is_quick, "Coarser fillings and fewer settings, for a first look");
  return {app, [arguments] { return run_bench(*arguments); }};
}

}  // namespace ctpm::commands
