#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "importers/fill.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// How a mesh file becomes an organ.
struct ImportOptions {
  std::optional<double>
      unit_in_metres;                  ///< length of one unit of the file [m], > 0; unset: from the file, else guessed
  UsualSize usual_size;                ///< of this kind of organ, to guess the unit with
  std::string part;                    ///< name of the mesh to take; empty: all, joined
  bool all_parts = false;              ///< keep every closed part, not only the largest
  std::optional<double> largest_hole;  ///< holes up to this diameter are filled [m]; unset: a tenth of the diagonal
  double sphere_radius = 0.004;        ///< r [m], > 0
  double gap = -1;                     ///< between neighbours' surfaces [m], >= 0; negative: r
  std::int64_t most_spheres = 2'000'000;  ///< more are refused
  std::int64_t most_triangles = 0;        ///< of the drawn surface, which is coarsened if it has more; 0: never
  int threads = 2;                        ///< >= 1; the result does not depend on it
  double time_limit_s = 120;              ///< for reading the file [s]
  Progress progress;                      ///< told the stage and the fraction of the whole import, never falling
};

/// What was found in the file, what was done about it, and what came out.
struct ImportReport {
  std::string path;
  std::string format;
  std::vector<std::string> parts;  ///< names of all meshes in the file
  UnitChoice unit;
  MeshCounts before, after;               ///< the mesh as read and as kept
  double mesh_volume = 0;                 ///< [m^3]
  double mesh_area = 0;                   ///< [m^2]
  Vec3 box_least, box_most;               ///< [m]
  double sphere_radius = 0, spacing = 0;  ///< [m]
  FillReport fill;
  std::vector<Finding> findings;  ///< of all stages, in their order
};

struct ImportedOrgan {
  FilledOrgan organ;
  CheckedMesh mesh;  ///< the repaired mesh that was filled; the organ's surface may be coarser
  ImportReport report;
};

/// Reads, repairs, fills and binds: read_mesh, choose_unit, repair_mesh and fill_organ in one call. Errors:
/// theirs, and options out of range, all at once.
Result<ImportedOrgan> import_organ(const std::string& path, const ImportOptions& options = {});

/// The report as lines of plain text for a reader who knows organs, not meshes.
std::string to_text(const ImportReport& report);

}  // namespace ctpm::importers
