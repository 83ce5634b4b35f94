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

/// Reads a scene, imports its meshes and builds its Model. `change` may alter the scene between reading and importing.
/// Warnings are in LoadedScene::scene. Errors: those of the scene, its meshes and its Model, all at once, with places.
Result<LoadedScene> load_whole_scene(const std::string& path, const LoadOptions& options = {},
                                     const std::function<void(SceneSpec&)>& change = {});

/// The Model of a loaded scene after `change`; the meshes are not read again. Errors: those of build_model().
Result<BuiltScene> build_changed(const LoadedScene& scene, const std::function<void(SceneSpec&)>& change);

/// The surfaces of the organs, in their order.
std::vector<Surface> surfaces_of(const std::vector<FilledOrgan>& organs);

/// The least force on a tool that damages an organ of the scene [N]; 0: no organ has a limit. That of the depth
/// is in the Model (OrganRange::damage_depth).
double damage_force_of(const SceneSpec& scene);

}  // namespace ctpm
