#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "importers/mesh.h"
#include "importers/topology.h"
#include "zoo.h"

namespace ctpm {
namespace {

using zoo::find;
using zoo::summary;
using zoo::text_of;

importers::RawMesh ball() { return zoo::sphere(0.05, 4); }

/// True for the triangles around the ball's first vertex, which lies on the pole `pole()`.
Vec3 pole() {
  static const Vec3 place = ball().vertex[0];
  return place;
}
bool is_at_pole(Vec3 p) { return norm(p - pole()) < 0.003; }

double volume_of(const importers::RawMesh& mesh) { return importers::signed_volume(mesh.vertex, mesh.triangle, {}); }

/// What every mesh that passes has.
void expect_closed(const importers::CheckedMesh& mesh) {
  EXPECT_EQ(mesh.after.open_edges, 0);
  EXPECT_EQ(mesh.after.non_manifold_edges, 0);
  EXPECT_GT(mesh.volume, 0);
  EXPECT_NEAR(importers::signed_volume(mesh.vertex, mesh.triangle, {}), mesh.volume, 1e-9 * mesh.volume);
  EXPECT_EQ(mesh.after.vertices, std::int64_t(mesh.vertex.size()));
  EXPECT_EQ(mesh.after.triangles, std::int64_t(mesh.triangle.size()));
}

TEST(Repair, SoundMeshStaysAsItIs) {
  for (const importers::RawMesh& raw :
       {ball(), zoo::torus(0.05, 0.02, 48, 24), zoo::box({0.1, 0.1, 0.1}), zoo::box({0.1, 0.1, 0.02}, 4)}) {
    const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
    ASSERT_TRUE(mesh) << text_of(mesh.errors());
    expect_closed(*mesh);
    EXPECT_EQ(summary(mesh->findings), "");
    EXPECT_EQ(mesh->vertex.size(), raw.vertex.size());
    EXPECT_EQ(mesh->triangle.size(), raw.triangle.size());
    EXPECT_NEAR(mesh->volume, volume_of(raw), 1e-12 * mesh->volume);
    EXPECT_EQ(mesh->before.open_edges, 0);
  }
}

TEST(Repair, UnitScalesOnly) {
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(zoo::box({100, 200, 300}), 0.001);
  ASSERT_TRUE(mesh);
  EXPECT_NEAR(mesh->volume, 0.1 * 0.2 * 0.3, 1e-12);
  EXPECT_NEAR(mesh->area, 2 * (0.02 + 0.03 + 0.06), 1e-12);
  EXPECT_NEAR(norm(mesh->box_most - Vec3{0.05, 0.1, 0.15}), 0, 1e-12);
}

TEST(Repair, UnweldedSoupIsWelded) {
  const importers::RawMesh raw = zoo::unwelded(ball());
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(mesh->vertex.size(), ball().vertex.size());
  EXPECT_EQ(summary(mesh->findings), "unwelded x " + std::to_string(raw.vertex.size() - ball().vertex.size()));
  EXPECT_EQ(mesh->before.parts, std::int64_t(raw.triangle.size()));
  EXPECT_EQ(mesh->after.parts, 1);
}

TEST(Repair, NearlyEqualVerticesAreWelded) {
  // Noise as single precision leaves it, well below the welding distance.
  importers::RawMesh raw = zoo::unwelded(ball());
  std::uint32_t seed = 1;
  for (Vec3& p : raw.vertex) {
    const auto noise = [&] {
      return 1e-9 * (double((seed = seed * 1664525u + 1013904223u) >> 8) / double(1 << 24) - 0.5);
    };
    p += {noise(), noise(), noise()};
  }
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(mesh->vertex.size(), ball().vertex.size());
}

TEST(Repair, FlippedFacesAreTurned) {
  const importers::RawMesh raw = zoo::flipped(ball(), 7);
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_NEAR(mesh->volume, volume_of(ball()), 1e-12);
  EXPECT_EQ(summary(mesh->findings), "flipped x " + std::to_string((raw.triangle.size() + 6) / 7));
}

TEST(Repair, InsideOutIsTurned) {
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(zoo::flipped(ball(), 1), 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "inside_out x " + std::to_string(ball().triangle.size()));
}

TEST(Repair, SmallHoleIsFilled) {
  const importers::RawMesh raw = zoo::without(ball(), is_at_pole);
  ASSERT_EQ(raw.triangle.size(), ball().triangle.size() - 5);
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "hole x 1");
  EXPECT_GT(mesh->before.open_edges, 0);
  const importers::Finding& hole = *find(mesh->findings, "hole");
  ASSERT_TRUE(hole.place);
  EXPECT_LT(norm(*hole.place - pole()), 0.002) << "the place of the hole is told";
  EXPECT_NEAR(mesh->volume, volume_of(ball()), 1e-3 * mesh->volume);
}

TEST(Repair, TwoHolesAreFilled) {
  const importers::RawMesh raw = zoo::without(ball(), [](Vec3 p) { return is_at_pole(p) || is_at_pole(-p); });
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "hole x 2");
}

