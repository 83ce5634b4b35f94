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

namespace ctpm::loading {

/// A scene with its meshes read and filled and its Model built.
struct LoadedScene {
  std::string path;
  scenes::SceneText scene;
  std::vector<FilledOrgan> organs;               ///< (organ_count)
  std::vector<importers::ImportReport> reports;  ///< of organs from meshes; empty for rigs (organ_count)
  std::vector<scenes::ObstacleMesh> obstacles;   ///< (obstacle_count)
  scenes::BuiltScene built;
};

/// Fills one organ of a scene: its mesh, whose lattice `lattice_shift` moves by so many spacings
/// (importers::FillOptions), or its rig. Places in the report of a mesh are those of its file. Errors: those of the
/// mesh. `should_stop`, if given, ends it with an error.
Result<importers::ImportedOrgan> fill_of(const std::string& scene_path, const scenes::OrganSpec& organ,
                                         const std::function<bool()>& should_stop = {}, Vec3 lattice_shift = {},
                                         const importers::Progress& progress = {});

/// Moves a filled organ [m]: its spheres lie in it alike wherever it is.
void move_organ(FilledOrgan& organ, Vec3 by);

/// Reads a scene, imports its meshes and builds its Model. `change` may alter the scene between reading and importing.
/// `should_stop`, if given, ends it with an error; `progress` gets the stage and the fraction of the meshes that are
/// filled. Warnings are in LoadedScene::scene. Errors: those of the scene, its meshes and its Model, all at once, with
/// places.
Result<LoadedScene> load_whole_scene(const std::string& path, const scenes::LoadOptions& options = {},
                                     const std::function<void(scenes::SceneSpec&)>& change = {},
                                     const std::function<bool()>& should_stop = {},
                                     const importers::Progress& progress = {});

/// The Model of a loaded scene after `change`; the meshes are not read again. Errors: those of build_model().
Result<scenes::BuiltScene> build_changed(const LoadedScene& scene,
                                         const std::function<void(scenes::SceneSpec&)>& change);

/// Smallest damage limit of the organs for the force on a tool [N]; 0 if no organ has one. The depth limits are in the
/// Model (OrganRange::damage_depth).
double damage_force_of(const scenes::SceneSpec& scene);

}  // namespace ctpm::loading
