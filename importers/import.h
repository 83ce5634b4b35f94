#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "importers/fill.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// Options of import_organ().
struct ImportOptions {
  std::optional<double>
      unit_in_metres;                  ///< length of one unit of the file [m], > 0; unset: from the file, else guessed
  std::optional<double> size;          ///< diagonal of the file's bounding box [m], > 0, in place of a unit
  double scale = 1;                    ///< multiplies the size that the unit gives, > 0
  Vec3 turn;                           ///< of the mesh about its origin, see turned() [degrees]
  UsualSize usual_size;                ///< usual size of this kind of organ, to guess the unit
  std::string part;                    ///< name of the mesh to take; empty: all, joined
  bool all_parts = false;              ///< keeps every closed part and sphere island, not only the largest
  std::optional<double> largest_hole;  ///< holes up to this diameter are filled [m]; unset: a tenth of the diagonal
  double sphere_radius = 0.004;        ///< r [m], > 0
  double gap = -1;                     ///< between the surfaces of neighbours [m], >= 0; negative: r
  Vec3 lattice_shift;                  ///< see FillOptions
  std::int64_t most_spheres = 2'000'000;  ///< more are refused
  std::int64_t most_triangles = 0;        ///< a drawn surface with more is coarsened; 0: never
  int threads = 2;                        ///< >= 1; the result does not depend on it
  double time_limit_s = 120;              ///< limit for reading the file [s]
  std::function<bool()> should_stop;      ///< asked between two stages; true ends the import with an error
  Progress progress;  ///< receives the stage and the fraction of the whole import; the fraction never falls
};

/// Findings in the file, repairs, and properties of the result.
struct ImportReport {
  std::string path;
  std::string format;
  std::vector<std::string> parts;  ///< names of all meshes in the file
  UnitChoice unit;
  MeshCounts before, after;               ///< mesh as read and as repaired
  double mesh_volume = 0;                 ///< [m^3]
  double mesh_area = 0;                   ///< [m^2]
  Vec3 box_least, box_most;               ///< [m]
  double sphere_radius = 0, spacing = 0;  ///< [m]
  FillReport fill;
  std::vector<Finding> findings;  ///< findings of all stages, in order
};

struct ImportedOrgan {
  FilledOrgan organ;
  CheckedMesh mesh;  ///< the repaired mesh that was filled; the organ's surface may be coarser
  ImportReport report;
};

/// Runs read_mesh, choose_unit, repair_mesh and fill_organ. Errors: those of these functions, and all options out of
/// range together.
Result<ImportedOrgan> import_organ(const std::string& path, const ImportOptions& options = {});

/// A file with its meshes repaired, before it is filled.
struct RepairedFile {
  ImportReport report;                           ///< without filling; findings of the file and its first mesh
  std::vector<CheckedMesh> mesh;                 ///< at least one, largest first
  std::vector<std::optional<Vec3>> part_colour;  ///< RawMesh::part_colour
};

/// Runs read_mesh, choose_unit and, for one mesh, repair_mesh; for at most `most` > 1, repair_parts. Errors: those of
/// these functions, and all options out of range together.
Result<RepairedFile> repair_file(const std::string& path, const ImportOptions& options = {}, std::size_t most = 1);

/// The same with its meshes turned as ImportOptions::turn would have.
RepairedFile turned(RepairedFile file, Vec3 turn);

/// Fills mesh `index` of a file. Errors: those of fill_organ(); many spheres in an organ of a wrong size (size.h).
Result<ImportedOrgan> fill_repaired(const RepairedFile& file, std::size_t index, const ImportOptions& options = {});

/// Runs read_mesh and repair_mesh, for a closed mesh that is not filled. `unit_in_metres`: length of one unit of the
/// file [m], > 0. Errors: those of these functions.
Result<CheckedMesh> import_mesh(const std::string& path, double unit_in_metres);

/// The report as lines of plain text for readers who do not know mesh terms.
std::string to_text(const ImportReport& report);

}  // namespace ctpm::importers
