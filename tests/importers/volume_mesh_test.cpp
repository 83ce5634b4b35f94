// Volume meshes that Gmsh, meshio and VTK wrote (maps/make.py), read by their boundary.

#include "importers/volume_mesh.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "importers/import.h"
#include "importers/topology.h"
#include "zoo.h"

namespace ctpm {
namespace {

using zoo::text_of;

std::string mesh_path(const std::string& name) { return CTPM_SOURCE_DIR "/tests/importers/maps/" + name; }

const std::vector<std::string> kFiles{"text41.msh",   "binary41.msh", "text22.msh",   "binary22.msh", "text42.vtk",
                                      "binary42.vtk", "binary51.vtk", "slicer42.vtk", "slicer51.vtk", "text.vtu",
                                      "plain.vtu",    "zlib.vtu",     "appended.vtu", "raw.vtu"};

// What numpy makes of Gmsh's tetrahedra (maps/make.py prints it) [mm^3].
constexpr double kAll = 36247.55559, kCore = 1645.58247, kShell = 34601.97313;
constexpr double kDigits = 1e-6;  // files as text have eleven digits

Result<importers::CheckedMesh> mesh_of(const std::string& path, const std::string& part = "") {
  importers::ReadOptions options;
  options.part = part;
  const Result<importers::RawMesh> raw = importers::read_mesh(path, options);
  if (!raw) return raw.errors();
  return importers::repair_mesh(*raw, 1e-3);
}

TEST(VolumeMesh, EveryFormatHasTheBoundaryOfItsTetrahedra) {
  for (const std::string& file : kFiles) {
    SCOPED_TRACE(file);
    const auto mesh = mesh_of(mesh_path(file));
    ASSERT_TRUE(mesh) << text_of(mesh.errors());
    EXPECT_EQ(zoo::summary(mesh->findings), "") << "closed and outwards";
    EXPECT_NEAR(1e9 * mesh->volume / kAll, 1, kDigits);
    EXPECT_NEAR(1e3 * (mesh->box_most.x - mesh->box_least.x), 60, 1);
    EXPECT_NEAR(1e3 * (mesh->box_most.z - mesh->box_least.z), 30, 1);
  }
}

TEST(VolumeMesh, ARegionIsChosenByItsName) {
  for (const std::string file : {"text41.msh", "binary41.msh", "text22.msh", "binary22.msh"}) {
    SCOPED_TRACE(file);
    const auto core = mesh_of(mesh_path(file), "core");
    ASSERT_TRUE(core) << text_of(core.errors());
    EXPECT_NEAR(1e9 * core->volume / kCore, 1, kDigits);
    importers::ReadOptions options;
    options.part = "shell";
    const auto shell = importers::read_mesh(mesh_path(file), options);
    ASSERT_TRUE(shell) << text_of(shell.errors());
    EXPECT_EQ(shell->parts, (std::vector<std::string>{"core", "shell"}));
    EXPECT_NEAR(importers::signed_volume(shell->vertex, shell->triangle, {}) / kShell, 1, kDigits);
    const auto none = mesh_of(mesh_path(file), "skin");
    ASSERT_FALSE(none);
    EXPECT_NE(text_of(none.errors()).find("the file holds \"core\", \"shell\""), std::string::npos);
  }
}

TEST(VolumeMesh, HexahedraWedgesAndPyramidsHaveFacesToo) {
  const zoo::Folder folder;
  // A cube of two wedges, with a pyramid on it, beside a cube: 1 + 1/3 + 1 units.
  const std::string text =
      "# vtk DataFile Version 3.0\nmixed\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 13 float\n"
      "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 0.5 0.5 2 2 0 0 2 1 0 2 0 1 2 1 1\n"
      "CELLS 4 29\n6 0 1 2 4 5 6\n6 0 2 3 4 6 7\n5 4 5 6 7 8\n8 1 9 10 2 5 11 12 6\nCELL_TYPES 4\n13 13 14 12\n";
  const auto mesh = mesh_of(folder.write("mixed.vtk", text));
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  EXPECT_NEAR(1e9 * mesh->volume, 2 + 1 / 3.0, 1e-9);
}

TEST(VolumeMesh, WhatCannotBeReadIsRefusedWithTheReason) {
  const zoo::Folder folder;
  const auto expect_refused = [&](const std::string& name, const std::string& text, const std::string& message) {
    const std::string path = folder.write(name, text);
    const auto mesh = mesh_of(path);
    ASSERT_FALSE(mesh) << name;
    EXPECT_EQ(mesh.errors()[0].where, path);
    EXPECT_NE(text_of(mesh.errors()).find(message), std::string::npos) << text_of(mesh.errors());
  };
  expect_refused("a.msh", "hello", "not a file of Gmsh");
  expect_refused("b.msh", "$MeshFormat\n1.0 0 8\n$EndMeshFormat\n", "2.2 and 4.1 are read");
  expect_refused("c.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n2 1 0 99999999999\n",
                 "promises more");
  expect_refused("d.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Elements\n1\n1 4 0 1 2 3 9\n$EndElements\n",
                 "node 1");
  const std::string vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET ";
  expect_refused("a.vtk", "# vtk", "legacy VTK file");
  expect_refused("b.vtk", vtk + "STRUCTURED_POINTS\n", "STRUCTURED_POINTS");
  expect_refused("c.vtk", vtk + "UNSTRUCTURED_GRID\nPOINTS 4000000000 float\n1 2 3\n", "promises more");
  expect_refused("d.vtk", vtk + "UNSTRUCTURED_GRID\nPOINTS 1 float\n1 2 3\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n",
                 "uses point 1 of 1");
  expect_refused("e.vtk", vtk + "UNSTRUCTURED_GRID\nPOINTS 1 float\n1 2 x\n", "'x' where a number belongs");
  expect_refused("a.vtu", "<VTKFile", "not XML");
  expect_refused("b.vtu", "<VTKFile type=\"ImageData\"/>", "not a VTK file of an unstructured grid");
  expect_refused("c.vtu", "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkLZMADataCompressor\"/>", "compressed by");
}

TEST(VolumeMesh, DamagedFilesEndAsAMeshOrAsAnError) {
  const zoo::Folder folder;
  constexpr int kRounds = 12;
  for (const std::string& file : kFiles) {
    std::ifstream in(mesh_path(file), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::mt19937 random(11);
    for (int round = 0; round < kRounds; ++round) {
      SCOPED_TRACE(file + ", round " + std::to_string(round));
      const std::string damaged = zoo::damaged(bytes, random, round % 3 == 0, round % 2 ? 600 : bytes.size());
      importers::ReadOptions options;
      options.time_limit_s = 20;
      options.memory_limit_mib = 256;
      const std::string path = folder.write(file, damaged);
      const Result<importers::RawMesh> raw = importers::read_mesh(path, options);
      if (raw) continue;
      EXPECT_EQ(raw.errors()[0].where, path);
      EXPECT_FALSE(raw.errors()[0].message.empty());
      for (const char* fault : {"took longer", "MiB", "crashed"})
        EXPECT_EQ(raw.errors()[0].message.find(fault), std::string::npos) << raw.errors()[0].message;
    }
  }
}

}  // namespace
}  // namespace ctpm
