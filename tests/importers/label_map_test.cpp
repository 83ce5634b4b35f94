// Label maps, from files that other programs wrote (maps/make.py) and from lattices that are made here.

#include "importers/label_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>

#include "importers/import.h"
#include "importers/label_surface.h"
#include "zoo.h"

namespace ctpm {
namespace {

using importers::Label;
using importers::LabelMap;
using zoo::text_of;

std::string map_path(const std::string& name) { return CTPM_SOURCE_DIR "/tests/importers/maps/" + name; }

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

#define SKIP_WITHOUT_ITK() \
  if (!importers::reads_label_maps()) GTEST_SKIP() << "this build has no ITK"

/// A map with one label where `is_in` holds of the voxel's centre [mm].
LabelMap map_of(std::array<std::int32_t, 3> size, std::array<Vec3, 3> step, Vec3 centre,
                const std::function<bool(Vec3)>& is_in) {
  LabelMap map;
  map.size = size, map.step = step;
  map.origin = centre;
  for (std::size_t d = 0; d < 3; ++d) map.origin = map.origin - 0.5 * (size[d] - 1) * step[d];
  Label label;
  label.number = 5;
  for (std::int32_t k = 0; k < size[2]; ++k)
    for (std::int32_t j = 0; j < size[1]; ++j)
      for (std::int32_t i = 0; i < size[0]; ++i) {
        const bool in = is_in(map.origin + double(i) * step[0] + double(j) * step[1] + double(k) * step[2]);
        map.value.push_back(in ? label.number : 0), label.voxels += in;
      }
  label.volume = 1e-9 * double(label.voxels) * std::abs(dot(step[0], cross(step[1], step[2])));
  map.labels = {label};
  return map;
}

/// The surface as a checked mesh.
Result<importers::CheckedMesh> surface_of(const LabelMap& map) {
  importers::Soup soup = importers::label_surface(map, map.labels[0]);
  importers::RawMesh raw;
  raw.path = "label", raw.vertex = std::move(soup.vertex), raw.triangle = std::move(soup.triangle);
  importers::RepairOptions options;
  options.all_parts = true;
  return importers::repair_mesh(raw, 1e-3, options);
}

constexpr double kVolumeShare = 0.01;  // the promise

struct Shape {
  const char* name;
  std::function<bool(Vec3)> is_in;
  double volume;                            ///< [mm^3]
  std::function<double(Vec3)> height_over;  ///< distance from the true surface, or a bound of it [mm]
  double bound;                             ///< of that, in the longest step
};

std::vector<Shape> shapes() {
  const double pi = std::numbers::pi;
  const auto ellipsoid = [](Vec3 p, Vec3 h) { return norm(Vec3{p.x / h.x, p.y / h.y, p.z / h.z}); };
  const Vec3 half{34, 22, 16};
  return {{"ball", [](Vec3 p) { return norm(p) <= 25; }, 4 / 3.0 * pi * 25 * 25 * 25,
           [](Vec3 p) { return norm(p) - 25; }, 0.6},
          {"ellipsoid", [=](Vec3 p) { return ellipsoid(p, half) <= 1; }, 4 / 3.0 * pi * half.x * half.y * half.z,
           [=](Vec3 p) { return half.z * (ellipsoid(p, half) - 1); }, 0.6},
          {"box", [](Vec3 p) { return std::abs(p.x) <= 30 && std::abs(p.y) <= 20 && std::abs(p.z) <= 15; },
           8 * 30 * 20 * 15,
           [](Vec3 p) {
             return std::max({std::abs(p.x) - 30, std::abs(p.y) - 20, std::abs(p.z) - 15});
           },
           1.5}};  // its corners are rounded
}

struct Lattice {
  const char* name;
  std::array<std::int32_t, 3> size;
  std::array<Vec3, 3> step;
};

std::vector<Lattice> lattices() {
  const double c = std::cos(0.4), s = std::sin(0.4);
  return {{"1 mm", {90, 70, 60}, {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
          {"0.4 mm", {200, 140, 130}, {Vec3{0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}}},
          {"slices of 4 mm", {100, 80, 16}, {Vec3{0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 4}}},
          {"left-handed", {90, 70, 60}, {Vec3{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
          {"turned", {80, 80, 40}, {Vec3{1.2 * c, 1.2 * s, 0}, {-1.1 * s, 1.1 * c, 0}, {0, 0, 2}}}};
}

TEST(LabelSurface, EnclosesTheLabelAndFollowsItsShapeOnEveryLattice) {
  for (const Shape& shape : shapes())
    for (const Lattice& lattice : lattices()) {
      // A smooth shape on each lattice, the others on the plain one and on thick slices.
      if (shape.name != std::string("ellipsoid") && lattice.name != std::string("1 mm") &&
          lattice.name != std::string("slices of 4 mm"))
        continue;
      SCOPED_TRACE(std::string(shape.name) + ", " + lattice.name);
      const Vec3 centre{31.3, -12.7, 8.1};
      const LabelMap map = map_of(lattice.size, lattice.step, centre, [&](Vec3 p) { return shape.is_in(p - centre); });
      const auto mesh = surface_of(map);
      ASSERT_TRUE(mesh) << text_of(mesh.errors());
      EXPECT_EQ(zoo::summary(mesh->findings), "") << "closed, manifold and outwards without any repair";
      EXPECT_NEAR(mesh->volume / map.labels[0].volume, 1, kVolumeShare);
      EXPECT_LT(mesh->triangle.size(), 120'000u);
      double longest = 0, worst = 0;
      for (const Vec3& step : lattice.step) longest = std::max(longest, norm(step));
      for (const Vec3& p : mesh->vertex) worst = std::max(worst, std::abs(shape.height_over(1e3 * p - centre)));
      EXPECT_LT(worst, shape.bound * std::max(longest, 1.2)) << "mm off";
    }
}

TEST(LabelSurface, AThinWallAndSeparatePartsKeepTheirVolume) {
  const auto wall = [](Vec3 p) { return norm(p) <= 25 && norm(p) >= 23; };
  const auto two = [](Vec3 p) { return norm(p - Vec3{-20, 0, 0}) <= 12 || norm(p - Vec3{22, 3, 0}) <= 6; };
  for (const auto& is_in : {std::function<bool(Vec3)>(wall), std::function<bool(Vec3)>(two)}) {
    const LabelMap map = map_of({80, 60, 60}, lattices()[0].step, {}, is_in);
    const importers::Soup soup = importers::label_surface(map, map.labels[0]);
    const double volume = importers::signed_volume(soup.vertex, soup.triangle, {});
    EXPECT_NEAR(1e-9 * volume / map.labels[0].volume, 1, kVolumeShare);
    EXPECT_EQ(importers::find_parts(soup.triangle).count, 2);
  }
}

TEST(LabelSurface, ALabelAtTheEdgeOfTheImageIsClosed) {
  const LabelMap map = map_of({40, 40, 40}, lattices()[0].step, {}, [](Vec3) { return true; });
  const auto mesh = surface_of(map);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  EXPECT_NEAR(mesh->volume / 64e-6, 1, kVolumeShare);
}

// The ellipsoid and the ball of make.py, in its RAS millimetres turned to LPS: x and y change their sign.
constexpr double kEllipsoidMl = 37.699, kBallMl = 2.1447;

void expect_ellipsoid(const std::string& file, const std::string& part, double bound_mm) {
  SCOPED_TRACE(file);
  importers::ReadOptions options;
  options.part = part;
  const Result<importers::RawMesh> raw = importers::read_mesh(map_path(file), options);
  ASSERT_TRUE(raw) << text_of(raw.errors());
  EXPECT_EQ(raw->unit_in_metres, 1e-3);
  const auto mesh = importers::repair_mesh(*raw, raw->unit_in_metres);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  EXPECT_NEAR(1e6 * mesh->volume / kEllipsoidMl, 1, 0.015) << "the voxels themselves are off by as much as 0.5 %";
  const Vec3 centre{-50, 40, 30}, half{30, 20, 15};
  for (const Vec3& p : mesh->vertex) {
    const Vec3 q = 1e3 * p - centre;
    ASSERT_LT(std::abs(half.z * (norm(Vec3{q.x / half.x, q.y / half.y, q.z / half.z}) - 1)), bound_mm);
  }
}

TEST(LabelMap, LiesWhereItsWriterPutItInLps) {
  SKIP_WITHOUT_ITK();
  expect_ellipsoid("oblique.nii.gz", "1", 1.5);
  expect_ellipsoid("mirrored.nii.gz", "1", 0.9);
  expect_ellipsoid("names.seg.nrrd", "left_kidney", 1.2);
}

TEST(LabelMap, ListsNumbersNamesAndVolumes) {
  SKIP_WITHOUT_ITK();
  for (const std::string file : {"oblique.nii.gz", "mirrored.nii.gz", "names.seg.nrrd"}) {
    SCOPED_TRACE(file);
    const Result<std::vector<Label>> labels = importers::list_labels(map_path(file));
    ASSERT_TRUE(labels) << text_of(labels.errors());
    ASSERT_EQ(labels->size(), 2u);
    EXPECT_EQ((*labels)[0].number, 1);
    EXPECT_EQ((*labels)[1].number, 7);
    EXPECT_NEAR(1e6 * (*labels)[0].volume / kEllipsoidMl, 1, 0.01);
    EXPECT_NEAR(1e6 * (*labels)[1].volume / kBallMl, 1, 0.06);
    const bool has_names = file == "names.seg.nrrd";
    EXPECT_EQ((*labels)[0].name, has_names ? "left_kidney" : "");
    EXPECT_EQ((*labels)[1].text(), has_names ? "stone" : "7");
    EXPECT_EQ(importers::find_label(*labels, "7"), 1);
    EXPECT_EQ(importers::find_label(*labels, "stone"), has_names ? 1 : -1);
  }
}

TEST(LabelMap, ALabelIsImportedLikeAMesh) {
  SKIP_WITHOUT_ITK();
  importers::ImportOptions options;
  options.part = "left_kidney";
  options.sphere_radius = 0.002;
  const auto imported = importers::import_organ(map_path("names.seg.nrrd"), options);
  ASSERT_TRUE(imported) << text_of(imported.errors());
  EXPECT_EQ(zoo::summary(imported->report.findings), "");
  EXPECT_EQ(imported->report.unit.source, importers::UnitSource::file);
  EXPECT_NEAR(1e6 * imported->report.fill.filled_volume / kEllipsoidMl, 1, 0.02);
}

void expect_refused(const std::string& path, const std::string& part, const std::string& message) {
  importers::ReadOptions options;
  options.part = part;
  const Result<importers::RawMesh> raw = importers::read_mesh(path, options);
  ASSERT_FALSE(raw) << path;
  EXPECT_EQ(raw.errors()[0].where, path);
  EXPECT_NE(text_of(raw.errors()).find(message), std::string::npos) << text_of(raw.errors());
}

TEST(LabelMap, WhatIsNoneIsRefusedWithTheReason) {
  SKIP_WITHOUT_ITK();
  expect_refused(map_path("image.nii.gz"), "1", "more than 4096 different values");
  expect_refused(map_path("sheared.nii.gz"), "1", "orthonormal");
  expect_refused(map_path("oblique.nii.gz"), "3", "the file holds \"1\", \"7\"");
  expect_refused(map_path("oblique.nii.gz"), "", "choose one of 1, 7");
  const zoo::Folder folder;
  const std::string nrrd =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspace dimension: 3\nspace directions: (1,0,0) (0,1,0) "
      "(0,0,1)\n";
  expect_refused(folder.write("far.nrrd", nrrd + "encoding: raw\ndata file: /etc/passwd\n\n"), "", "another file");
  expect_refused(folder.write("empty.nrrd", nrrd + "encoding: raw\n\n" + std::string(8, '\0')), "", "holds no label");
  expect_refused(folder.write("text.nrrd", "hello"), "", "not a label map that can be read");
  expect_refused(
      folder.write("half.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: 1 1 2\nencoding: ascii\n\n0 0.5\n"), "",
      "0.5, which is not a whole number");
}

TEST(LabelMap, AHeaderThatPromisesMoreThanTheFileHoldsCostsNoMemory) {
  SKIP_WITHOUT_ITK();
  const zoo::Folder folder;
  for (const std::string sizes : {"700 700 700", "2000000 2000000 2000000", "-3 4 4", "99999999999999999999 1 1"})
    for (const std::string encoding : {"raw", "gzip", "ascii", "hex"}) {
      SCOPED_TRACE(sizes + " " + encoding);
      const std::string path =
          folder.write("huge.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: " + sizes + "\nencoding: " + encoding +
                                        "\n\n" + std::string(64, '\1'));
      importers::ReadOptions options;
      options.memory_limit_mib = 200;
      const Result<importers::RawMesh> raw = importers::read_mesh(path, options);
      ASSERT_FALSE(raw);
      EXPECT_EQ(text_of(raw.errors()).find("MiB"), std::string::npos) << text_of(raw.errors());
      EXPECT_EQ(text_of(raw.errors()).find("crashed"), std::string::npos) << text_of(raw.errors());
    }
}

TEST(LabelMap, DamagedFilesEndAsASurfaceOrAsAnError) {
  SKIP_WITHOUT_ITK();
  const zoo::Folder folder;
  for (const std::string file : {"oblique.nii.gz", "names.seg.nrrd", "plain.nii"}) {
    const std::string bytes = bytes_of(map_path(file));
    std::mt19937 random(7);
    for (int round = 0; round < 40; ++round) {
      SCOPED_TRACE(file + ", round " + std::to_string(round));
      const std::string damaged = zoo::damaged(bytes, random, round % 4 == 0, round % 2 ? 400 : bytes.size());
      importers::ReadOptions options;
      options.part = "1";
      options.time_limit_s = 20;
      options.memory_limit_mib = 1024;
      const std::string path = folder.write(file, damaged);
      const Result<importers::RawMesh> raw = importers::read_mesh(path, options);
      if (raw) continue;
      EXPECT_EQ(raw.errors()[0].where, path);
      EXPECT_FALSE(raw.errors()[0].message.empty());
      EXPECT_EQ(raw.errors()[0].message.find("took longer"), std::string::npos) << raw.errors()[0].message;
    }
  }
}

TEST(LabelMap, ABuildWithoutItkSaysSo) {
  if (importers::reads_label_maps()) GTEST_SKIP() << "this build has ITK";
  expect_refused(map_path("oblique.nii.gz"), "1", "CTPM_LABELS");
}

}  // namespace
}  // namespace ctpm