TEST(Repair, HugeHoleIsRefusedWithSizeAndPlace) {
  const importers::RawMesh raw = zoo::without(ball(), [](Vec3 p) { return p.z > 0.03; });
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_FALSE(mesh);
  ASSERT_EQ(mesh.errors().size(), 1u);
  const Error& error = mesh.errors()[0];
  EXPECT_EQ(error.where, "zoo");
  // The cap's rim lies near z = 30 mm, where the ball is 80 mm wide.
  double width = 0, z_shown = 0, x_shown = 0, y_shown = 0;
  int edges = 0;
  ASSERT_EQ(
      std::sscanf(error.message.c_str(), "open beyond repair: a hole %lf mm wide (%d edges) at (%lf, %lf, %lf) mm",
                  &width, &edges, &x_shown, &y_shown, &z_shown),
      5)
      << error.message;
  EXPECT_NEAR(width, 80, 4);
  EXPECT_NEAR(z_shown, 30, 3);
  EXPECT_NEAR(x_shown, 0, 2);
  EXPECT_NEAR(y_shown, 0, 2);
  EXPECT_NE(error.message.find("may be filled"), std::string::npos);
  EXPECT_NE(error.hint, "");
  importers::RepairOptions options;
  options.largest_hole = 0.1;
  EXPECT_TRUE(importers::repair_mesh(raw, 1, options)) << "the author may allow it";
  options.largest_hole = 0;
  EXPECT_FALSE(importers::repair_mesh(zoo::without(ball(), is_at_pole), 1, options)) << "or forbid any";
}

TEST(Repair, DuplicateFacesAreDropped) {
  importers::RawMesh raw = ball();
  for (int n = 0; n < 10; ++n) raw.triangle.push_back(raw.triangle[std::size_t(7 * n)]);
  for (int n = 0; n < 5; ++n) {
    const importers::Triangle t = raw.triangle[std::size_t(5 * n + 1)];
    raw.triangle.push_back({t[1], t[0], t[2]});  // turned round: still the same face
  }
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "duplicate x 15");
  EXPECT_EQ(mesh->triangle.size(), ball().triangle.size());
}

TEST(Repair, SheetsThatMeetAtOneEdgeAreRefused) {
  importers::RawMesh fan;
  fan.path = "fan.obj";
  fan.vertex = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {1, 1, -1}, {0, 1, 0}};
  fan.triangle = {{1, 3, 0}, {0, 2, 1}, {0, 4, 1}};
  for (const bool all_parts : {false, true}) {
    importers::RepairOptions options;
    options.all_parts = all_parts;
    const Result<importers::CheckedMesh> mesh = importers::repair_mesh(fan, 1, options);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.errors()[0].where, "fan.obj");
    EXPECT_FALSE(importers::repair_parts(fan, 1, options, 8));
  }
}

TEST(Repair, DegenerateFacesAreDropped) {
  importers::RawMesh raw = ball();
  raw.triangle.push_back({3, 3, 4});
  raw.triangle.push_back({5, 5, 5});
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "degenerate x 2");
}

