#include "importers/import.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "zoo.h"

namespace ctpm {
namespace {

using zoo::find;
using zoo::summary;
using zoo::text_of;

TEST(Import, ShippedOrgansAreSoundAndHaveTheirVolume) {
  struct Organ {
    const char* name;
    double volume_ml;
    std::int64_t triangles;
    Vec3 size_mm;
  };
  for (const Organ& organ : {Organ{"liver", 1255, 5598, {223, 151, 90}}, Organ{"kidney", 163, 3210, {110, 59, 45}},
                             Organ{"skin", 383, 3214, {120, 120, 30}}}) {
    SCOPED_TRACE(organ.name);
    importers::ImportOptions options;
    options.unit_in_metres = 0.001;
    options.sphere_radius = 0.0025;
    const Result<importers::ImportedOrgan> imported =
        importers::import_organ(std::string(CTPM_SOURCE_DIR "/scenes/organs/") + organ.name + ".obj", options);
    ASSERT_TRUE(imported) << text_of(imported.errors());
    const importers::ImportReport& report = imported->report;
    EXPECT_EQ(summary(report.findings), "");
    EXPECT_EQ(report.before.triangles, organ.triangles);
    EXPECT_EQ(report.after.triangles, organ.triangles);
    EXPECT_EQ(report.after.parts, 1);
    EXPECT_NEAR(report.mesh_volume, 1e-6 * organ.volume_ml, 0.5e-6 + 1e-3 * report.mesh_volume);
    const Vec3 size = report.box_most - report.box_least;
    EXPECT_LT(norm(1e3 * size - organ.size_mm), 1.0);
    EXPECT_NEAR(report.box_least.z, 0, 1e-6);
    // Flat faces are off by up to half a spacing; over a whole organ a tenth of a spacing is left.
    EXPECT_NEAR(report.fill.filled_volume, report.mesh_volume, 0.1 * report.mesh_area * report.spacing);
    EXPECT_GE(report.fill.spheres_per_layer.size(), 2u);
  }
}

TEST(Import, QuarterTurnsAreExactAndOthersKeepLengths) {
  const Vec3 p{1, 2, 3};
  const auto turned = [&](Vec3 degrees) { return importers::turned({p}, degrees)[0]; };
  EXPECT_EQ(turned({0, 0, 0}), p);
  EXPECT_EQ(turned({90, 0, 0}), (Vec3{1, -3, 2}));
  EXPECT_EQ(turned({0, -90, 0}), (Vec3{-3, 2, 1}));
  EXPECT_EQ(turned({0, 0, 270}), (Vec3{2, -1, 3}));
  EXPECT_EQ(turned({180, 0, 90}), (Vec3{2, 1, -3})) << "about x first";
  EXPECT_EQ(turned({360, -360, 0}), p);
  EXPECT_LT(norm(turned({0, 0, 30}) - Vec3{std::sqrt(3.0) / 2 - 1, 0.5 + std::sqrt(3.0), 3}), 1e-15);
  EXPECT_NEAR(norm(turned({12, -34, 56})), norm(p), 1e-15);
}

TEST(Import, AMeshIsTurnedAndScaledAboutItsOrigin) {
  const zoo::Folder folder;
  const std::string path = folder.write("box.obj", zoo::to_obj_text(zoo::box({60, 40, 20}, 4, {100, 0, 0})));
  importers::ImportOptions options;
  options.unit_in_metres = 0.001, options.sphere_radius = 0.004;
  options.turn = {0, 0, 90}, options.scale = 2;
  const Result<importers::ImportedOrgan> imported = importers::import_organ(path, options);
  ASSERT_TRUE(imported) << text_of(imported.errors());
  const importers::ImportReport& report = imported->report;
  EXPECT_LT(norm(report.box_least - Vec3{-0.04, 0.14, -0.02}), 1e-12);
  EXPECT_LT(norm(report.box_most - Vec3{0.04, 0.26, 0.02}), 1e-12);
  EXPECT_NEAR(report.mesh_volume, 8 * 48e-6, 1e-12);
}

TEST(Import, CrumbsOfAnOpenMeshAreNoOrgans) {
  // A landscape that cannot be closed, with a closed crumb beside it: what is open is said.
  const zoo::Folder folder;
  const importers::RawMesh open = zoo::without(zoo::box({200, 200, 40}, 10), [](Vec3 p) { return p.z > 19; });
  const std::string path = folder.write("land.obj", zoo::to_obj_text(zoo::both(open, zoo::sphere(2, 2, {150, 0, 0}))));
  importers::ImportOptions options;
  options.unit_in_metres = 0.001;
  const Result<importers::RepairedFile> parts = importers::repair_file(path, options, 8);
  ASSERT_FALSE(parts);
  EXPECT_NE(text_of(parts.errors()).find("open beyond repair: a hole"), std::string::npos) << text_of(parts.errors());
}

TEST(Import, GuessedUnitIsSaidAloud) {
  const zoo::Folder folder;
  const std::string path = folder.write("ball.stl", zoo::to_binary_stl(zoo::sphere(60, 3)));
  const Result<importers::ImportedOrgan> imported = importers::import_organ(path);
  ASSERT_TRUE(imported) << text_of(imported.errors());
  EXPECT_EQ(summary(imported->report.findings), "unit_guessed x 1");
  EXPECT_EQ(imported->report.unit.in_metres, 0.001);
  const std::string text = importers::to_text(imported->report);
  EXPECT_NE(text.find("unit: mm (guessed from the size)"), std::string::npos) << text;
  EXPECT_NE(text.find("give the unit or the size if that is wrong"), std::string::npos) << text;
}

TEST(Import, UnusualSizeIsTold) {
  const zoo::Folder folder;
  const std::string path = folder.write("ball.stl", zoo::to_binary_stl(zoo::sphere(60, 3)));
  importers::ImportOptions options;
  options.unit_in_metres = 0.01;  // 1.2 m across
  options.sphere_radius = 0.03;
  const Result<importers::ImportedOrgan> imported = importers::import_organ(path, options);
  ASSERT_TRUE(imported) << text_of(imported.errors());
  EXPECT_EQ(summary(imported->report.findings), "unusual_size x 1");
}

TEST(Import, UnitOfTheFileIsTaken) {
  const zoo::Folder folder;
  for (const auto& [name, bytes] : {std::pair<const char*, std::string>{"cm.dae", zoo::to_dae(zoo::sphere(6, 3), 0.01)},
                                    {"m.glb", zoo::to_glb(zoo::sphere(0.06, 3))},
                                    {"cm.fbx", zoo::to_fbx(zoo::sphere(6, 3), 1)}}) {
    SCOPED_TRACE(name);
    const Result<importers::ImportedOrgan> imported = importers::import_organ(folder.write(name, bytes));
    ASSERT_TRUE(imported) << text_of(imported.errors());
    EXPECT_EQ(imported->report.unit.source, importers::UnitSource::file);
    EXPECT_EQ(summary(imported->report.findings), "");
    EXPECT_NEAR(imported->report.box_most.x - imported->report.box_least.x, 0.12, 0.001);
  }
}

TEST(Import, ErrorsNameTheFile) {
  const zoo::Folder folder;
  const importers::RawMesh open = zoo::without(zoo::sphere(60, 3), [](Vec3 p) { return p.z > 20; });
  const std::string path = folder.write("open.obj", zoo::to_obj_text(open));
  const Result<importers::ImportedOrgan> imported = importers::import_organ(path);
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.errors()[0].where, path);
  EXPECT_NE(imported.errors()[0].message.find("a hole"), std::string::npos) << text_of(imported.errors());
  importers::ImportOptions large;
  large.sphere_radius = 0.5;
  large.largest_hole = 0.2;
  // Even the largest sphere has its centre in the middle of a ball, so take one that is too fine instead.
  large.sphere_radius = 1e-6;
  const Result<importers::ImportedOrgan> fine = importers::import_organ(path, large);
  ASSERT_FALSE(fine);
  EXPECT_EQ(fine.errors()[0].where, path);
}

TEST(Import, AnOrganOfAWrongUnitIsRefusedBeforeItIsFilled) {
  const zoo::Folder folder;
  const std::string path = folder.write("ball.stl", zoo::to_binary_stl(zoo::sphere(60, 3)));
  importers::ImportOptions options;
  options.usual_size = {0.1, 0.2}, options.sphere_radius = 0.004, options.unit_in_metres = 0.01;
  options.progress = [](const std::string& stage, double) { EXPECT_NE(stage.substr(0, 4), "fill"); };
  const Result<importers::ImportedOrgan> wrong = importers::import_organ(path, options);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.errors()[0].where, path);
  for (const char* part : {"1200 x 1200 x 1200 mm", "usual: 100 mm to 200 mm", "spheres 12 mm apart", "mesh_unit"})
    EXPECT_NE(text_of(wrong.errors()).find(part), std::string::npos) << text_of(wrong.errors());
  // A large organ of few spheres is its author's matter, and so is one of many spheres that is as large as usual.
  options.progress = {}, options.sphere_radius = 0.04;
  EXPECT_TRUE(importers::import_organ(path, options));
  options.sphere_radius = 0.0009, options.unit_in_metres = 0.001;
  EXPECT_TRUE(importers::import_organ(path, options));
}

