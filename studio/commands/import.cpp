#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/model/errors.h"
#include "importers/import.h"
#include "importers/label_map.h"
#include "scenes/anchors.h"
#include "studio/authoring/import_scene.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/stop_signal.h"
#include "studio/output/files.h"
#include "studio/output/json_writer.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"

namespace ctpm::commands {
namespace {

struct ImportArguments {
  authoring::ImportRequest request;
  std::string unit, report, into;
  std::optional<double> radius_mm, gap_mm, largest_hole_mm, size_mm, scale, khz, stiffness_scale;
  std::optional<std::int64_t> most_triangles, spheres;
  std::vector<std::string> anchors, labels, parts, layers;
  std::vector<double> at_mm, turn_deg;
  bool largest_part = false, all_parts = false;
};

/// A number that was given: an error if it is out of range, else `take` gets it.
template <class T, class Take>
void take_number(Errors& errors, const char* flag, const std::optional<T>& value, double least, double most,
                 const Take& take) {
  if (!value) return;
  if (double(*value) >= least && double(*value) <= most) return take(*value);
  errors.push_back({flag,
                    "got " + output::short_number(double(*value)) + ", must be in [" + output::short_number(least, 8) +
                        ", " + output::short_number(most, 8) + "]",
                    ""});
}

/// A layer's text, "skin:6": its material and the depth to which it reaches [mm].
void take_layer(Errors& errors, const std::string& text, std::vector<authoring::LayerWish>& layers) {
  const std::size_t colon = text.rfind(':');
  const std::string number = colon == std::string::npos ? "" : text.substr(colon + 1);
  char* end = nullptr;
  const double depth = std::strtod(number.c_str(), &end);
  const double above = layers.empty() ? 0 : 1e3 * layers.back().to_depth;
  if (colon == 0 || number.empty() || *end != '\0' || !(depth > above && depth <= 1000))
    return errors.push_back({"--layer",
                             "got '" + text +
                                 "', must be a material and the depth in mm to which it reaches, more than "
                                 "the layer's before it",
                             "skin:6"});
  layers.push_back({text.substr(0, colon), 1e-3 * depth});
}

/// Three numbers within a range, or none.
void take_vector(Errors& errors, const char* flag, const std::vector<double>& numbers, double most, double unit,
                 Vec3& value) {
  for (const double number : numbers)
    if (!(std::abs(number) <= most))
      return errors.push_back({flag,
                               "got " + output::short_number(number) + ", must be in [" + output::short_number(-most) +
                                   ", " + output::short_number(most) + "]",
                               ""});
  if (numbers.size() == 3) value = unit * Vec3{numbers[0], numbers[1], numbers[2]};
}

/// Checks the arguments, with all errors at once, and converts them to SI.
Errors complete(ImportArguments& a) {
  Errors errors;
  authoring::ImportRequest& r = a.request;
  const std::map<std::string, double> units{{"mm", 1e-3}, {"cm", 1e-2}, {"dm", 0.1}, {"m", 1.0}, {"in", 0.0254}};
  if (!a.unit.empty() && !units.contains(a.unit))
    errors.push_back({"--unit", "got '" + a.unit + "', must be mm, cm, dm, m or in", ""});
  else if (!a.unit.empty())
    r.unit_in_metres = units.at(a.unit);
  if (!a.unit.empty() && a.size_mm)
    errors.push_back({"--size-mm", "already says how large the mesh is", "leave out --unit"});
  take_number(errors, "--size-mm", a.size_mm, 0.1, 1e4, [&](double v) { r.size = 1e-3 * v; });
  take_number(errors, "--scale", a.scale, 1e-6, 1e6, [&](double v) { r.scale = v; });
  take_number(errors, "--radius-mm", a.radius_mm, 0.01, 100, [&](double v) { r.sphere_radius = 1e-3 * v; });
  take_number(errors, "--gap-mm", a.gap_mm, 0, 100, [&](double v) { r.gap = 1e-3 * v; });
  take_number(errors, "--spheres", a.spheres, double(50), 2e6, [&](std::int64_t v) { r.spheres = v; });
  take_number(errors, "--for-khz", a.khz, 0.05, 20, [&](double v) { r.kilohertz = v; });
  if ((a.radius_mm ? 1 : 0) + (a.spheres ? 1 : 0) + (a.khz ? 1 : 0) > 1)
    errors.push_back({"import", "takes one of --radius-mm, --spheres and --for-khz", ""});
  take_number(errors, "--largest-hole-mm", a.largest_hole_mm, 0, 10000, [&](double v) { r.largest_hole = 1e-3 * v; });
  take_number(errors, "--stiffness-scale", a.stiffness_scale, 1e-6, 1e6, [&](double v) { r.stiffness_scale = v; });
  take_number(errors, "--most-triangles", a.most_triangles, 100, 10'000'000,
              [&](std::int64_t v) { r.most_triangles = std::int32_t(v); });
  if (a.largest_part && a.all_parts) errors.push_back({"import", "takes one of --largest-part and --all-parts", ""});
  if (a.largest_part) r.parts = authoring::Parts::largest;
  if (a.all_parts) r.parts = authoring::Parts::all_in_one;
  if (r.scene.empty() == a.into.empty())
    errors.push_back({"import", "needs either -o with a new scene or --into with one that is there", ""});
  if (!a.into.empty()) r.scene = a.into, r.into = true;
  if (r.beside && !r.into) errors.push_back({"--beside", "needs a scene whose organs are there", "--into"});
  if (r.beside && !a.at_mm.empty()) errors.push_back({"import", "takes one of --beside and --at-mm", ""});
  take_vector(errors, "--at-mm", a.at_mm, 100000, 1e-3, r.at);
  take_vector(errors, "--turn-deg", a.turn_deg, 360, 1, r.turn);
  for (const std::string& text : a.layers) take_layer(errors, text, r.layers);
  r.names = a.labels.empty() ? a.parts : a.labels;
  for (const std::string& text : a.anchors) {
    const Result<scenes::AnchorSpec> anchor = scenes::parse_anchor(text);
    if (anchor)
      r.anchors.push_back(*anchor);
    else
      errors.push_back({"--anchor", anchor.errors().front().message, ""});
  }
  if (!a.report.empty()) append(errors, output::check_new(a.report, r.overwrite));
  return errors;
}

void write_point(output::JsonWriter& json, const char* name, Vec3 p) {
  json.key(name).begin_list().value(p.x * 1e3).value(p.y * 1e3).value(p.z * 1e3).end_list();
}

void write_organ(output::JsonWriter& json, const authoring::ImportedPart& organ) {
  const importers::ImportReport& r = organ.report;
  json.member("organ", organ.name).member("mesh", r.path).member("format", r.format);
  json.member("unit", importers::unit_name(r.unit.in_metres));
  const char* sources[] = {"given", "file", "guessed", "scaled"};
  json.member("unit_source", sources[int(r.unit.source)]).member("volume_ml", r.mesh_volume * 1e6);
  write_point(json, "box_least_mm", r.box_least), write_point(json, "box_most_mm", r.box_most);
  for (const auto& [name, counts] : {std::pair{"before", r.before}, std::pair{"after", r.after}}) {
    json.key(name).begin_object().member("vertices", counts.vertices).member("triangles", counts.triangles);
    json.member("parts", counts.parts).member("open_edges", counts.open_edges);
    json.member("non_manifold_edges", counts.non_manifold_edges).end_object();
  }
  json.key("filling").begin_object().member("radius_mm", r.sphere_radius * 1e3).member("spacing_mm", r.spacing * 1e3);
  json.member("surface_triangles", r.fill.surface_triangles);
  json.member("spheres", r.fill.spheres).member("edges", r.fill.edges).member("volume_ml", r.fill.filled_volume * 1e6);
  json.member("largest_distance_mm", r.fill.largest_distance * 1e3)
      .member("mean_distance_mm", r.fill.mean_distance * 1e3)
      .member("shape_error_p95_mm", r.fill.shape.p95 * 1e3)
      .member("shape_error_largest_mm", r.fill.shape.largest * 1e3);
  json.member("anchored", organ.anchored);
  if (organ.stiffness_scale) json.member("stiffness_scale", *organ.stiffness_scale);
  json.key("spheres_per_layer").begin_list();
  for (const std::int64_t count : r.fill.spheres_per_layer) json.value(count);
  json.end_list().end_object();
  json.member("sag_mm", organ.sag * 1e3).member("script_force_n", organ.most_force);
  json.member("script_cuts", organ.was_cut);
  json.key("findings").begin_list();
  for (const importers::Finding& f : r.findings) {
    json.begin_object().member("code", f.code).member("count", f.count);
    if (f.place) write_point(json, "place_mm", *f.place);
    json.member("found", f.found).member("done", f.done).member("remains", f.remains).end_object();
  }
  json.end_list();
}

/// The largest organ's members, and all organs in a list.
std::string report_json(const authoring::ImportOutcome& outcome) {
  output::JsonWriter json;
  json.begin_object();
  write_organ(json, outcome.organs.front());
  json.key("organs").begin_list();
  for (const authoring::ImportedPart& organ : outcome.organs) {
    json.begin_object();
    write_organ(json, organ);
    json.end_object();
  }
  json.end_list().member("tick_time_at_rest_s", outcome.tick_time).member("tick_time_p99_s", outcome.dearest_time);
  return json.end_object().text();
}

void print_organ(const authoring::ImportedPart& organ, const std::string& scene, bool is_one_of_many) {
  if (is_one_of_many) print("\norgan %s\n", organ.name.c_str());
  print("%s", importers::to_text(organ.report).c_str());
  if (!(organ.at == Vec3{}))
    print("placed: the mesh's origin lies at %g, %g, %g mm (at_mm)\n", 1e3 * organ.at.x, 1e3 * organ.at.y,
          1e3 * organ.at.z);
  print("anchored: %zu spheres never move\n", organ.anchored);
  if (organ.stiffness_scale)
    print("stiffness_scale: %.6g, fitted so that the paper's ball meets its Table 1 at 12 mm\n",
          *organ.stiffness_scale);
  else
    print("stiffness_scale: not fitted: %s%s\n", organ.fit_problem.c_str(),
          organ.can_be_fitted_later ? ("; run ctpm fit " + output::shell_word(scene) + " --write").c_str() : "");
  print("settled: sags by %.2f mm, %.1f %% of its size\n", 1e3 * organ.sag, 100 * organ.sag / organ.size);
  print("script: presses with up to %.2f N, and %s\n", organ.most_force, organ.was_cut ? "cuts" : "DOES NOT CUT");
}

/// Prints the labels of a segmentation, for an author who has not chosen one.
int list_labels(const std::string& map) {
  const Result<std::vector<importers::Label>> labels = importers::list_labels(map);
  if (!labels) return print_errors(labels.errors());
  print("%s: %zu labels\n", map.c_str(), labels->size());
  print("number  volume      name\n");
  for (const importers::Label& label : *labels)
    print("%6d  %8.1f ml  %s\n", int(label.number), label.volume * 1e6, label.name.c_str());
  print("next: ctpm import %s --label %s --organ liver -o my/organ.json\n", output::shell_word(map).c_str(),
        output::shell_word(labels->front().text()).c_str());
  return exit_good;
}

/// A session file that is not there yet, named after a script.
std::string new_session_of(const std::string& script) {
  const std::string stem = script.substr(0, script.size() - std::string(".script.json").size());
  std::string file = stem + ".ctpm";
  std::error_code ignored;
  for (int number = 2; std::filesystem::exists(file, ignored); ++number)
    file = stem + "-" + std::to_string(number) + ".ctpm";
  return file;
}

int run_import(ImportArguments& arguments) {
  const std::string& mesh = arguments.request.mesh;
  const bool is_map = importers::is_label_map(mesh);
  if (is_map && arguments.request.scene.empty() && arguments.into.empty()) return list_labels(mesh);
  if (!is_map && !arguments.labels.empty())
    return print_errors({{"--label", "only label maps (.nii, .nii.gz, .nrrd) have labels", "--part names a mesh"}});
  if (const Errors errors = complete(arguments); !errors.empty()) return print_errors(errors);
  const StopSignal stop;
  arguments.request.should_stop = [&] { return stop.came(); };
  const Result<authoring::ImportOutcome> outcome = [&] {
    ProgressLine progress("importing");
    progress.show(0, 1000);
    arguments.request.progress = [&](const std::string& stage, double fraction) {
      progress.add(stage);
      progress.show(std::int64_t(1000 * fraction), 1000);
    };
    return authoring::import_scene(arguments.request);
  }();
  if (!outcome) return print_errors(outcome.errors());
  if (!arguments.report.empty())
    if (const Result<Done> written = output::write_text_file(arguments.report, report_json(*outcome)); !written)
      return print_errors(written.errors());
  const std::string& scene = arguments.request.scene;
  std::string meshes;
  for (const authoring::ImportedPart& organ : outcome->organs) {
    print_organ(organ, scene, outcome->organs.size() > 1);
    meshes += ", " + organ.mesh_file;
  }
  print("time: %.2f ms a tick of 1 ms at rest, %.2f ms where the script presses and cuts (p99), on this machine now\n",
        1e3 * outcome->tick_time, 1e3 * outcome->dearest_time);
  print("written: %s%s, %s\n", scene.c_str(), meshes.c_str(), outcome->script_file.c_str());
  print("next: ctpm record %s --script %s -o %s\n", output::shell_word(scene).c_str(),
        output::shell_word(outcome->script_file).c_str(),
        output::shell_word(new_session_of(outcome->script_file)).c_str());
  return exit_good;
}

}  // namespace

Command add_import(CLI::App& program) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* app =
      program.add_subcommand("import", "Checks, repairs and fills a mesh, and writes a scene that runs as it is.");
  app->footer(
      "Examples: ctpm import liver.stl --organ liver --unit mm -o my/liver.json\n"
      "          ctpm import segmentation.nii.gz\n"
      "          ctpm import segmentation.nii.gz --label 3 --label 5 -o my/organs.json\n"
      "          ctpm import kidney.obj --into my/liver.json --beside --layer skin:6");
  app->add_option("mesh", arguments->request.mesh,
                  "Mesh (OBJ, STL, PLY, glTF, VTK, MSH, ...) or label map (.nii, .nii.gz, .nrrd)")
      ->required();
  app->add_option("-o,--output", arguments->request.scene,
                  "Scene file to write (.json); its folder is made; without it, the labels of a label map are listed");
  app->add_option("--label", arguments->labels,
                  "Name or number of a label to take from a label map (repeatable: each is an organ)")
      ->allow_extra_args(false);
  app->add_option("--into", arguments->into,
                  "Add the organs to this scene instead of writing a new one; its comments stay");
  app->add_flag("--beside", arguments->request.beside,
                "With --into: place the organs on the same ground, right of those of the scene");
  app->add_option("--at-mm", arguments->at_mm, "Where the mesh's origin lies in the scene: x y z")->expected(3);
  app->add_option("--turn-deg", arguments->turn_deg, "Turns the mesh about its origin: about x, then y, then z")
      ->expected(3);
  app->add_option("--layer", arguments->layers,
                  "A layer below the surface, MATERIAL:MM, as skin:6; repeatable, from the surface inwards")
      ->allow_extra_args(false);
  app->add_option("--organ", arguments->request.organ,
                  "Material: a preset (liver, kidney, skin, heart, lung, spleen, bladder, fat, muscle, soft-tissue) or "
                  "one of materials.json beside the scene; from names in the file if not given, else soft-tissue");
  app->add_option("--unit", arguments->unit,
                  "Unit of the mesh file: mm, cm, dm, m, in; from the file or the organ's usual size if not given");
  app->add_option("--size-mm", arguments->size_mm, "Diagonal of the box around the mesh, instead of a unit");
  app->add_option("--scale", arguments->scale, "Multiplies the size that the unit gives");
  app->add_option("--radius-mm", arguments->radius_mm, "Radius of the spheres");
  app->add_option("--spheres", arguments->spheres, "About so many spheres in all; the radius follows");
  app->add_option("--for-khz", arguments->khz,
                  "As many spheres as this machine holds at this rate, in contact and in a cut; if nothing is given, a "
                  "few hundred to 1500, and "
                  "no more than hold 1 kHz");
  app->add_option("--gap-mm", arguments->gap_mm, "Gap between their surfaces; the radius if not given");
  app->add_option("--part", arguments->parts,
                  "Name of a mesh to take, if the file holds several (repeatable: each is an organ)")
      ->allow_extra_args(false);
  app->add_flag("--largest-part", arguments->largest_part,
                "Keep only the largest closed part; else each of at least 1 % of its volume is an organ");
  app->add_flag("--all-parts", arguments->all_parts, "Keep every closed part, all as one organ");
  app->add_option("--largest-hole-mm", arguments->largest_hole_mm,
                  "Holes up to this diameter are closed by a cap; a tenth of the mesh's diagonal if not given");
  app->add_option("--most-triangles", arguments->most_triangles,
                  "Draw a coarser surface if the mesh has more triangles; the spheres stay the same");
  app->add_option("--stiffness-scale", arguments->stiffness_scale,
                  "Multiplies every stiffness; fitted to the paper's forces if not given");
  app->add_option("--anchor", arguments->anchors,
                  "What never moves: lowest:MM, box:..., sphere:..., plane:... (repeatable); chosen so that the organ "
                  "stands if not given");
  app->add_option("--report", arguments->report, "Write the report as JSON");
  app->add_flag("--overwrite", arguments->request.overwrite, "Replace existing files");
  return {app, [arguments] { return run_import(*arguments); }};
}

}  // namespace ctpm::commands