TEST(Repair, NeedlesOnAnEdgeDoNotOpenTheMesh) {
  // One face cut in two through a point on its edge, its neighbour left uncut, the gap closed by a face
  // without area.
  importers::RawMesh raw = zoo::box({0.1, 0.1, 0.1});
  const importers::Triangle t = raw.triangle[0];
  const std::int32_t middle = std::int32_t(raw.vertex.size());
  raw.vertex.push_back(0.5 * (raw.vertex[std::size_t(t[0])] + raw.vertex[std::size_t(t[1])]));
  raw.triangle[0] = {t[0], middle, t[2]};
  raw.triangle.push_back({middle, t[1], t[2]});
  raw.triangle.push_back({t[0], t[1], middle});
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_NEAR(mesh->volume, 1e-3, 1e-12);
}

TEST(Repair, LargestPartIsKeptAndTheOtherTold) {
  const importers::RawMesh raw = zoo::both(zoo::sphere(0.01, 2, {0.1, 0, 0}), ball());
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "other_part x 1");
  EXPECT_LT(norm(*find(mesh->findings, "other_part")->place - Vec3{0.1, 0, 0}), 1e-6);
  EXPECT_EQ(mesh->before.parts, 2);
  EXPECT_EQ(mesh->after.parts, 1);
  EXPECT_NEAR(mesh->volume, volume_of(ball()), 1e-12);
}

TEST(Repair, ManyCrumbsCostNoMoreThanTheirTriangles) {
  // What a segmentation leaves: thousands of crumbs around the organ. Work that grew with parts times
  // vertices would take minutes.
  importers::RawMesh raw = zoo::sphere(0.05, 6);
  const importers::RawMesh crumb = zoo::sphere(0.0005, 0);
  for (int n = 0; n < 10'000; ++n) {
    const std::int32_t first = std::int32_t(raw.vertex.size());
    for (const Vec3& p : crumb.vertex)
      raw.vertex.push_back(p + 0.002 * Vec3{50.0 + n % 22, double(n / 22 % 22), double(n / 484)});
    for (const importers::Triangle& t : crumb.triangle)
      raw.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  EXPECT_EQ(summary(mesh->findings), "other_part x 10000");
  EXPECT_EQ(mesh->after.parts, 1);
}

TEST(Repair, AllPartsAreKeptWhenWanted) {
  const importers::RawMesh raw = zoo::both(zoo::flipped(zoo::sphere(0.01, 2, {0.1, 0, 0}), 1), ball());
  importers::RepairOptions options;
  options.all_parts = true;
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1, options);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(mesh->after.parts, 2);
  EXPECT_NE(find(mesh->findings, "parts"), nullptr) << summary(mesh->findings);
  EXPECT_NEAR(mesh->volume, volume_of(ball()) + volume_of(zoo::sphere(0.01, 2)), 1e-12);
}

TEST(Repair, OpenPartIsDroppedWithTheReason) {
  const importers::RawMesh bowl = zoo::without(zoo::sphere(0.03, 3, {0.1, 0, 0}), [](Vec3 p) { return p.z > 0; });
  importers::RepairOptions options;
  options.all_parts = true;
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(zoo::both(bowl, ball()), 1, options);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "other_part x 1");
  EXPECT_NE(mesh->findings[0].remains.find("a hole 60"), std::string::npos) << mesh->findings[0].remains;
}

TEST(Repair, AnOrganWithAHoleIsNotDroppedForWhatIsClosedBesideIt) {
  const double hole = 0.02;
  const auto is_off = [&](Vec3 p) { return p.z > 0 && std::hypot(p.x, p.y) < 0.5 * hole; };
  const importers::RawMesh raw = zoo::both(zoo::without(ball(), is_off), zoo::sphere(0.02, 3, {0.1, 0, 0}));
  importers::RepairOptions options;
  options.largest_hole = 0.5 * hole;
  for (const bool is_each : {false, true}) {
    options.all_parts = !is_each;
    const auto errors = is_each ? importers::repair_parts(raw, 1, options, 2).errors()
                                : importers::repair_mesh(raw, 1, options).errors();
    ASSERT_FALSE(errors.empty());
    EXPECT_NE(errors[0].message.find("open beyond repair: a hole"), std::string::npos) << errors[0].message;
    EXPECT_NE(errors[0].hint.find("largest_hole_mm"), std::string::npos) << errors[0].hint;
  }
  options.largest_hole = 2 * hole;
  const Result<std::vector<importers::CheckedMesh>> both = importers::repair_parts(raw, 1, options, 2);
  ASSERT_TRUE(both) << text_of(both.errors());
  EXPECT_EQ(both->size(), 2u);
}

