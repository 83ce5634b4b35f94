#pragma once

#include <string>
#include <string_view>

#include "core/model/result.h"
#include "scenes/scene_spec.h"

namespace ctpm {

/// A scene and what is odd about it though it runs.
struct SceneText {
  SceneSpec spec;
  std::string text;  ///< as it was read
  Errors warnings;   ///< each with its place
};

/// Reads scene text. Every problem is reported, each as `file:line:col` and a message that begins with the
/// JSON pointer.
Result<SceneText> read_scene(std::string_view text, const std::string& file_name);

struct LoadOptions {
  bool allow_outside_paths = false;  ///< meshes may lie outside the scene's folder
};

/// Reads a scene file and checks that its meshes are there. Errors: those of read_scene; the file or a mesh
/// is missing or lies outside the scene's folder.
Result<SceneText> load_scene(const std::string& path, const LoadOptions& options = {});

/// Path of an organ's mesh as seen from where the program runs.
std::string mesh_path(const std::string& scene_path, const OrganSpec& organ);

/// Stable text of a scene; read_scene gives the same spec again.
std::string write_scene(const SceneSpec& spec);

}  // namespace ctpm
