#include "scenes/scene_file.h"

#include <filesystem>
#include <memory>

#include "scenes/field_reader.h"
#include "scenes/field_writer.h"
#include "scenes/json_text.h"
#include "scenes/place_texts.h"
#include "scenes/scene_keys.h"
#include "scenes/scene_rules.h"

namespace ctpm::scenes {
namespace {

namespace fs = std::filesystem;

bool leaves_folder(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

/// Whether a file lies outside the scene's folder once symbolic links are followed.
bool is_linked_outside(const std::string& path, const std::string& scene_path) {
  std::error_code failure;
  const fs::path parent = fs::path(scene_path).parent_path(),
                 folder = fs::weakly_canonical(parent.empty() ? fs::path(".") : parent, failure);
  if (failure) return true;
  const fs::path file = fs::weakly_canonical(path, failure);
  return failure || leaves_folder(file.lexically_relative(folder).string());
}

/// Checks the files that a scene names.
void check_files(Problems& problems, const SceneSpec& scene, const std::string& scene_path,
                 const LoadOptions& options) {
  const auto check = [&](const std::string& at, const std::string& mesh) {
    if (mesh.empty()) return;
    const std::string path = mesh_path(scene_path, mesh);
    std::error_code ignored;
    if (leaves_folder(mesh) && !options.allow_outside_paths)
      problems.add_rule(at, "got " + in_quotes(mesh) + ", which leaves the scene's folder",
                        "put the mesh beside the scene, or allow meshes outside it");
    else if (!options.allow_outside_paths && is_linked_outside(path, scene_path))
      problems.add_rule(at, in_quotes(mesh) + " is a link that leaves the scene's folder",
                        "put the mesh beside the scene, or allow meshes outside it");
    else if (!fs::exists(path, ignored))
      problems.add_rule(at, "there is no file " + in_quotes(mesh) + " in the scene's folder", "looked for " + path);
    else if (!fs::is_regular_file(path, ignored))
      problems.add_rule(at, in_quotes(mesh) + " is not a file");
  };
  for (std::size_t i = 0; i < scene.organs.size(); ++i)
    check("/organs/" + std::to_string(i) + "/mesh", scene.organs[i].mesh);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    check("/obstacles/" + std::to_string(i) + "/mesh", scene.obstacles[i].mesh);
}

/// The scene if nothing is wrong with it.
Result<SceneText> without_errors(Result<SceneDraft> draft) {
  if (!draft) return draft.errors();
  for (const std::string& pointer : draft->open_places)
    draft->problems.add_rule(pointer, "is a place on an organ, which is not known here", "write its coordinates");
  if (!draft->problems.is_empty()) return draft->problems.errors();
  return std::move(draft->scene);
}

}  // namespace

Result<SceneDraft> read_draft(std::string_view text, const std::string& file_name, PlaceFinder* finder) {
  Result<JsonNode> parsed = parse_json(text, file_name);
  if (!parsed) return parsed.errors();
  const auto root = std::make_shared<JsonNode>(*std::move(parsed));
  SceneDraft draft;
  draft.scene.text = std::string(text);
  draft.scene.places = TextPlaces(root, file_name);
  draft.problems = Problems(draft.scene.places);
  PlaceTexts places = find_places(*root, false, finder, draft.problems);
  draft.scene.found_text = with_coordinates(text, places.found);
  draft.open_places = std::move(places.open);
  FieldReader::read_record(*root, "", draft.problems, draft.scene.spec);
  check_rules(draft.problems, draft.scene.spec);
  draft.scene.warnings = draft.problems.warnings();
  return draft;
}

Result<SceneText> read_scene(std::string_view text, const std::string& file_name) {
  return without_errors(read_draft(text, file_name));
}

Result<SceneDraft> load_draft(const std::string& path, const LoadOptions& options, PlaceFinder* finder) {
  const Result<std::string> text = options.text ? Result<std::string>(*options.text) : text_of_file(path);
  if (!text) return text.errors();
  Result<SceneDraft> draft = read_draft(*text, path, finder);
  if (draft) check_files(draft->problems, draft->scene.spec, path, options);
  return draft;
}

Result<SceneText> load_scene(const std::string& path, const LoadOptions& options) {
  return without_errors(load_draft(path, options));
}

SceneDraft unknown_scene(const std::string& path) {
  SceneDraft draft;
  draft.problems.add("", {}, path + " cannot be read");
  return draft;
}

std::string mesh_path(const std::string& scene_path, const std::string& mesh) {
  return (fs::path(scene_path).parent_path() / mesh).lexically_normal().string();
}

std::string write_scene(const SceneSpec& spec) {
  SceneSpec copy = spec;  // the table is written for reading as well and asks for what can be changed
  return FieldWriter::record_text(copy, 0) + "\n";
}

}  // namespace ctpm::scenes
