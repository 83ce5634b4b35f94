#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/presets.h"
#include "studio/calibrate/report.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/stop_signal.h"
#include "studio/output/files.h"

namespace ctpm::commands {
namespace {

struct CalibrateArguments {
  std::vector<std::string> files;
  std::string folder, name = "calibrated", preset = "liver";
  std::optional<double> ball_mm;
  int starts = 5;
};

Result<std::vector<calibrate::Measurement>> read_all(const std::vector<std::string>& files) {
  std::vector<calibrate::Measurement> all;
  Errors errors;
  for (const std::string& file : files) {
    const Result<std::string> text = output::read_text_file(file);
    const Result<std::vector<calibrate::Measurement>> read =
        text ? calibrate::read_measurements(*text, file) : text.errors();
    if (read)
      all.insert(all.end(), read->begin(), read->end());
    else
      errors.insert(errors.end(), read.errors().begin(), read.errors().end());
  }
  if (!errors.empty()) return errors;
  return all;
}

void print_fit(const calibrate::Fit& fit) {
  for (const calibrate::Estimate& one : fit.estimates) {
    const std::string interval = calibrate::interval_text(one);
    print("%-24s %s%s\n", one.key.c_str(), calibrate::told(one).c_str(),
          interval.empty() ? "" : (" (" + interval + ")").c_str());
  }
  for (const std::string& remark : calibrate::remarks_of(fit)) print("%s\n", remark.c_str());
}

int run_calibrate(const CalibrateArguments& arguments) {
  const Result<std::vector<calibrate::Measurement>> measurements = read_all(arguments.files);
  Errors errors;
  if (!measurements) errors = measurements.errors();
  if (scenes::find_preset(arguments.preset) == nullptr) {
    std::string known;
    for (const std::string& name : scenes::preset_names()) known += (known.empty() ? "" : ", ") + name;
    errors.push_back({"--preset", "there is no preset " + arguments.preset, "one of " + known});
  }
  if (!errors.empty()) return print_errors(errors);
  const Result<loading::LoadedScene> rig =
      loading::load_whole_scene(std::string(CTPM_SOURCE_DIR) + "/scenes/paper/rig-liver.json");
  if (!rig) return print_errors(rig.errors());
  const StopSignal stop;
  calibrate::FitRequest request;
  request.start.preset = arguments.preset;
  if (arguments.ball_mm) request.start.calibration_ball = 1e-3 * *arguments.ball_mm;
  request.starts = arguments.starts;
  request.should_stop = [&] { return stop.came(); };
  const Result<calibrate::Fit> fit = [&] {
    ProgressLine progress("simulating");
    request.progress = [&](std::size_t simulations) { progress.show(std::int64_t(simulations), 0); };
    return calibrate::fit_material(*rig, *measurements, request);
  }();
  if (!fit) return print_errors(fit.errors());
  if (const Result<Done> written =
          calibrate::write_calibration(*fit, arguments.name, arguments.preset, arguments.folder);
      !written)
    return print_errors(written.errors());
  print_fit(*fit);
  print_remark("written: " + arguments.folder + "/report.html, results.json, materials.json");
  return exit_good;
}

}  // namespace

Command add_calibrate(CLI::App& program) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* app = program.add_subcommand("calibrate", "Fits a material to measurements of an author's own tissue.");
  app->footer(
      "Example: ctpm calibrate relaxation.csv creep.csv --ball-radius-mm 10 --name tumour -o my/tumour\n"
      "Columns: depth_mm, force_n of a slow indentation; time_s, depth_mm, force_n of a relaxation;\n"
      "time_s, load_n, depth_mm of creep; specimen beside them where a file holds several.");
  app->add_option("data", arguments->files, "Measurements (.csv)")->required();
  app->add_option("-o,--output", arguments->folder, "Folder for report.html, results.json and materials.json")
      ->required();
  app->add_option("--name", arguments->name, "Name of the material")->capture_default_str();
  app->add_option("--preset", arguments->preset, "Where the fit starts, and where what the data cannot tell comes from")
      ->capture_default_str();
  app->add_option("--ball-radius-mm", arguments->ball_mm, "Radius of the ball that pressed; the preset's if not given")
      ->check(CLI::Range(0.1, 100.0));
  app->add_option("--starts", arguments->starts, "Starts of the fit")->check(CLI::Range(1, 100))->capture_default_str();
  return {app, [arguments] { return run_calibrate(*arguments); }};
}

}  // namespace ctpm::commands
