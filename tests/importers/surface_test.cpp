#include <gtest/gtest.h>

#include <cmath>

#include "importers/coarsen.h"
#include "importers/fill.h"
#include "importers/self_crossing.h"
#include "importers/surface_index.h"
#include "zoo.h"

namespace ctpm {
namespace {

using zoo::find;
using zoo::text_of;

TEST(Coarsen, KeepsTheShapeClosed) {
  const importers::RawMesh fine = zoo::torus(0.05, 0.02, 160, 80);
  const importers::Soup coarse = importers::coarsen({fine.vertex, fine.triangle}, 2000);
  EXPECT_LE(coarse.triangle.size(), 2000u);
  EXPECT_GT(coarse.triangle.size(), 1900u);
  const importers::MeshCounts counts = importers::count_mesh(coarse.vertex, coarse.triangle);
  EXPECT_EQ(counts.open_edges, 0);
  EXPECT_EQ(counts.non_manifold_edges, 0);
  EXPECT_EQ(counts.vertices - counts.triangles / 2, 0) << "still a ring";
  const double volume = importers::signed_volume(fine.vertex, fine.triangle, {});
  EXPECT_NEAR(importers::signed_volume(coarse.vertex, coarse.triangle, {}), volume, 1e-3 * volume);
  EXPECT_TRUE(importers::find_crossing(coarse).empty());
}

TEST(Coarsen, GivesTheSameEveryTime) {
  const importers::RawMesh fine = zoo::sphere(0.05, 4);
  const importers::Soup one = importers::coarsen({fine.vertex, fine.triangle}, 500),
                        two = importers::coarsen({fine.vertex, fine.triangle}, 500);
  EXPECT_EQ(one.vertex, two.vertex);
  EXPECT_EQ(one.triangle, two.triangle);
}

TEST(Coarsen, OnlyTheDrawnSurfaceOfAnOrganIsCoarser) {
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(zoo::torus(0.05, 0.02, 160, 80), 1);
  ASSERT_TRUE(mesh);
  importers::FillOptions options;
  options.sphere_radius = 0.002;
  const Result<importers::Filling> fine = importers::fill_organ(*mesh, options);
  options.most_triangles = 1500;
  const Result<importers::Filling> coarse = importers::fill_organ(*mesh, options);
  ASSERT_TRUE(fine && coarse) << text_of(coarse.errors());
  EXPECT_EQ(fine->organ.centre, coarse->organ.centre);
  EXPECT_EQ(fine->organ.depth, coarse->organ.depth);
  EXPECT_GE(fine->report.surface_triangles, 25600) << "refined where edges are longer than a third of a spacing";
  EXPECT_LE(coarse->report.surface_triangles, 1500);
  EXPECT_EQ(coarse->organ.surface.binding.first.size(), coarse->organ.surface.vertex.size() + 1);
  const importers::Finding* finding = find(coarse->report.findings, "coarsened");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->count, 25600 - coarse->report.surface_triangles);
  options.most_triangles = 5;
  EXPECT_FALSE(importers::fill_organ(*mesh, options));
}

TEST(SurfaceIndex, FindsTheNearestWhateverTheGuess) {
  const importers::RawMesh mesh = zoo::torus(0.05, 0.02, 24, 12);
  const importers::SurfaceIndex index(mesh.vertex, mesh.triangle);
  for (int n = 0; n < 500; ++n) {
    const Vec3 p{0.08 * std::sin(n * 1.7), 0.08 * std::sin(n * 2.3), 0.04 * std::sin(n * 3.1)};
    double least = 1;
    for (const importers::Triangle& t : mesh.triangle)
      least =
          std::min(least, importers::squared_distance(p, mesh.vertex[std::size_t(t[0])], mesh.vertex[std::size_t(t[1])],
                                                      mesh.vertex[std::size_t(t[2])]));
    // The index rounds otherwise than squared_distance() does, on lengths of a tenth; a guess never changes a bit.
    constexpr double kRounding = 1e-16;
    const double found = index.nearest(p).squared_distance;
    ASSERT_NEAR(found, least, kRounding);
    for (const std::int32_t guess : {1, 50, 143}) ASSERT_EQ(index.nearest(p, guess).squared_distance, found);
  }
}

}  // namespace
}  // namespace ctpm
