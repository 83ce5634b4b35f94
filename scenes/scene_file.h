#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"
#include "scenes/places.h"
#include "scenes/problems.h"
#include "scenes/scene_spec.h"
#include "scenes/text_places.h"

namespace ctpm::scenes {

/// A scene that was read without an error.
struct SceneText {
  SceneSpec spec;
  std::string text;        ///< as it was read
  TextPlaces places;       ///< `file:line:col` of each value, for whoever judges it later
  std::string found_text;  ///< `text` with the coordinates of places by meaning, for a session to keep
  Errors warnings;         ///< what is odd about the scene though it runs; each with its place
};

/// A scene of which some values may be refused. Refused values keep their defaults; `problems` names them.
struct SceneDraft {
  SceneText scene;
  Problems problems;
  std::vector<std::string> open_places;  ///< pointers of places by meaning that need the filled organs to be found
};

/// Reads scene text. Reports every error at once, each with `file:line:col` and a message that begins with the JSON
/// pointer. A place by meaning is an error here, for there are no organs to find it on.
Result<SceneText> read_scene(std::string_view text, const std::string& file_name);

struct LoadOptions {
  bool allow_outside_paths = false;  ///< meshes may lie outside the scene's folder
  std::optional<std::string> text;   ///< read in place of the file's, which may be missing: an author is still writing
};

/// Reads a scene file and checks that its meshes exist. Errors: those of read_scene; the file or a mesh is missing; a
/// mesh lies outside the scene's folder.
Result<SceneText> load_scene(const std::string& path, const LoadOptions& options = {});

/// As read_scene and load_scene, but these return what could be read together with its errors, so that later stages
/// can add theirs. Places by meaning are found with `finder`, to which the scene's probes are added; without one they
/// are left open. Errors: the file cannot be read, or is not JSON; then no value can be judged.
Result<SceneDraft> read_draft(std::string_view text, const std::string& file_name, PlaceFinder* finder = nullptr);
Result<SceneDraft> load_draft(const std::string& path, const LoadOptions& options = {}, PlaceFinder* finder = nullptr);

/// The draft of a scene of which nothing is known: its file cannot be read, or is not JSON.
SceneDraft unknown_scene(const std::string& path);

/// Path of an organ's mesh, relative to the program's working directory.
std::string mesh_path(const std::string& scene_path, const std::string& mesh);

/// Text of a scene. The same spec gives the same text, and read_scene gives the same spec again.
std::string write_scene(const SceneSpec& spec);

/// The text of a scene, changed from `before`, which it says, to `after`: comments, layout and what stays the same are
/// kept. write_scene(after) where that cannot be done.
std::string rewrite_scene(const std::string& text, const SceneSpec& before, const SceneSpec& after);

}  // namespace ctpm::scenes