TEST(Repair, ASheetIsCalledOneAndNobodyIsToldToCapIt) {
  const importers::RawMesh raw = zoo::without(zoo::box({0.1, 0.08, 0.01}, 4), [](Vec3 p) { return p.z < 0.0049; });
  const auto errors = importers::repair_mesh(raw, 1, {}).errors();
  ASSERT_FALSE(errors.empty());
  EXPECT_NE(errors[0].message.find("it is a sheet"), std::string::npos) << errors[0].message;
  EXPECT_EQ(errors[0].hint.find("largest_hole_mm"), std::string::npos) << errors[0].hint;
}

TEST(Repair, AVertexFarAwayIsNotCalledASheetAlone) {
  importers::RawMesh raw = zoo::sphere(0.05, 3);
  raw.vertex[7].x = 1000;
  const auto errors = importers::repair_mesh(raw, 1, {}).errors();
  ASSERT_FALSE(errors.empty());
  EXPECT_NE(errors[0].message.find("in its box of 1000"), std::string::npos) << errors[0].message;
  EXPECT_NE(errors[0].hint.find("a vertex lies far from the others"), std::string::npos) << errors[0].hint;
}

TEST(Repair, AShellWithinTheLargestIsACavity) {
  // A bladder with a wall of 2 mm, the inner shell drawn either way round.
  for (const bool is_turned : {false, true}) {
    const importers::RawMesh inner = zoo::sphere(0.028, 3);
    const importers::RawMesh raw = zoo::both(zoo::sphere(0.03, 3), is_turned ? zoo::flipped(inner, 1) : inner);
    const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
    ASSERT_TRUE(mesh) << text_of(mesh.errors());
    expect_closed(*mesh);
    EXPECT_NE(find(mesh->findings, "cavity"), nullptr) << summary(mesh->findings);
    EXPECT_NEAR(mesh->volume, volume_of(zoo::sphere(0.03, 3)) - volume_of(inner), 1e-12);
  }
}

TEST(Repair, APartBesideOrAcrossTheLargestIsNoCavity) {
  for (const double x : {0.2, 0.03}) {
    const Result<importers::CheckedMesh> mesh =
        importers::repair_mesh(zoo::both(zoo::sphere(0.03, 3), zoo::sphere(0.01, 3, {x, 0, 0})), 1);
    ASSERT_TRUE(mesh) << text_of(mesh.errors());
    EXPECT_EQ(summary(mesh->findings), "other_part x 1");
  }
}

TEST(Repair, EveryPartIsAMeshOfItsOwnWithItsName) {
  // The file's parts are an order of names; the largest mesh comes first.
  importers::RawMesh raw =
      zoo::both(zoo::both(zoo::sphere(0.02, 3, {0.1, 0, 0}), zoo::sphere(0.03, 3)), zoo::sphere(0.001, 1, {0, 0.1, 0}));
  raw.parts = {"spleen", "liver", "crumb"};
  const std::size_t part_size = zoo::sphere(0.02, 3).triangle.size();
  for (std::size_t t = 0; t < raw.triangle.size(); ++t)
    raw.part_of_triangle.push_back(t < part_size ? 0 : t < 2 * part_size ? 1 : 2);
  const Result<std::vector<importers::CheckedMesh>> meshes = importers::repair_parts(raw, 1, {}, 8);
  ASSERT_TRUE(meshes) << text_of(meshes.errors());
  ASSERT_EQ(meshes->size(), 2u) << "a crumb is no organ";
  EXPECT_EQ(meshes->at(0).part, 1);
  EXPECT_EQ(meshes->at(1).part, 0);
  EXPECT_NEAR(meshes->at(0).volume, volume_of(zoo::sphere(0.03, 3)), 1e-12);
  EXPECT_NEAR(meshes->at(1).volume, volume_of(zoo::sphere(0.02, 3)), 1e-12);
  for (const importers::CheckedMesh& mesh : *meshes) expect_closed(mesh);
  EXPECT_NE(find(meshes->at(0).findings, "other_part"), nullptr);
}