TEST(Import, AllOptionsOutOfRangeAreToldAtOnce) {
  importers::ImportOptions options;
  options.unit_in_metres = -1;
  options.usual_size = {1, 0.5};
  options.largest_hole = -1;
  options.sphere_radius = 0;
  options.gap = std::nan("");
  options.most_spheres = 0;
  options.threads = 0;
  options.time_limit_s = 0;
  const Result<importers::ImportedOrgan> imported = importers::import_organ("nowhere.obj", options);
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.errors().size(), 8u);
}

TEST(Import, ProgressNeverFallsAndEndsWhole) {
  const zoo::Folder folder;
  const std::string path = folder.write("ball.stl", zoo::to_binary_stl(zoo::sphere(60, 4)));
  importers::ImportOptions options;
  std::vector<double> told;
  std::set<std::string> stages;
  options.progress = [&](const std::string& stage, double fraction) {
    told.push_back(fraction);
    stages.insert(stage.substr(0, stage.find(':')));
  };
  ASSERT_TRUE(importers::import_organ(path, options));
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.front(), 0.0);
  EXPECT_EQ(told.back(), 1.0);
  EXPECT_GE(told.size(), 8u);
  EXPECT_EQ(stages, (std::set<std::string>{"read", "repair", "fill"}));
}

TEST(Import, ProgressIsToldBeforeTheMeshIsRead) {
  const zoo::Folder folder;
  const std::string path = folder.write("ball.stl", zoo::to_binary_stl(zoo::sphere(60, 3)));
  importers::ImportOptions options;
  int told = 0;
  // What is written when progress is told first is what is read.
  options.progress = [&](const std::string& stage, double) {
    if (++told > 1) return;
    EXPECT_EQ(stage, "read");
    folder.write("ball.stl", zoo::to_binary_stl(zoo::sphere(60, 4)));
  };
  const Result<importers::ImportedOrgan> imported = importers::import_organ(path, options);
  ASSERT_TRUE(imported) << text_of(imported.errors());
  EXPECT_EQ(imported->report.before.triangles, 20 * 256);
  EXPECT_GT(told, 1);
}

}  // namespace
}  // namespace ctpm
