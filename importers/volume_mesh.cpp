#include "importers/volume_mesh.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>

#include "importers/mesh_file.h"
#include "importers/topology.h"

namespace ctpm::importers {
namespace {

using Face = std::vector<std::size_t>;  ///< corners of an element, counter-clockwise seen from outside

/// Faces in the numbering of corners that VTK and Gmsh share.
const std::vector<Face>& faces_of(ElementKind kind) {
  static const std::vector<Face> none, tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}},
      pyramid{{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
      wedge{{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
      hexahedron{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  switch (kind) {
    case ElementKind::tetrahedron:
      return tetrahedron;
    case ElementKind::pyramid:
      return pyramid;
    case ElementKind::wedge:
      return wedge;
    case ElementKind::hexahedron:
      return hexahedron;
    default:
      return none;
  }
}

bool has_volume(ElementKind kind) { return kind >= ElementKind::tetrahedron; }

std::string name_of(const VolumeMesh& mesh, std::int32_t region) {
  const auto found = mesh.region_name.find(region);
  return found == mesh.region_name.end() ? std::to_string(region) : found->second;
}

/// A face and the points that name it, whichever way it turns; the fourth is -1 for a triangle.
struct OuterFace {
  std::array<std::int64_t, 4> key{-1, -1, -1, -1}, corner{-1, -1, -1, -1};
  bool operator<(const OuterFace& other) const { return key < other.key; }
};

void add_triangles(const std::array<std::int64_t, 4>& corner, std::vector<Triangle>& triangles) {
  const auto index = [&](std::size_t c) { return std::int32_t(corner[c]); };
  triangles.push_back({index(0), index(1), index(2)});
  if (corner[3] >= 0) triangles.push_back({index(0), index(2), index(3)});
}

/// An element of VTK or Gmsh may be numbered inside out; its faces then look inwards.
bool is_inside_out(const VolumeMesh& mesh, std::size_t element) {
  const auto p = [&](std::size_t c) { return mesh.point[std::size_t(mesh.corner[mesh.first[element] + c])]; };
  const std::size_t top = mesh.kind[element] == ElementKind::wedge        ? 3
                          : mesh.kind[element] == ElementKind::hexahedron ? 4
                                                                          : corners_of(mesh.kind[element]) - 1;
  return dot(cross(p(1) - p(0), p(2) - p(0)), p(top) - p(0)) < 0;
}

std::vector<Triangle> boundary(const VolumeMesh& mesh, const std::string& part) {
  const bool is_solid = std::any_of(mesh.kind.begin(), mesh.kind.end(), has_volume);
  std::vector<OuterFace> faces;
  std::vector<Triangle> triangles;
  for (std::size_t e = 0; e < mesh.kind.size(); ++e) {
    if (!part.empty() && (mesh.region.empty() || name_of(mesh, mesh.region[e]) != part)) continue;
    const std::int64_t* const corner = &mesh.corner[mesh.first[e]];
    if (!is_solid) {
      std::array<std::int64_t, 4> own{-1, -1, -1, -1};
      if (mesh.kind[e] != ElementKind::triangle && mesh.kind[e] != ElementKind::quad) continue;
      std::copy_n(corner, corners_of(mesh.kind[e]), own.begin());
      add_triangles(own, triangles);
      continue;
    }
    const bool is_turned = is_inside_out(mesh, e);
    for (const Face& face : faces_of(mesh.kind[e])) {
      OuterFace& outer = faces.emplace_back();
      for (std::size_t c = 0; c < face.size(); ++c) outer.corner[c] = corner[face[c]];
      if (is_turned) std::reverse(outer.corner.begin(), outer.corner.begin() + std::ptrdiff_t(face.size()));
      outer.key = outer.corner;
      std::sort(outer.key.begin(), outer.key.end());
    }
  }
  std::stable_sort(faces.begin(), faces.end());
  for (std::size_t f = 0; f < faces.size();) {
    const auto next =
        std::size_t(std::upper_bound(faces.begin() + std::ptrdiff_t(f), faces.end(), faces[f]) - faces.begin());
    if (next == f + 1) add_triangles(faces[f].corner, triangles);
    f = next;
  }
  return triangles;
}

void check_corners(const VolumeMesh& mesh) {
  const auto count = std::int64_t(mesh.point.size());
  for (const std::int64_t c : mesh.corner)
    if (c < 0 || c >= count)
      throw BrokenMesh{"has an element that uses point " + std::to_string(c) + " of " + std::to_string(count),
                       "the file may be damaged"};
  if (count > 2'000'000'000) throw BrokenMesh{"has too many points", ""};
}

VolumeMesh read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string suffix = suffix_of(path);
  VolumeMesh mesh = suffix == "msh" ? read_msh(text) : suffix == "vtk" ? read_vtk(text) : read_vtu(text);
  check_corners(mesh);
  return mesh;
}

}  // namespace

std::size_t corners_of(ElementKind kind) {
  constexpr std::size_t kCorners[] = {0, 3, 4, 4, 5, 6, 8};
  return kCorners[std::size_t(kind)];
}

bool is_volume_mesh(const std::string& path) {
  const std::string suffix = suffix_of(path);
  return suffix == "msh" || suffix == "vtk" || suffix == "vtu";
}

void send_volume_mesh(const std::string& path, const std::string& part, const Send& send) try {
  const VolumeMesh mesh = read(path);
  std::set<std::string> parts;
  for (const std::int32_t region : mesh.region) parts.insert(name_of(mesh, region));
  Soup soup{mesh.point, boundary(mesh, part)};
  const std::vector<std::string> names(parts.begin(), parts.end());
  if (!part.empty() && soup.triangle.empty()) return send_no_such_part(names, send);
  drop_unused(soup);
  const std::ptrdiff_t found = part.empty() ? -1 : std::distance(parts.begin(), parts.find(part));
  send_soup(names, found, 0, soup, send);
} catch (const BrokenMesh& broken) {
  send_refusal({path, broken.message, broken.hint}, send);
}

}  // namespace ctpm::importers
