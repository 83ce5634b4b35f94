#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "importers/import.h"
#include "scenes/scene_spec.h"

namespace ctpm::authoring {

/// Which closed parts of a mesh file become tissue.
enum class Parts {
  each,        ///< every one of at least a hundredth of the largest's volume, at most kMostOrgans, is an organ
  largest,     ///< only the largest
  all_in_one,  ///< all together are one organ
};

/// Organs that an import makes of one file; smaller parts are dropped.
inline constexpr std::size_t kMostOrgans = 8;

/// A layer that an organ gets.
struct LayerWish {
  std::string tissue;   ///< a preset or own material, as ImportRequest::organ
  double to_depth = 0;  ///< below the surface [m], > 0
};

/// The options of an import.
struct ImportRequest {
  std::string mesh;                      ///< mesh file
  std::string scene;                     ///< scene file to write (.json); meshes and script are written beside it
  bool into = false;                     ///< `scene` is there already; the organs are added to it
  std::string organ;                     ///< name of a preset or own material; empty: from names in the file, else any
  std::optional<double> unit_in_metres;  ///< unset: the file's, else guessed
  std::optional<double> size;            ///< diagonal of the file's box, in place of a unit [m]
  double scale = 1;                      ///< multiplies the size that the unit gives
  std::optional<double> sphere_radius;   ///< [m]; unset: see `spheres`
  std::optional<double> gap;             ///< [m]; unset: the radius
  std::optional<std::int64_t> spheres;   ///< wanted in all; unset: see `kilohertz`
  std::optional<double> kilohertz;  ///< as many as hold this rate here; unset: as usual, and no more than hold 1 kHz
  std::vector<std::string> names;   ///< of the meshes or labels to take; empty: all, or the only label
  Parts parts = Parts::each;
  std::vector<LayerWish> layers;  ///< of every organ, outermost first
  Vec3 at, turn;                  ///< OrganSpec::at and OrganSpec::turn of every organ
  bool beside = false;            ///< with `into`, in place of `at`: on the ground of the scene's organs, right of them
  bool overwrite = false;         ///< replaces an existing scene, mesh or script
  std::optional<double> largest_hole;  ///< holes up to this diameter are filled [m]; unset: a tenth of the diagonal
  std::optional<std::int32_t> most_triangles;  ///< of the drawn surface; unset: as many as the mesh has
  std::optional<double> stiffness_scale;       ///< unset: fitted where the paper gives forces
  std::vector<scenes::AnchorSpec> anchors;     ///< empty: chosen so that the organ stands
  importers::Progress progress;
  std::function<bool()> should_stop{};  ///< true ends the import; nothing is written then
};

/// One organ of an import.
struct ImportedPart {
  std::string name;                       ///< of the organ in the scene
  std::string mesh_file;                  ///< written
  importers::ImportReport report;         ///< with the findings of all steps
  std::optional<double> stiffness_scale;  ///< fitted and stored; unset: it was not fitted
  std::string fit_problem;                ///< why there is no fit
  bool can_be_fitted_later = false;       ///< the fit was skipped only because it takes long
  std::size_t anchored = 0;               ///< spheres that never move
  double sag = 0, size = 0;               ///< largest way of a sphere while it settles; size of the organ [m]
  double most_force = 0;                  ///< of the script on a tool [N]
  Vec3 at;                                ///< OrganSpec::at [m]
  bool was_cut = false;                   ///< by the script
};

/// The files of an import, and its findings.
struct ImportOutcome {
  std::vector<ImportedPart> organs;  ///< at least one, largest first
  std::string scene_file;            ///< ImportRequest::scene
  std::string script_file;           ///< written beside the scene
  double tick_time = 0;              ///< of the whole scene at rest, on this machine [s]
  double dearest_time = 0;           ///< of its ticks where the scripts press and cut the new organs, p99 [s]
};

/// Imports a mesh and writes a scene that runs without changes: `NAME.json` with its stiffness fitted, each repaired
/// mesh in millimetres, and a script `NAME.script.json` that presses and cuts every organ. Each organ is settled and
/// the script is tried: it stands, and is touched and cut, or a finding says that it is not. Makes the scene's folder.
/// Errors: those of the import, `should_stop`, an unknown organ, an anchor without spheres, an organ that folds over
/// whatever holds it, a folder that cannot be written, a file that exists already. The scene is written last, so that
/// it never names a missing file. A scene to which organs are added keeps its comments and its layout.
Result<ImportOutcome> import_scene(const ImportRequest& request);

}  // namespace ctpm::authoring
