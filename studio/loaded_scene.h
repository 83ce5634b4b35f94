#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/result.h"
#include "importers/import.h"
#include "scenes/build_model.h"
#include "scenes/scene_file.h"
#include "studio/render/scene_view.h"

namespace ctpm {

/// A scene with everything that it names: its meshes read and filled, its Model built.
struct LoadedScene {
  std::string path;
  SceneText scene;
  std::vector<FilledOrgan> organs;    ///< (organ_count)
  std::vector<ImportReport> reports;  ///< of organs that come from meshes; empty ones for rigs   (organ_count)
  BuiltScene built;
};

/// Fills one organ of a scene: its mesh, or its rig. Errors: those of the mesh.
Result<ImportedOrgan> fill_of(const std::string& scene_path, const OrganSpec& organ);

/// Reads, imports and builds; `change` may alter what was read before anything is made of it. Prints nothing: the
/// warnings are in LoadedScene::scene. Errors: those of the scene, its meshes and its Model, all at once with their
/// places.
Result<LoadedScene> load_whole_scene(const std::string& path, const LoadOptions& options = {},
                                     const std::function<void(SceneSpec&)>& change = {});

/// What is drawn of a scene. `model` must outlive the view.
SceneView view_of(const SceneSpec& scene, const Model& model, std::vector<Surface> surfaces);

/// The surfaces of the organs, in their order.
std::vector<Surface> surfaces_of(const std::vector<FilledOrgan>& organs);

/// The least force on a tool that damages an organ of the scene [N]; 0: no organ has a limit. That of the depth
/// is in the Model (OrganRange::damage_depth).
double damage_force_of(const SceneSpec& scene);

/// The camera of that name; if the name is empty the scene's first, or one that has everything in sight.
/// Error: no camera of that name, with the names there are.
Result<Camera> find_camera(const SceneSpec& scene, const SceneView& view, const std::string& name, double aspect);

}  // namespace ctpm
