#include "studio/fidelity/meshes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ctpm::fidelity {
namespace {

/// Vertices by their place on an integer grid, so that faces share those of their edges.
class BoxMesher {
 public:
  BoxMesher(Vec3 least, Vec3 most, double edge) : least_(least), most_(most) {
    const Vec3 size = most - least;
    for (int axis = 0; axis < 3; ++axis) {
      const double length = axis == 0 ? size.x : axis == 1 ? size.y : size.z;
      count_[axis] = std::max(1, int(std::ceil(length / edge - 1e-9)));
      step_[axis] = length / count_[axis];
    }
  }

  importers::RawMesh mesh() {
    for (int axis = 0; axis < 3; ++axis)
      for (const int end : {0, count_[axis]}) add_face(axis, end);
    return std::move(mesh_);
  }

 private:
  std::int32_t vertex(std::array<int, 3> at) {
    const auto [it, is_new] = known_.try_emplace(at, std::int32_t(mesh_.vertex.size()));
    if (is_new)
      mesh_.vertex.push_back(
          {along(0, at, least_.x, most_.x), along(1, at, least_.y, most_.y), along(2, at, least_.z, most_.z)});
    return it->second;
  }

  /// The far end is exact: a box that is longer by a rounding error can hold another layer of cells.
  double along(int axis, const std::array<int, 3>& at, double least, double most) const {
    return at[axis] == count_[axis] ? most : least + at[axis] * step_[axis];
  }

  void add_face(int axis, int end) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < count_[u]; ++i)
      for (int j = 0; j < count_[v]; ++j) {
        std::array<int, 3> at{};
        at[axis] = end, at[u] = i, at[v] = j;
        std::int32_t corner[4];
        for (int c = 0; c < 4; ++c) {
          std::array<int, 3> place = at;
          place[u] += c == 1 || c == 2, place[v] += c >= 2;
          corner[c] = vertex(place);
        }
        if (end == 0) std::swap(corner[1], corner[3]);
        mesh_.triangle.push_back({corner[0], corner[1], corner[2]});
        mesh_.triangle.push_back({corner[0], corner[2], corner[3]});
      }
  }

  Vec3 least_, most_;
  int count_[3];
  double step_[3];
  std::map<std::array<int, 3>, std::int32_t> known_;
  importers::RawMesh mesh_;
};

/// Halves every edge; new vertices go onto the unit sphere.
void subdivide(importers::RawMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle_of;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [it, is_new] = middle_of.try_emplace(std::minmax(a, b), std::int32_t(mesh.vertex.size()));
    if (is_new) {
      const Vec3 sum = mesh.vertex[std::size_t(a)] + mesh.vertex[std::size_t(b)];
      mesh.vertex.push_back(sum / norm(sum));
    }
    return it->second;
  };
  std::vector<importers::Triangle> finer;
  for (const auto& [a, b, c] : mesh.triangle) {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  mesh.triangle = std::move(finer);
}

double longest_edge(const importers::RawMesh& mesh) {
  double longest = 0;
  for (const importers::Triangle& t : mesh.triangle)
    for (std::size_t c = 0; c < 3; ++c)
      longest = std::max(longest, norm(mesh.vertex[std::size_t(t[c])] - mesh.vertex[std::size_t(t[(c + 1) % 3])]));
  return longest;
}

}  // namespace

importers::RawMesh box_mesh(Vec3 least, Vec3 most, double edge) {
  importers::RawMesh mesh = BoxMesher(least, most, edge).mesh();
  mesh.path = "box";
  return mesh;
}

importers::RawMesh ball_mesh(double radius, double edge) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  importers::RawMesh mesh;
  mesh.path = "ball";
  for (const Vec3 p : {Vec3{-1, g, 0}, Vec3{1, g, 0}, Vec3{-1, -g, 0}, Vec3{1, -g, 0}, Vec3{0, -1, g}, Vec3{0, 1, g},
                       Vec3{0, -1, -g}, Vec3{0, 1, -g}, Vec3{g, 0, -1}, Vec3{g, 0, 1}, Vec3{-g, 0, -1}, Vec3{-g, 0, 1}})
    mesh.vertex.push_back(p / norm(p));
  mesh.triangle = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  while (longest_edge(mesh) * radius > edge) subdivide(mesh);
  for (Vec3& v : mesh.vertex) v = radius * v;
  return mesh;
}

}  // namespace ctpm::fidelity
