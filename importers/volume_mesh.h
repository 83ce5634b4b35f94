#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/vec3.h"
#include "importers/child_process.h"

namespace ctpm::importers {

/// What an element of a volume mesh is, whatever its format calls it.
enum class ElementKind : std::uint8_t { other, triangle, quad, tetrahedron, pyramid, wedge, hexahedron };

/// Corners of an element; 0 for other kinds.
std::size_t corners_of(ElementKind kind);

/// Elements of a finite element mesh, as a file holds them.
struct VolumeMesh {
  std::vector<Vec3> point;           ///< in the file's unit                                          (point_count)
  std::vector<ElementKind> kind;     ///<                                                             (element_count)
  std::vector<std::size_t> first;    ///< where an element's corners begin in `corner`                (element_count)
  std::vector<std::int64_t> corner;  ///< points
  std::vector<std::int32_t> region;  ///< of each element; empty: there is one region                 (element_count)
  std::map<std::int32_t, std::string> region_name;

  void add(ElementKind k, const std::int64_t* corners) {
    kind.push_back(k), first.push_back(corner.size());
    corner.insert(corner.end(), corners, corners + corners_of(k));
  }
};

/// Thrown inside the readers of volume meshes and caught in send_volume_mesh(): the end of a sentence that begins with
/// the file's name.
struct BrokenMesh {
  std::string message, hint;
};

/// Gmsh's MSH 2.2 and 4.1, VTK's legacy files of unstructured grids and polygons, VTK's XML files of unstructured
/// grids; each as text or binary. They read no more than the text holds. Throw BrokenMesh.
VolumeMesh read_msh(std::string_view text);
VolumeMesh read_vtk(std::string_view text);
VolumeMesh read_vtu(std::string_view text);

/// Whether the name is that of a volume mesh: .msh, .vtk, .vtu.
bool is_volume_mesh(const std::string& path);

/// Reads a volume mesh and sends its boundary (see wire.h): the faces of its elements that no second element shares,
/// or its triangles where it has no elements with a volume. `part` names a region. Call it in a child process.
void send_volume_mesh(const std::string& path, const std::string& part, const Send& send);

}  // namespace ctpm::importers
