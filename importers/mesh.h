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

/// Progress callback of an import: the current stage, and the fraction of it that is done, 0 to 1.
using Progress = std::function<void(const std::string& stage, double fraction)>;

/// Content of a mesh file. Node transforms are applied and polygons are triangulated. Vertices at bit-equal positions
/// are merged, because readers and some formats repeat a vertex for every face. Nothing else is changed.
struct RawMesh {
  std::string path;                              ///< the file
  std::string format;                            ///< its suffix in lower case, without the dot
  std::vector<std::string> parts;                ///< names of all meshes in the file, in its order, each once
  std::vector<std::optional<Vec3>> part_colour;  ///< red, green, blue in [0, 1] if the file says it     (part_count)
  std::vector<Vec3> vertex;        ///< finite, in the file's unit                                 (vertex_count)
  std::vector<Triangle> triangle;  ///< indices in range (triangle_count)
  std::vector<std::int32_t> part_of_triangle;  ///< index in `parts`; empty: not known                (triangle_count)
  double unit_in_metres = 0;                   ///< length of one unit [m] if the format says it; 0: it does not
};

struct ReadOptions {
  std::string part;                      ///< name of the mesh to take; empty: all, joined
  double time_limit_s = 120;             ///< the reader is stopped after this long [s], > 0
  std::int64_t memory_limit_mib = 4096;  ///< for the reader, beyond the program's memory [MiB], > 0
};

/// Reads a mesh file in a child process with limits, so a crash or hang of the reader is only an error of this file.
/// Errors: no such file, not a file, empty, not a mesh, no triangles, a vertex that is not finite, no part of that name
/// (the message lists the names), a reader that crashed or exceeded a limit.
Result<RawMesh> read_mesh(const std::string& path, const ReadOptions& options = {});

/// Source of a mesh's unit. `scaled`: no unit gives a usual size, so that the mesh is taken as one without scale.
enum class UnitSource : std::int32_t { given = 0, file = 1, guessed = 2, scaled = 3 };

struct UnitChoice {
  double in_metres = 1;  ///< length of one unit of the file [m], > 0
  UnitSource source = UnitSource::guessed;
  bool is_usual_size = true;  ///< the mesh's diagonal is within the organ's usual size
};

/// Usual range of an organ's bounding-box diagonal.
struct UsualSize {
  double least = 0.05;  ///< [m], > 0
  double most = 0.5;    ///< [m], > least
};

/// Chooses the unit: the given one; else that of the file, unless the organ would be more than four times smaller or
/// larger than usual; else the one of m, cm, mm that gives a usual size, nearest, as a ratio, to the geometric mean of
/// the usual range; else decimetre or inch if one of them does; else the mesh is scaled to that mean.
UnitChoice choose_unit(const RawMesh& mesh, std::optional<double> given_in_metres, UsualSize usual);

/// As above, for content of that diagonal, in a file that says `unit_of_file` [m]; 0: it does not.
UnitChoice choose_unit(double diagonal, double unit_of_file, std::optional<double> given_in_metres, UsualSize usual);

/// "mm", "cm", "dm", "m", "inch", or the length in metres where the unit has no name.
std::string unit_name(double in_metres);

/// A defect of a mesh or its filling.
struct Finding {
  std::string code;           ///< stable short name, for example `hole`; README.md lists them
  std::int64_t count = 0;     ///< how many
  std::optional<Vec3> place;  ///< position of the worst one [m]
  std::string found;          ///< what was found, with sizes
  std::string done;           ///< what was done about it
  std::string remains;        ///< what remains of the defect; empty: nothing
};

/// Topology of a triangle mesh by vertex index. Unwelded meshes therefore have many parts and open edges.
struct MeshCounts {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t parts = 0;               ///< edge-connected parts
  std::int64_t open_edges = 0;          ///< edges of one triangle
  std::int64_t non_manifold_edges = 0;  ///< edges of more than two triangles
};

MeshCounts count_mesh(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

/// A mesh that bounds a volume: closed, manifold, oriented outwards, without unused vertices. Shells within its outer
/// one bound cavities and are oriented inwards.
struct CheckedMesh {
  std::vector<Vec3> vertex;        ///< [m]                                        (vertex_count)
  std::vector<Triangle> triangle;  ///< counter-clockwise seen from outside        (triangle_count)
  double volume = 0;               ///< enclosed [m^3], > 0
  double area = 0;                 ///< of the surface [m^2], > 0
  Vec3 box_least, box_most;        ///< bounding box [m]
  MeshCounts before;               ///< as read
  MeshCounts after;
  std::vector<Finding> findings;
  std::int32_t part = -1;  ///< index in RawMesh::parts of most of its vertices; -1: not known
};

/// Points turned about the origin: about the x axis, then the y axis, then the z axis, by `turn` [degrees]. Quarter
/// turns are exact; no turn leaves every bit.
std::vector<Vec3> turned(std::vector<Vec3> points, Vec3 turn);

struct RepairOptions {
  bool all_parts = false;       ///< keeps every closed part, not only the largest
  double weld_distance = 1e-6;  ///< closer vertices are merged, in bounding-box diagonals, >= 0
  std::optional<double>
      largest_hole;  ///< holes up to this diameter are filled [m], >= 0; unset: a tenth of the diagonal
  int threads = 1;   ///< >= 1; the result does not depend on it
  Progress progress;
};

/// Welds vertices, drops duplicate and degenerate triangles, closes cracks, drops inner walls, splits non-manifold
/// edges and vertices, orients, stitches, fills small holes, keeps the largest part with the cavities in it, and
/// removes small self-intersections. Errors: a hole above the limit or one that cannot be filled (with size and place),
/// or no enclosed volume.
Result<CheckedMesh> repair_mesh(const RawMesh& mesh, double unit_in_metres, const RepairOptions& options = {});

/// As repair_mesh(), but every closed part beside the largest is a mesh of its own, largest first: those of at least a
/// hundredth of the largest volume, at most `most`. What the parts have in common is found in the first. Errors: no
/// part can be closed.
Result<std::vector<CheckedMesh>> repair_parts(const RawMesh& mesh, double unit_in_metres, const RepairOptions& options,
                                              std::size_t most);

/// The mesh as OBJ text in millimetres with six decimals. The same mesh always gives the same bytes.
std::string to_obj(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

/// Writes to_obj() to a temporary file and renames it when complete. Error: the file cannot be written.
Result<Done> write_obj(const std::string& path, const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

}  // namespace ctpm::importers
