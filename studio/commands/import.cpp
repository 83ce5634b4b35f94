#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "importers/import.h"
#include "importers/label_map.h"
#include "scenes/anchors.h"
#include "studio/authoring/import_scene.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/output/files.h"
#include "studio/output/json_writer.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"

namespace ctpm::commands {
namespace {

struct ImportArguments {
  authoring::ImportRequest request;
  std::string unit, report, label;
  std::optional<double> radius_mm, gap_mm, largest_hole_mm;
  std::optional<std::int64_t> most_triangles;
  std::vector<std::string> anchors;
};

/// Checks the arguments, with all errors at once, and converts them to SI.
Errors complete(ImportArguments& a) {
  Errors errors;
  const std::map<std::string, double> units{{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}};
  if (!a.unit.empty() && !units.contains(a.unit))
    errors.push_back({"--unit", "got '" + a.unit + "', must be mm, cm, m or in", ""});
  else if (!a.unit.empty())
    a.request.unit_in_metres = units.at(a.unit);
  if (a.radius_mm && !(*a.radius_mm > 0 && *a.radius_mm <= 100))
    errors.push_back({"--radius-mm", "got " + output::fixed(*a.radius_mm, 3) + ", must be in (0, 100]", ""});
  else if (a.radius_mm)
    a.request.sphere_radius = 1e-3 * *a.radius_mm;
  if (a.gap_mm && !(*a.gap_mm >= 0 && *a.gap_mm <= 100))
    errors.push_back({"--gap-mm", "got " + output::fixed(*a.gap_mm, 3) + ", must be in [0, 100]", ""});
  else if (a.gap_mm)
    a.request.gap = 1e-3 * *a.gap_mm;
  if (a.largest_hole_mm && !(*a.largest_hole_mm >= 0 && *a.largest_hole_mm <= 10000))
    errors.push_back(
        {"--largest-hole-mm", "got " + output::fixed(*a.largest_hole_mm, 3) + ", must be in [0, 10000]", ""});
  else if (a.largest_hole_mm)
    a.request.largest_hole = 1e-3 * *a.largest_hole_mm;
  if (a.most_triangles && !(*a.most_triangles >= 100 && *a.most_triangles <= 10'000'000))
    errors.push_back(
        {"--most-triangles", "got " + std::to_string(*a.most_triangles) + ", must be in [100, 10000000]", ""});
  else if (a.most_triangles)
    a.request.most_triangles = std::int32_t(*a.most_triangles);
  for (const std::string& text : a.anchors) {
    const Result<scenes::AnchorSpec> anchor = scenes::parse_anchor(text);
    if (anchor)
      a.request.anchors.push_back(*anchor);
    else
      errors.push_back({"--anchor", anchor.errors().front().message, ""});
  }
  if (!a.report.empty())
    if (const Result<Done> writable = output::check_new(a.report, a.request.overwrite); !writable)
      errors.insert(errors.end(), writable.errors().begin(), writable.errors().end());
  return errors;
}

void write_point(output::JsonWriter& json, const char* name, Vec3 p) {
  json.key(name).begin_list().value(p.x * 1e3).value(p.y * 1e3).value(p.z * 1e3).end_list();
}

std::string report_json(const importers::ImportReport& r, const authoring::ImportOutcome& outcome) {
  output::JsonWriter json;
  json.begin_object()
      .member("mesh", r.path)
      .member("format", r.format)
      .member("unit", importers::unit_name(r.unit.in_metres));
  const char* sources[] = {"given", "file", "guessed"};
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
      .member("mean_distance_mm", r.fill.mean_distance * 1e3);
  json.member("anchored", outcome.anchored);
  if (outcome.stiffness_scale) json.member("stiffness_scale", *outcome.stiffness_scale);
  json.key("spheres_per_layer").begin_list();
  for (const std::int64_t count : r.fill.spheres_per_layer) json.value(count);
  json.end_list().end_object().key("findings").begin_list();
  for (const importers::Finding& f : r.findings) {
    json.begin_object().member("code", f.code).member("count", f.count);
    if (f.place) write_point(json, "place_mm", *f.place);
    json.member("found", f.found).member("done", f.done).member("remains", f.remains).end_object();
  }
  return json.end_list().end_object().text();
}

/// If the organ has few spheres, suggests a smaller radius.
void suggest_radius(const importers::ImportReport& report) {
  constexpr double kFew = 200, kLively = 800;
  if (double(report.fill.spheres) >= kFew) return;
  const double radius = report.sphere_radius * 1e3 * std::cbrt(double(report.fill.spheres) / kLively);
  print("note: %lld spheres are few for this organ; --radius-mm %.1f would give about %.0f\n",
        (long long)report.fill.spheres, std::max(0.1, std::floor(radius * 10) / 10), kLively);
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

int run_import(ImportArguments& arguments) {
  const std::string& mesh = arguments.request.mesh;
  const bool is_map = importers::is_label_map(mesh);
  if (is_map && arguments.request.scene.empty()) return list_labels(mesh);
  if (arguments.request.scene.empty()) return print_errors({{"--output", "is required", ""}});
  if (!is_map && !arguments.label.empty())
    return print_errors({{"--label", "only label maps (.nii, .nii.gz, .nrrd) have labels", "--part names a mesh"}});
  if (is_map && !arguments.label.empty()) arguments.request.part = arguments.label;
  if (const Errors errors = complete(arguments); !errors.empty()) return print_errors(errors);
  ProgressLine progress("importing");
  arguments.request.progress = [&](const std::string&, double fraction) {
    progress.show(std::int64_t(1000 * fraction), 1000);
  };
  const Result<authoring::ImportOutcome> outcome = authoring::import_scene(arguments.request);
  if (!outcome) return print_errors(outcome.errors());
  if (!arguments.report.empty())
    if (const Result<Done> written = output::write_text_file(arguments.report, report_json(outcome->report, *outcome));
        !written)
      return print_errors(written.errors());
  print("%s", importers::to_text(outcome->report).c_str());
  print("anchored: %zu spheres never move\n", outcome->anchored);
  if (outcome->stiffness_scale)
    print("stiffness_scale: %.6g, fitted so that the paper's ball meets its Table 1 at 12 mm\n",
          *outcome->stiffness_scale);
  else
    print("stiffness_scale: not fitted, the preset's moduli stay: %s%s\n", outcome->fit_problem.c_str(),
          outcome->can_be_fitted_later ? ("; run ctpm fit " + outcome->scene_file + " --write").c_str() : "");
  suggest_radius(outcome->report);
  const std::string scene = arguments.request.scene, stem = scene.substr(0, scene.size() - 5);
  print("written: %s, %s, %s\n", scene.c_str(), outcome->mesh_file.c_str(), outcome->script_file.c_str());
  print("next: ctpm record %s --script %s -o %s.ctpm\n", scene.c_str(), outcome->script_file.c_str(), stem.c_str());
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
      "          ctpm import segmentation.nii.gz --label 3 --organ liver -o my/liver.json");
  app->add_option("mesh", arguments->request.mesh,
                  "Mesh (OBJ, STL, PLY, glTF, VTK, MSH, ...) or label map (.nii, .nii.gz, .nrrd)")
      ->required();
  app->add_option("-o,--output", arguments->request.scene,
                  "Scene file to write (.json); without it, the labels of a label map are listed");
  app->add_option("--label", arguments->label, "Name or number of the label to take from a label map");
  app->add_option("--organ", arguments->request.organ, "Material preset: liver, kidney, skin, or with -pa-s");
  app->add_option("--unit", arguments->unit, "Unit of the mesh file: mm, cm, m, in; guessed if not given");
  app->add_option("--radius-mm", arguments->radius_mm, "Radius of the spheres; the preset's if not given");
  app->add_option("--gap-mm", arguments->gap_mm, "Gap between their surfaces; the radius if not given");
  app->add_option("--part", arguments->request.part, "Name of the mesh to take, if the file holds several");
  app->add_flag("--all-parts", arguments->request.all_parts, "Keep every closed part, not only the largest");
  app->add_option("--largest-hole-mm", arguments->largest_hole_mm,
                  "Holes up to this diameter are filled; a tenth of the mesh's diagonal if not given");
  app->add_option("--most-triangles", arguments->most_triangles,
                  "Draw a coarser surface if the mesh has more triangles; the spheres stay the same");
  app->add_option("--anchor", arguments->anchors,
                  "What never moves: lowest:MM, box:..., sphere:..., plane:... (repeatable)");
  app->add_option("--report", arguments->report, "Write the report as JSON");
  app->add_flag("--overwrite", arguments->request.overwrite, "Replace existing files");
  return {app, [arguments] { return run_import(*arguments); }};
}

}  // namespace ctpm::commands