TEST(Repair, AHoleThatIsTooWideNamesTheLimitThatWouldDo) {
  const importers::RawMesh bowl = zoo::without(zoo::sphere(0.03, 3), [](Vec3 p) { return p.z > 0.01; });
  const Result<importers::CheckedMesh> refused = importers::repair_mesh(bowl, 1);
  ASSERT_FALSE(refused);
  const std::string hint = refused.errors().front().hint;
  ASSERT_EQ(hint.rfind("largest_hole_mm ", 0), 0u) << hint;
  importers::RepairOptions options;
  options.largest_hole = 1e-3 * std::stod(hint.substr(16));
  const Result<importers::CheckedMesh> capped = importers::repair_mesh(bowl, 1, options);
  ASSERT_TRUE(capped) << text_of(capped.errors());
  expect_closed(*capped);
}

TEST(Repair, CavityStaysACavityWithAllParts) {
  importers::RepairOptions options;
  options.all_parts = true;
  const Result<importers::CheckedMesh> mesh =
      importers::repair_mesh(zoo::both(ball(), zoo::sphere(0.02, 3)), 1, options);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  EXPECT_NEAR(mesh->volume, volume_of(ball()) - volume_of(zoo::sphere(0.02, 3)), 1e-12);
}

TEST(Repair, FinOnAnEdgeIsCutOff) {
  importers::RawMesh raw = ball();
  const importers::Triangle t = raw.triangle[0];
  raw.vertex.push_back(1.3 * raw.vertex[std::size_t(t[0])]);
  raw.triangle.push_back({t[0], t[1], std::int32_t(raw.vertex.size()) - 1});
  ASSERT_EQ(importers::count_mesh(raw.vertex, raw.triangle).non_manifold_edges, 1);
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "non_manifold_edge x 1, other_part x 1");
  EXPECT_EQ(mesh->triangle.size(), ball().triangle.size());
}

TEST(Repair, CubesThatShareAnEdgeAreParted) {
  const importers::RawMesh raw =
      zoo::both(zoo::box({0.1, 0.1, 0.1}), zoo::box({0.05, 0.05, 0.1}, 1, {0.075, 0.075, 0}));
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_NE(find(mesh->findings, "non_manifold_edge"), nullptr) << summary(mesh->findings);
  EXPECT_NE(find(mesh->findings, "other_part"), nullptr) << summary(mesh->findings);
  EXPECT_NEAR(mesh->volume, 1e-3, 1e-12);
}

TEST(Repair, CubesThatShareACornerAreParted) {
  const importers::RawMesh raw =
      zoo::both(zoo::box({0.1, 0.1, 0.1}), zoo::box({0.05, 0.05, 0.05}, 1, {0.075, 0.075, 0.075}));
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "unwelded x 1, non_manifold_vertex x 1, other_part x 1");
  EXPECT_NEAR(mesh->volume, 1e-3, 1e-12);
}

TEST(Repair, PinchedVertexIsSplitAndTold) {
  // Two far vertices of one ball drawn into one point: the surface touches itself there but stays one part.
  importers::RawMesh raw = zoo::torus(0.05, 0.02, 48, 24);
  const std::int32_t a = 12, b = 24 * 24 + 12;  // opposite places of the ring's inside
  raw.vertex[a] = raw.vertex[b] = {0, 0, 0};
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  EXPECT_EQ(summary(mesh->findings), "unwelded x 1, non_manifold_vertex x 1");
  ASSERT_TRUE(find(mesh->findings, "non_manifold_vertex")->place);
  EXPECT_LT(norm(*find(mesh->findings, "non_manifold_vertex")->place), 1e-12);
  EXPECT_EQ(mesh->vertex.size(), raw.vertex.size());
}

