#include "zoo.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace ctpm::zoo {
namespace {

importers::RawMesh named() {
  importers::RawMesh mesh;
  mesh.path = "zoo";
  mesh.format = "zoo";
  return mesh;
}

std::int32_t middle_vertex(importers::RawMesh& mesh, std::map<std::array<std::int32_t, 2>, std::int32_t>& known,
                           std::int32_t a, std::int32_t b) {
  const auto [it, is_new] = known.emplace(std::array{std::min(a, b), std::max(a, b)}, std::int32_t(mesh.vertex.size()));
  if (is_new) {
    const Vec3 p = mesh.vertex[std::size_t(a)] + mesh.vertex[std::size_t(b)];
    mesh.vertex.push_back(p / norm(p));
  }
  return it->second;
}

}  // namespace

importers::RawMesh sphere(double radius, int cuts, Vec3 centre) {
  importers::RawMesh mesh = named();
  const double g = std::numbers::phi;
  for (const Vec3 p : {Vec3{-1, g, 0},
                       {1, g, 0},
                       {-1, -g, 0},
                       {1, -g, 0},
                       {0, -1, g},
                       {0, 1, g},
                       {0, -1, -g},
                       {0, 1, -g},
                       {g, 0, -1},
                       {g, 0, 1},
                       {-g, 0, -1},
                       {-g, 0, 1}})
    mesh.vertex.push_back(p / norm(p));
  mesh.triangle = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::array<std::int32_t, 2>, std::int32_t> known;
    std::vector<importers::Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangle) {
      const std::int32_t ab = middle_vertex(mesh, known, a, b), bc = middle_vertex(mesh, known, b, c),
                         ca = middle_vertex(mesh, known, c, a);
      for (const importers::Triangle& t : {importers::Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(t);
    }
    mesh.triangle = std::move(finer);
  }
  return moved(mesh, [&](Vec3 p) { return centre + radius * p; });
}

importers::RawMesh torus(double ring_radius, double tube_radius, int around, int across) {
  importers::RawMesh mesh = named();
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = ring_radius + tube_radius * std::cos(v);
      mesh.vertex.push_back({r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v)});
    }
  const auto at = [&](int i, int j) { return std::int32_t((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

importers::RawMesh box(Vec3 size, int cuts, Vec3 centre) {
  importers::RawMesh mesh = named();
  std::map<std::array<int, 3>, std::int32_t> known;
  const auto at = [&](std::array<int, 3> grid) {
    const auto [it, is_new] = known.emplace(grid, std::int32_t(mesh.vertex.size()));
    const auto along = [&](int axis, double length) { return length * (double(grid[std::size_t(axis)]) / cuts - 0.5); };
    if (is_new) mesh.vertex.push_back(centre + Vec3{along(0, size.x), along(1, size.y), along(2, size.z)});
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const bool is_far : {false, true})
      for (int i = 0; i < cuts; ++i)
        for (int j = 0; j < cuts; ++j) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> grid{};
            grid[std::size_t(axis)] = is_far ? cuts : 0;
            grid[std::size_t(axis + 1) % 3] = u, grid[std::size_t(axis + 2) % 3] = v;
            return at(grid);
          };
          const std::int32_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
          mesh.triangle.push_back(is_far ? importers::Triangle{a, b, c} : importers::Triangle{a, c, b});
          mesh.triangle.push_back(is_far ? importers::Triangle{a, c, d} : importers::Triangle{a, d, c});
        }
  return mesh;
}

importers::RawMesh both(const importers::RawMesh& a, const importers::RawMesh& b) {
  importers::RawMesh mesh = a;
  const std::int32_t first = std::int32_t(a.vertex.size());
  mesh.vertex.insert(mesh.vertex.end(), b.vertex.begin(), b.vertex.end());
  for (const importers::Triangle& t : b.triangle) mesh.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

importers::RawMesh moved(importers::RawMesh mesh, const std::function<Vec3(Vec3)>& where) {
  for (Vec3& p : mesh.vertex) p = where(p);
  return mesh;
}

importers::RawMesh unwelded(const importers::RawMesh& mesh) {
  importers::RawMesh soup = named();
  for (const importers::Triangle& t : mesh.triangle) {
    const std::int32_t first = std::int32_t(soup.vertex.size());
    for (const std::int32_t v : t) soup.vertex.push_back(mesh.vertex[std::size_t(v)]);
    soup.triangle.push_back({first, first + 1, first + 2});
  }
  return soup;
}

importers::RawMesh flipped(importers::RawMesh mesh, std::size_t every) {
  for (std::size_t t = 0; t < mesh.triangle.size(); t += every) std::swap(mesh.triangle[t][1], mesh.triangle[t][2]);
  return mesh;
}

importers::RawMesh without(importers::RawMesh mesh, const std::function<bool(Vec3)>& goes) {
  std::erase_if(mesh.triangle, [&](const importers::Triangle& t) {
    return goes((mesh.vertex[std::size_t(t[0])] + mesh.vertex[std::size_t(t[1])] + mesh.vertex[std::size_t(t[2])]) / 3);
  });
  return mesh;
}

const importers::Finding* find(const std::vector<importers::Finding>& findings, const std::string& code) {
  for (const importers::Finding& finding : findings)
    if (finding.code == code) return &finding;
  return nullptr;
}

std::string summary(const std::vector<importers::Finding>& findings) {
  std::string text;
  for (const importers::Finding& f : findings)
    text += (text.empty() ? "" : ", ") + f.code + " x " + std::to_string(f.count);
  return text;
}

std::string text_of(const Errors& errors) {
  std::string text;
  for (const Error& error : errors) text += to_string(error) + "\n";
  return text;
}

}  // namespace ctpm::zoo
