#include <iterator>
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

using Studies = Result<std::vector<bench::BenchStudy>>;

/// A study of the paper's rig, as one of many.
template <Result<bench::BenchStudy> (*run)(const bench::BenchOptions&, const bench::BenchProgress&)>
Studies alone(const bench::BenchOptions& options, const bench::BenchProgress& progress) {
  Result<bench::BenchStudy> study = run(options, progress);
  if (!study) return study.errors();
  return std::vector{*std::move(study)};
}

/// All studies, each with its own progress. For named scenes only those of an organ run.
Studies run_studies(const bench::BenchOptions& options) {
  struct Part {
    const char* title;
    Studies (*run)(const bench::BenchOptions&, const bench::BenchProgress&);
    bool is_of_organ;
  };
  std::vector<bench::BenchStudy> studies;
  for (const Part& part :
       {Part{"integrators, substeps and tolerances", &bench::run_bench_time, true},
        Part{"sphere radius", &bench::run_bench_space, true},
        Part{"structure and lattice phase", &bench::run_bench_organ, true},
        Part{"sleep", &bench::run_bench_sleep, true}, Part{"structure", &alone<&bench::run_bench_structure>, false},
        Part{"tiling", &alone<&bench::run_bench_tiling>, false}}) {
    if (!options.scenes.empty() && !part.is_of_organ) continue;
    ProgressLine line(part.title);
    Studies own = part.run(options, [&](std::int64_t done, std::int64_t total) { line.show(done, total); });
    if (!own) return own.errors();
    std::move(own->begin(), own->end(), std::back_inserter(studies));
  }
  std::vector<bench::BenchStudy> all = bench::compare_costs(studies);
  std::move(studies.begin(), studies.end(), std::back_inserter(all));
  return all;
}

int run_bench(const BenchArguments& arguments) {
  if (const Result<Done> ready = reports::check_folder(arguments.folder); !ready) return print_errors(ready.errors());
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
      "bench",
      "Measures error against run time: integrators and steps, sphere radius, structure, lattice phase, what sleeps, "
      "tiling.");
  app->footer(
      "Examples: ctpm bench -o out/bench\n"
      "          ctpm bench my/liver.json -o out/bench");
  app->add_option("SCENE", arguments->options.scenes,
                  "Scenes whose first organ is studied; without any, the shipped ones in all ways");
  app->add_option("-o,--output", arguments->folder,
                  "Folder for report.html, results.json and results.csv; made if missing")
      ->required();
  app->add_option("--scenes", arguments->options.shipped, "Folder of the shipped scenes");
  app->add_flag("--quick", arguments->options.is_quick, "Coarser fillings and fewer settings, for a first look");
  return {app, [arguments] { return run_bench(*arguments); }};
}

}  // namespace ctpm::commands
