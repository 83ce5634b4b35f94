#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "importers/import.h"
#include "scenes/scene_spec.h"

namespace ctpm::authoring {

/// The options of an import.
struct ImportRequest {
  std::string mesh;                      ///< mesh file
  std::string scene;                     ///< scene file to write (.json); mesh and script are written beside it
  std::string organ;                     ///< name of a material preset; empty: taken from the mesh's file name
  std::optional<double> unit_in_metres;  ///< unset: the file's, else guessed
  std::optional<double> sphere_radius;   ///< [m]; unset: the preset's
  std::optional<double> gap;             ///< [m]; unset: the radius
  std::string part;
  bool all_parts = false;
  bool overwrite = false;              ///< replaces an existing scene, mesh or script
  std::optional<double> largest_hole;  ///< holes up to this diameter are filled [m]; unset: a tenth of the diagonal
  std::optional<std::int32_t> most_triangles;  ///< of the drawn surface; unset: as many as the mesh has
  std::vector<scenes::AnchorSpec> anchors;     ///< empty: the lowest eighth of its spheres
  importers::Progress progress;
  std::function<bool()> should_stop{};  ///< true ends the import; nothing is written then
};

/// The files of an import, and its findings.
struct ImportOutcome {
  importers::ImportReport report;
  std::string scene_file;                 ///< ImportRequest::scene
  std::string mesh_file, script_file;     ///< written beside the scene
  std::optional<double> stiffness_scale;  ///< fitted and stored; unset: it could not be fitted
  std::string fit_problem;                ///< why there is no fit
  bool can_be_fitted_later = false;       ///< the fit was skipped only because it takes long
  std::size_t anchored = 0;               ///< spheres that never move
};

/// Imports a mesh and writes a scene that runs without changes: `NAME.json` with its stiffness fitted, the repaired
/// mesh `NAME.obj` in millimetres, and a script `NAME.script.json` that presses and cuts it. Errors: those of the
/// import, `should_stop`, an unknown organ, an anchor without spheres, a folder that cannot be written, a file that
/// exists already. The scene is written last, so that it never names a missing file.
Result<ImportOutcome> import_scene(const ImportRequest& request);

}  // namespace ctpm::authoring