TEST(Repair, ManyDefectsAtOnceAreAllTold) {
  importers::RawMesh raw = zoo::without(ball(), is_at_pole);
  const std::size_t whole = raw.triangle.size();
  raw.triangle.push_back(raw.triangle[100]);
  raw.triangle.push_back({3, 4, 4});
  raw = zoo::unwelded(zoo::flipped(raw, 3));
  raw = zoo::both(raw, zoo::sphere(0.01, 2, {0.1, 0, 0}));
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  expect_closed(*mesh);
  for (const char* code : {"unwelded", "degenerate", "duplicate", "flipped", "hole", "other_part"})
    EXPECT_NE(find(mesh->findings, code), nullptr) << code << " is missing in: " << summary(mesh->findings);
  EXPECT_EQ(find(mesh->findings, "flipped")->count, std::int64_t((whole + 2) / 3));
  EXPECT_NEAR(mesh->volume, volume_of(ball()), 1e-3 * mesh->volume);
}

TEST(Repair, SheetIsRefused) {
  importers::RawMesh raw;
  raw.path = "sheet";
  raw.vertex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  raw.triangle = {{0, 1, 2}, {0, 2, 3}};
  for (const bool is_wide_allowed : {false, true}) {
    importers::RepairOptions options;
    if (is_wide_allowed) options.largest_hole = 10;
    const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1, options);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.errors()[0].where, "sheet");
  }
}

TEST(Repair, OnlyDegenerateFacesAreRefused) {
  importers::RawMesh raw;
  raw.path = "line";
  raw.vertex = {{0, 0, 0}, {1, 0, 0}};
  raw.triangle = {{0, 1, 1}, {0, 0, 1}};
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.errors()[0].message, "holds only triangles without area");
}

TEST(Repair, OptionsOutOfRangeAreRefused) {
  importers::RepairOptions options;
  EXPECT_FALSE(importers::repair_mesh(ball(), 0));
  EXPECT_FALSE(importers::repair_mesh(ball(), std::nan("")));
  options.largest_hole = -1;
  EXPECT_FALSE(importers::repair_mesh(ball(), 1, options));
  options.largest_hole.reset();
  options.weld_distance = 0.5;
  EXPECT_FALSE(importers::repair_mesh(ball(), 1, options));
}

TEST(Repair, MendedMeshWrittenAndReadAgainIsSound) {
  const zoo::Folder folder;
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(zoo::unwelded(zoo::flipped(ball(), 5)), 1);
  ASSERT_TRUE(mesh);
  const std::string path = folder.path() + "/mended.obj";
  ASSERT_TRUE(importers::write_obj(path, mesh->vertex, mesh->triangle));
  const Result<importers::RawMesh> read = importers::read_mesh(path);
  ASSERT_TRUE(read) << text_of(read.errors());
  const Result<importers::CheckedMesh> again = importers::repair_mesh(*read, 0.001);
  ASSERT_TRUE(again) << text_of(again.errors());
  EXPECT_EQ(summary(again->findings), "");
  EXPECT_NEAR(again->volume, mesh->volume, 1e-5 * mesh->volume);
  EXPECT_FALSE(importers::write_obj(folder.path() + "/no/folder.obj", mesh->vertex, mesh->triangle));
}

TEST(Topology, AMeshIsClosedAndOrientedWhereEveryEdgeRunsBothWays) {
  const importers::RawMesh ball = zoo::sphere(0.05, 3);
  EXPECT_TRUE(importers::is_closed_and_oriented(ball.triangle));
  std::vector<importers::Triangle> open = ball.triangle, turned = ball.triangle, finned = ball.triangle;
  open.pop_back();
  EXPECT_FALSE(importers::is_closed_and_oriented(open));
  std::swap(turned[7][1], turned[7][2]);
  EXPECT_FALSE(importers::is_closed_and_oriented(turned));
  finned.push_back(finned[3]), std::swap(finned.back()[1], finned.back()[2]);
  EXPECT_FALSE(importers::is_closed_and_oriented(finned));
}

}  // namespace
}  // namespace ctpm
