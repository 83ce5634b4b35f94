#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "importers/fill.h"
#include "importers/self_crossing.h"
#include "importers/topology.h"
#include "zoo.h"

namespace ctpm {
namespace {

using zoo::find;
using zoo::summary;
using zoo::text_of;

TEST(Crossing, SoundMeshesHaveNone) {
  for (const importers::RawMesh& raw :
       {zoo::sphere(0.05, 3), zoo::torus(0.05, 0.02, 48, 24), zoo::box({0.1, 0.1, 0.02}, 4)})
    EXPECT_TRUE(importers::find_crossing({raw.vertex, raw.triangle}).empty());
}

TEST(Crossing, AnyNumberOfThreadsFindsTheSame) {
  importers::RawMesh raw = zoo::torus(0.05, 0.02, 96, 64);
  for (const std::size_t n : {0u, 1'000u, 3'000u}) raw.vertex[n] = -1.0 * raw.vertex[n] + Vec3{0.001, 0.002, 0.001};
  const importers::Soup soup{raw.vertex, raw.triangle};
  const std::vector<std::int32_t> crossing = importers::find_crossing(soup);
  EXPECT_GT(crossing.size(), 18u) << "the triangles of the spikes, and those that they go through";
  for (const int threads : {2, 5}) EXPECT_EQ(importers::find_crossing(soup, threads), crossing);
}

TEST(Crossing, SpikeThroughTheOppositeSideIsCutOutAndFilledAgain) {
  // One vertex pulled through the ball and out at the other side, as a slip in a mesh editor does.
  importers::RawMesh raw = zoo::sphere(0.05, 4);
  raw.vertex[0] = -1.2 * raw.vertex[0] + Vec3{0.001, 0.002, 0.001};
  const std::vector<std::int32_t> crossing = importers::find_crossing({raw.vertex, raw.triangle});
  ASSERT_FALSE(crossing.empty());
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  EXPECT_EQ(summary(mesh->findings), "self_intersection x " + std::to_string(crossing.size()));
  const importers::Finding& finding = *find(mesh->findings, "self_intersection");
  EXPECT_EQ(finding.remains, "") << finding.done;
  EXPECT_TRUE(importers::find_crossing({mesh->vertex, mesh->triangle}).empty());
  EXPECT_EQ(mesh->after.open_edges, 0);
  EXPECT_EQ(mesh->after.parts, 1);
  std::vector<char> is_used(mesh->vertex.size(), 0);
  for (const importers::Triangle& t : mesh->triangle)
    for (const std::int32_t v : t) is_used[std::size_t(v)] = 1;
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), 0), 0) << "no loose vertices";
  const double ball = importers::signed_volume(zoo::sphere(0.05, 4).vertex, raw.triangle, {});
  EXPECT_NEAR(mesh->volume, ball, 0.01 * ball);
}

TEST(Crossing, WideCrossingIsLeftAndTold) {
  // A ring whose tube is pushed through its opposite side.
  const importers::RawMesh raw = zoo::moved(zoo::torus(0.05, 0.02, 48, 24), [](Vec3 p) {
    return p.x > 0 ? Vec3{p.x - 0.9 * p.x * p.x / 0.05, p.y, p.z} : p;
  });
  ASSERT_FALSE(importers::find_crossing({raw.vertex, raw.triangle}).empty());
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  const importers::Finding* finding = find(mesh->findings, "self_intersection");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->done, "none");
  EXPECT_NE(finding->remains, "");
  EXPECT_EQ(mesh->triangle.size(), raw.triangle.size()) << "nothing is cut where not all can be mended";
}

TEST(Crossing, OverlappingPartsAreFilledOnce) {
  const importers::RawMesh raw = zoo::both(zoo::sphere(0.05, 4), zoo::sphere(0.03, 4, {0.05, 0, 0}));
  importers::RepairOptions repair;
  repair.all_parts = true;
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1, repair);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  EXPECT_NE(find(mesh->findings, "self_intersection"), nullptr) << summary(mesh->findings);
  importers::FillOptions fill;
  fill.sphere_radius = 0.001;
  const Result<importers::Filling> filling = importers::fill_organ(*mesh, fill);
  ASSERT_TRUE(filling) << text_of(filling.errors());
  std::int64_t expected = 0;
  const double s = filling->organ.spacing;
  for (const Vec3& p : filling->organ.centre) expected += norm(p) < 0.05 + s || norm(p - Vec3{0.05, 0, 0}) < 0.03 + s;
  EXPECT_NEAR(double(filling->report.spheres), double(expected), 0.06 * double(expected));
  // Two balls less their common lens (Weisstein, Sphere-Sphere Intersection).
  const double R = 0.05, r = 0.03, d = 0.05, pi = std::acos(-1.0);
  const double lens =
      pi * std::pow(R + r - d, 2) * (d * d + 2 * d * r - 3 * r * r + 2 * d * R + 6 * r * R - 3 * R * R) / (12 * d);
  const double both = 4 * pi / 3 * (R * R * R + r * r * r) - lens;
  EXPECT_NEAR(filling->report.filled_volume, both, 0.02 * both);
}

TEST(Crossing, MoebiusStripIsRefused) {
  importers::RawMesh raw;
  raw.path = "strip";
  constexpr int kAround = 40;
  for (int i = 0; i < kAround; ++i)
    for (const double side : {-0.02, 0.02}) {
      const double u = 2 * std::acos(-1.0) * i / kAround, r = 0.05 + side * std::cos(u / 2);
      raw.vertex.push_back({r * std::cos(u), r * std::sin(u), side * std::sin(u / 2)});
    }
  for (int i = 0; i < kAround; ++i) {
    const bool is_last = i + 1 == kAround;
    const std::int32_t a = 2 * i, b = a + 1, c = is_last ? 1 : a + 2, d = is_last ? 0 : a + 3;
    raw.triangle.push_back({a, b, d});
    raw.triangle.push_back({a, d, c});
  }
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_FALSE(mesh);
  EXPECT_NE(mesh.errors()[0].message.find("hole"), std::string::npos) << text_of(mesh.errors());
}

}  // namespace
}  // namespace ctpm
