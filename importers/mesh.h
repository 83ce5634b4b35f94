#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "core/model/vec3.h"

namespace ctpm::importers {

using Triangle = std::array<std::int32_t, 3>;

/// Told while an import runs: the stage that is at work and how much of it is done, 0 to 1.
using Progress = std::function<void(const std::string& stage, double fraction)>;

/// What a mesh file holds, as it is: node transforms applied, polygons cut into triangles, vertices that
/// repeat the very same position joined (readers and some formats repeat a vertex for every face), nothing
/// else changed.
struct RawMesh {
  std::string path;                ///< the file
  std::string format;              ///< its suffix in lower case, without the dot
  std::vector<std::string> parts;  ///< names of all meshes in the file, in its order, each once
  std::vector<Vec3> vertex;        ///< finite, in the file's unit                                 (vertex_count)
  std::vector<Triangle> triangle;  ///< indices in range (triangle_count)
  double unit_in_metres = 0;       ///< length of one unit [m] if the format says it; 0: it does not
};

struct ReadOptions {
  std::string part;                      ///< name of the mesh to take; empty: all, joined
  double time_limit_s = 120;             ///< the reader is stopped after this long [s], > 0
  std::int64_t memory_limit_mib = 4096;  ///< the reader may use this much beside the program's own memory [MiB], > 0
};

/// Reads a mesh file in a child process with limits, so a crash or a hang of the reader is an error of this
/// file and nothing else. Errors: no such file, not a file, empty, not a mesh, no triangles, a vertex that is
/// not finite, no part of that name (the names are listed), a reader that crashed or broke a limit.
Result<RawMesh> read_mesh(const std::string& path, const ReadOptions& options = {});

/// How the unit of a mesh was found.
enum class UnitSource : std::int32_t { given = 0, file = 1, guessed = 2 };

struct UnitChoice {
  double in_metres = 1;  ///< length of one unit of the file [m], > 0
  UnitSource source = UnitSource::guessed;
  bool is_usual_size = true;  ///< the mesh's diagonal lies in the organ's usual size
};

/// Smallest and largest bounding-box diagonal that an organ of this kind usually has.
struct UsualSize {
  double least = 0.05;  ///< [m], > 0
  double most = 0.5;    ///< [m], > least
};

/// The unit: as given, else as the file says, else the one of m, cm, mm that puts the diagonal nearest the
/// middle of the usual size; inch only where no metric unit gives a usual size.
UnitChoice choose_unit(const RawMesh& mesh, std::optional<double> given_in_metres, UsualSize usual);

/// "mm", "cm", "m", "inch", or the length in metres where the unit has no name.
std::string unit_name(double in_metres);

/// Something that was wrong with a mesh or its filling.
struct Finding {
  std::string code;           ///< stable short name, for example `hole`; see the README's list
  std::int64_t count = 0;     ///< how many
  std::optional<Vec3> place;  ///< where (the worst one) [m]
  std::string found;          ///< what was found, with sizes
  std::string done;           ///< what was done about it
  std::string remains;        ///< what remains of it; empty: nothing
};

/// What a triangle mesh looks like; counted by vertex index, so unwelded meshes have many parts and open
/// edges.
struct MeshCounts {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t parts = 0;               ///< pieces joined by edges
  std::int64_t open_edges = 0;          ///< edges of one triangle
  std::int64_t non_manifold_edges = 0;  ///< edges of more than two triangles
};

MeshCounts count_mesh(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

/// A mesh that bounds a volume: closed, manifold, oriented outwards, without loose vertices.
struct CheckedMesh {
  std::vector<Vec3> vertex;        ///< [m]                                        (vertex_count)
  std::vector<Triangle> triangle;  ///< counter-clockwise seen from outside        (triangle_count)
  double volume = 0;               ///< enclosed [m^3], > 0
  double area = 0;                 ///< of the surface [m^2], > 0
  Vec3 box_least, box_most;        ///< bounding box [m]
  MeshCounts before;               ///< as read
  MeshCounts after;
  std::vector<Finding> findings;
};

struct RepairOptions {
  bool all_parts = false;       ///< keep every closed part, not only the largest
  double weld_distance = 1e-6;  ///< vertices this near are one, in bounding-box diagonals, >= 0
  std::optional<double>
      largest_hole;  ///< holes up to this diameter are filled [m], >= 0; unset: a tenth of the diagonal
  Progress progress;
};

/// Welds, drops what is doubled or degenerate, splits what is not manifold, orients, stitches, fills small
/// holes and keeps the largest part. Errors: a hole above the limit or one that cannot be filled (size and
/// place), nothing that bounds a volume.
Result<CheckedMesh> repair_mesh(const RawMesh& mesh, double unit_in_metres, const RepairOptions& options = {});

/// The mesh as OBJ text in millimetres with six decimals, so the same mesh always gives the same bytes.
std::string to_obj(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

/// Writes to_obj() to a file under a temporary name and renames it when it is whole. Error: cannot be
/// written.
Result<Done> write_obj(const std::string& path, const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

}  // namespace ctpm::importers
