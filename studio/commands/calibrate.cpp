#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/model/errors.h"
#include "scenes/materials_file.h"
#include "scenes/presets.h"
#include "studio/calibrate/block.h"
#include "studio/calibrate/report.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/stop_signal.h"
#include "studio/output/files.h"
#include "studio/reports/report.h"

namespace ctpm::commands {
namespace {

struct CalibrateArguments {
  std::vector<std::string> files;
  std::string folder, name = "calibrated", preset = "liver";
  std::optional<double> ball_mm, sphere_mm;
  std::vector<double> specimen_mm;  ///< x, y, z; empty: the rig stands for the specimen
  int starts = 5;
  bool overwrite = false;
};

Result<std::vector<calibrate::Measurement>> read_all(const std::vector<std::string>& files) {
  std::vector<calibrate::Measurement> all;
  Errors errors;
  std::set<std::filesystem::path> seen;
  for (const std::string& file : files) {
    std::error_code ignored;
    if (!seen.insert(std::filesystem::weakly_canonical(file, ignored)).second) {
      errors.push_back({file, "is the same file as another one that is named", "name it once"});
      continue;
    }
    const Result<std::string> text = output::read_text_file(file);
    const Result<std::vector<calibrate::Measurement>> read =
        text ? calibrate::read_measurements(*text, file) : text.errors();
    if (read) all.insert(all.end(), read->begin(), read->end());
    append(errors, read);
  }
  if (!errors.empty()) return errors;
  return all;
}

void print_fit(const calibrate::Fit& fit, const std::vector<calibrate::SpecimenFit>& specimens) {
  for (const calibrate::Estimate& one : fit.estimates) {
    const std::string interval = calibrate::interval_text(one);
    print("%-24s %s%s\n", one.key.c_str(), calibrate::told(one).c_str(),
          interval.empty() ? "" : (" (" + interval + ")").c_str());
  }
  for (const std::string& remark : calibrate::remarks_of(fit, specimens)) print("%s\n", remark.c_str());
}

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes";

scenes::MaterialSpec start_of(const CalibrateArguments& arguments) {
  scenes::MaterialSpec start;
  start.preset = arguments.preset;
  if (arguments.ball_mm) start.calibration_ball = 1e-3 * *arguments.ball_mm;
  return start;
}

/// The specimen's block, if its size is given. Adds what is wrong with it, or with the preset.
std::optional<loading::LoadedScene> block_of(const CalibrateArguments& arguments, Errors& errors) {
  if (scenes::find_preset(arguments.preset) == nullptr) {
    std::string known;
    for (const std::string& name : scenes::preset_names()) known += (known.empty() ? "" : ", ") + name;
    errors.push_back({"--preset", "there is no preset " + arguments.preset, "one of " + known});
    return {};
  }
  const std::vector<double>& size = arguments.specimen_mm;
  if (size.empty()) {
    if (arguments.sphere_mm)
      errors.push_back({"--sphere-radius-mm", "is of a specimen's block", "--specimen-mm X Y Z"});
    return {};
  }
  Result<loading::LoadedScene> block =
      calibrate::make_block(kScenes, start_of(arguments), {size[0], size[1], size[2]}, arguments.sphere_mm);
  if (block) return std::move(*block);
  append(errors, block);
  return {};
}

/// The text of the materials that are in the folder and stay there; empty if there are none. Adds what is wrong with
/// them, or with the name among them.
std::string materials_beside(const CalibrateArguments& arguments, Errors& errors) {
  if (scenes::find_preset(arguments.name) != nullptr || arguments.name.empty()) {
    errors.push_back({"--name", arguments.name.empty() ? "is empty" : arguments.name + " is a preset of the program",
                      "give the material a name of its own"});
    return "";
  }
  const std::string path = (std::filesystem::path(arguments.folder) / scenes::kMaterialsFile).string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return "";
  const Result<std::string> text = output::read_text_file(path);
  const Result<std::vector<scenes::NamedMaterial>> materials =
      text ? scenes::read_materials(*text, path) : text.errors();
  append(errors, materials);
  if (!materials) return "";
  const bool is_taken =
      std::ranges::any_of(*materials, [&](const scenes::NamedMaterial& one) { return one.name == arguments.name; });
  if (is_taken && !arguments.overwrite)
    errors.push_back({path, "has a material " + arguments.name + " already",
                      "give another name with --name, or replace it with --overwrite"});
  return *text;
}

int run_calibrate(const CalibrateArguments& arguments) {
  const Result<std::vector<calibrate::Measurement>> measurements = read_all(arguments.files);
  Errors errors;
  append(errors, measurements);
  const std::optional<loading::LoadedScene> block = block_of(arguments, errors);
  append(errors, reports::check_folder(arguments.folder));
  const std::string materials = materials_beside(arguments, errors);
  if (!errors.empty()) return print_errors(errors);
  const Result<loading::LoadedScene> rig = loading::load_whole_scene(kScenes + "/paper/rig-liver.json");
  if (!rig) return print_errors(rig.errors());
  const StopSignal stop;
  calibrate::FitRequest request;
  request.start = start_of(arguments);
  request.starts = arguments.starts;
  request.should_stop = [&] { return stop.came(); };
  request.threads = std::max(1, int(std::thread::hardware_concurrency()));
  const Result<calibrate::Fit> fit = [&] {
    ProgressLine progress("simulating");
    request.progress = [&](std::size_t simulations) { progress.show(std::int64_t(simulations), 0); };
    Result<calibrate::Fit> on_rig = calibrate::fit_material(*rig, *measurements, request);
    if (!on_rig || !block) return on_rig;
    // From there the block has not far to go, and its runs take much longer.
    request.start = on_rig->material, request.starts = 1;
    return calibrate::fit_material(*block, *measurements, request);
  }();
  if (!fit) return print_errors(fit.errors());
  const Result<std::vector<calibrate::SpecimenFit>> specimens =
      calibrate::fit_specimens(block ? *block : *rig, *measurements, *fit, request);
  if (!specimens) return print_errors(specimens.errors());
  if (const Result<Done> written = calibrate::write_calibration(
          *fit, *specimens, {arguments.name, arguments.preset, materials}, arguments.folder);
      !written)
    return print_errors(written.errors());
  print_fit(*fit, *specimens);
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
  app->add_option("-o,--output", arguments->folder,
                  "Folder for report.html, results.json and materials.json, whose other materials stay")
      ->required();
  app->add_option("--name", arguments->name, "Name of the material")->capture_default_str();
  app->add_option("--preset", arguments->preset, "Where the fit starts, and where what the data cannot tell comes from")
      ->capture_default_str();
  app->add_option("--ball-radius-mm", arguments->ball_mm, "Radius of the ball that pressed; the preset's if not given")
      ->check(CLI::Range(0.1, 100.0));
  app->add_option("--specimen-mm", arguments->specimen_mm,
                  "Size of the specimen, which lies on a plate and is pressed on the middle of its top: x y thickness; "
                  "if not given, the paper's rig of five spheres stands for it")
      ->expected(3)
      ->check(CLI::Range(1.0, 1000.0));
  app->add_option("--sphere-radius-mm", arguments->sphere_mm,
                  "Of the spheres in the specimen; the preset's if not given")
      ->check(CLI::Range(0.1, 100.0));
  app->add_flag("--overwrite", arguments->overwrite, "Replace a material of that name in the folder's materials.json");
  app->add_option("--starts", arguments->starts, "Starts of the fit")->check(CLI::Range(1, 100))->capture_default_str();
  return {app, [arguments] { return run_calibrate(*arguments); }};
}

}  // namespace ctpm::commands
