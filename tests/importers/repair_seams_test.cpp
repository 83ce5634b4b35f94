// Where pieces of a mesh meet badly: cracks at T-junctions, walls inside, thin bridges.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "importers/fill.h"
#include "importers/seams.h"
#include "importers/topology.h"
#include "zoo.h"

namespace ctpm {
namespace {

using zoo::find;
using zoo::summary;
using zoo::text_of;

/// A cube of 100 mm whose top is cut `top` times and whose other sides `sides` times, not joined.
importers::RawMesh cube_with_other_top(int sides, int top) {
  const auto is_top = [](Vec3 p) { return p.z > 0.0499; };
  return zoo::both(zoo::without(zoo::box({0.1, 0.1, 0.1}, sides), is_top),
                   zoo::without(zoo::box({0.1, 0.1, 0.1}, top), [&](Vec3 p) { return !is_top(p); }));
}

/// The index of the vertex at `p`, which is added if there is none.
std::int32_t vertex_at(importers::RawMesh& mesh, Vec3 p) {
  for (std::size_t i = 0; i < mesh.vertex.size(); ++i)
    if (norm(mesh.vertex[i] - p) < 1e-9) return std::int32_t(i);
  mesh.vertex.push_back(p);
  return std::int32_t(mesh.vertex.size()) - 1;
}

/// The cube, `cuts` squares along each edge, with a wall across its middle.
importers::RawMesh cube_with_wall(int cuts) {
  importers::RawMesh mesh = zoo::box({0.1, 0.1, 0.1}, cuts);
  const double edge = 0.1 / cuts;
  for (int j = 0; j < cuts; ++j)
    for (int k = 0; k < cuts; ++k) {
      const auto corner = [&](int dj, int dk) {
        return vertex_at(mesh, {0, -0.05 + edge * (j + dj), -0.05 + edge * (k + dk)});
      };
      const std::int32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
      mesh.triangle.push_back({a, b, c}), mesh.triangle.push_back({a, c, d});
    }
  return mesh;
}

/// Two balls joined by three long, thin sides.
importers::RawMesh balls_on_a_needle() {
  const importers::RawMesh one = zoo::sphere(0.03, 3, {-0.06, 0, 0});
  importers::RawMesh mesh = zoo::both(one, zoo::moved(one, [](Vec3 p) { return Vec3{-p.x, p.y, p.z}; }));
  // The second ball is the first one's mirror image: its triangles must be turned.
  for (std::size_t t = one.triangle.size(); t < mesh.triangle.size(); ++t)
    std::swap(mesh.triangle[t][1], mesh.triangle[t][2]);
  std::size_t nearest = 0;
  double most = -1;
  for (std::size_t t = 0; t < one.triangle.size(); ++t) {
    double x = 0;
    for (const std::int32_t v : one.triangle[t]) x += one.vertex[std::size_t(v)].x;
    if (x > most || t == 0) most = x, nearest = t;
  }
  const importers::Triangle gap = mesh.triangle[nearest];
  const auto twin = [&](std::int32_t v) { return v + std::int32_t(one.vertex.size()); };
  mesh.triangle.erase(mesh.triangle.begin() + std::ptrdiff_t(one.triangle.size() + nearest));
  mesh.triangle.erase(mesh.triangle.begin() + std::ptrdiff_t(nearest));
  for (int c = 0; c < 3; ++c) {
    const std::int32_t p = gap[c], q = gap[(c + 1) % 3];
    mesh.triangle.push_back({p, q, twin(p)}), mesh.triangle.push_back({q, twin(q), twin(p)});
  }
  return mesh;
}

importers::CheckedMesh repaired(const importers::RawMesh& raw) {
  Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  EXPECT_TRUE(mesh) << text_of(mesh.errors());
  if (!mesh) return {};
  EXPECT_EQ(mesh->after.open_edges, 0);
  EXPECT_EQ(mesh->after.non_manifold_edges, 0);
  return std::move(*mesh);
}

TEST(TJunctions, CracksBetweenFineAndCoarseSidesAreClosed) {
  for (const auto& [sides, top, report] : {std::tuple{1, 4, "unwelded x 4, t_junction x 12"},
                                           {4, 1, "unwelded x 4, t_junction x 12"},
                                           {3, 5, "unwelded x 4, t_junction x 24"}}) {
    const importers::CheckedMesh mesh = repaired(cube_with_other_top(sides, top));
    EXPECT_EQ(summary(mesh.findings), report);
    EXPECT_NEAR(mesh.volume, 1e-3, 1e-12);
    EXPECT_EQ(find(mesh.findings, "t_junction")->remains, "");
    EXPECT_NEAR(find(mesh.findings, "t_junction")->place->z, 0.05, 1e-12);
  }
}

TEST(TJunctions, AVertexALittleBesideTheEdgeIsOnItAndOneFurtherOffIsNot) {
  for (const double off : {1e-6, -1e-6, 1e-4, -1e-4}) {
    importers::RawMesh raw = cube_with_other_top(1, 2);
    for (Vec3& p : raw.vertex)
      if (norm(p - Vec3{0.05, 0, 0.05}) < 1e-9) p.x += off;
    const importers::CheckedMesh mesh = repaired(raw);
    EXPECT_EQ(find(mesh.findings, "t_junction")->count, 4) << off;
    EXPECT_NEAR(mesh.volume, 1e-3, 1e-6) << off;
  }
  importers::RawMesh raw = cube_with_other_top(1, 2);
  for (Vec3& p : raw.vertex)
    if (norm(p - Vec3{0.05, 0, 0.05}) < 1e-9) p.x -= 2e-3;
  importers::Soup soup{raw.vertex, raw.triangle};
  importers::weld(soup, 0);
  EXPECT_EQ(importers::split_t_junctions(soup, 1e-4).size(), 3u);
}

TEST(TJunctions, ASoundMeshAndAnHonestHoleHaveNone) {
  importers::Soup sound{zoo::sphere(0.05, 3).vertex, zoo::sphere(0.05, 3).triangle};
  const std::size_t count = sound.triangle.size();
  EXPECT_TRUE(importers::split_t_junctions(sound, 1e-4).empty());
  sound.triangle.resize(count - 20);
  EXPECT_TRUE(importers::split_t_junctions(sound, 1e-4).empty());
  EXPECT_EQ(sound.triangle.size(), count - 20);
}

TEST(InnerWalls, AWallAcrossAnOrganIsDroppedAndTheOrganStaysWhole) {
  const importers::CheckedMesh mesh = repaired(cube_with_wall(4));
  EXPECT_EQ(summary(mesh.findings), "inner_wall x 32");
  EXPECT_EQ(mesh.triangle.size(), 192u);
  EXPECT_NEAR(mesh.volume, 1e-3, 1e-12);
  EXPECT_NEAR(find(mesh.findings, "inner_wall")->place->x, 0, 1e-12);
}

TEST(InnerWalls, RegionsThatShareTheirBorderAreOneOrgan) {
  const importers::RawMesh raw =
      zoo::both(zoo::box({0.1, 0.1, 0.1}, 4, {-0.05, 0, 0}), zoo::box({0.1, 0.1, 0.1}, 4, {0.05, 0, 0}));
  const importers::CheckedMesh mesh = repaired(raw);
  EXPECT_EQ(summary(mesh.findings), "unwelded x 25, duplicate x 32, inner_wall x 32");
  EXPECT_NEAR(mesh.volume, 2e-3, 1e-12);
}

TEST(InnerWalls, AreFoundHoweverTheTrianglesFaceAndBesideAHole) {
  importers::RawMesh raw = zoo::flipped(cube_with_wall(12), 3);
  raw.triangle.erase(raw.triangle.begin() + 40);
  const importers::CheckedMesh mesh = repaired(zoo::unwelded(raw));
  for (const char* code : {"unwelded", "inner_wall", "flipped", "hole"})
    EXPECT_NE(find(mesh.findings, code), nullptr) << code << " is missing in: " << summary(mesh.findings);
  EXPECT_EQ(find(mesh.findings, "inner_wall")->count, 288);
  EXPECT_NEAR(mesh.volume, 1e-3, 1e-12);
}

TEST(InnerWalls, SoundMeshesCavitiesAndFinsHaveNone) {
  const auto walls_of = [](const importers::RawMesh& raw) {
    return importers::find_inner_walls({raw.vertex, raw.triangle}).size();
  };
  EXPECT_EQ(walls_of(zoo::torus(0.05, 0.02, 48, 24)), 0u);
  EXPECT_EQ(walls_of(zoo::both(zoo::sphere(0.05, 3), zoo::sphere(0.02, 2))), 0u);
  importers::RawMesh fin = zoo::sphere(0.05, 3);
  const importers::Triangle t = fin.triangle[0];
  fin.vertex.push_back(1.3 * fin.vertex[std::size_t(t[0])]);
  fin.triangle.push_back({t[0], t[1], std::int32_t(fin.vertex.size()) - 1});
  EXPECT_EQ(walls_of(fin), 0u);
}

TEST(InnerWalls, AnEdgeOfVeryManyTrianglesCostsNoTime) {
  importers::RawMesh book;
  book.vertex = {{0, 0, 0}, {0, 0, 1}};
  for (int i = 0; i < 20000; ++i) {
    book.vertex.push_back({std::cos(i * 1e-4), std::sin(i * 1e-4), 0.5});
    book.triangle.push_back({0, 1, std::int32_t(book.vertex.size()) - 1});
  }
  EXPECT_TRUE(importers::find_inner_walls({book.vertex, book.triangle}).empty());
  importers::Soup soup{book.vertex, book.triangle};
  EXPECT_LT(importers::split_t_junctions(soup, 1e-3).size(), 100000u);
}

TEST(ThinBridges, OfLongTrianglesCarryWhatTheyHold) {
  const importers::CheckedMesh mesh = repaired(balls_on_a_needle());
  EXPECT_EQ(summary(mesh.findings), "");
  importers::FillOptions options;
  options.sphere_radius = 0.01 / 3;
  const Result<importers::Filling> filling = importers::fill_organ(mesh, options);
  ASSERT_TRUE(filling) << text_of(filling.errors());
  EXPECT_EQ(find(filling->report.findings, "island"), nullptr) << "the bridge holds the two ends together";
  EXPECT_NEAR(filling->report.filled_volume, mesh.volume, 1e-9 * mesh.volume);
}

TEST(Seams, CracksWallsHolesFlipsAndCrumbsAtOnceAreAllToldAndMended) {
  importers::RawMesh raw = cube_with_wall(12);
  // The top is another, finer one, so that its rim has vertices that the sides do not know.
  const auto is_top = [](Vec3 p) { return p.z > 0.0499; };
  raw = zoo::both(zoo::without(raw, is_top),
                  zoo::without(zoo::box({0.1, 0.1, 0.1}, 18), [&](Vec3 p) { return !is_top(p); }));
  raw = zoo::unwelded(zoo::flipped(raw, 4));
  raw = zoo::both(raw, zoo::sphere(0.005, 2, {0.1, 0, 0}));
  raw.triangle.erase(raw.triangle.begin() + 7);
  const importers::CheckedMesh mesh = repaired(raw);
  for (const char* code : {"unwelded", "t_junction", "inner_wall", "flipped", "hole", "other_part"})
    EXPECT_NE(find(mesh.findings, code), nullptr) << code << " is missing in: " << summary(mesh.findings);
  EXPECT_NEAR(mesh.volume, 1e-3, 1e-9);
}

TEST(Topology, WeldingJoinsWhatIsNearWhereverItLies) {
  // Pairs of vertices along a line, in steps that hit every place of the search's cells.
  constexpr double kDistance = 1e-4;
  for (const double apart : {0.9, 1.1}) {
    importers::Soup soup;
    for (int n = 0; n < 300; ++n) {
      const double x = -0.1 + 7.3 * kDistance * n;
      soup.vertex.push_back({x, -x, 0.5 * x});
      soup.vertex.push_back({x + apart * kDistance, -x, 0.5 * x});
      soup.triangle.push_back({2 * n, 2 * n + 1, (2 * n + 2) % 600});
    }
    EXPECT_EQ(importers::weld(soup, kDistance), apart < 1 ? 300 : 0);
  }
}

}  // namespace
}  // namespace ctpm
