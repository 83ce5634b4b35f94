#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "importers/formats.h"
#include "importers/mesh.h"
#include "importers/topology.h"
#include "zoo.h"

namespace ctpm {
namespace {

using zoo::text_of;

constexpr double kFloat = 1e-6;  // relative; files and the reader hold single precision

/// A sphere off the origin, so that a lost transform or axis would show.
importers::RawMesh sample() { return zoo::sphere(0.06, 3, {0.01, 0.02, 0.04}); }

struct Written {
  const char* name;
  std::string bytes;
  double said_unit;  // [m], 0: none
  double scale;      // of the positions that come out
};

std::vector<Written> all_formats(const importers::RawMesh& mesh) {
  return {{"organ.obj", zoo::to_obj_text(mesh), 0, 1},
          {"ascii.stl", zoo::to_ascii_stl(mesh), 0, 1},
          {"binary.stl", zoo::to_binary_stl(mesh), 0, 1},
          {"UPPER.STL", zoo::to_binary_stl(mesh), 0, 1},
          {"ascii.ply", zoo::to_ascii_ply(mesh), 0, 1},
          {"binary.ply", zoo::to_binary_ply(mesh), 0, 1},
          {"organ.off", zoo::to_off(mesh), 0, 1},
          {"organ.gltf", zoo::to_gltf(mesh), 1, 1},
          {"scaled.gltf", zoo::to_gltf(mesh, 0.5), 1, 0.5},
          {"organ.glb", zoo::to_glb(mesh), 1, 1},
          {"cm.dae", zoo::to_dae(mesh, 0.01), 1, 0.01},
          {"mm.fbx", zoo::to_fbx(mesh, 0.1), 0.001, 1},
          {"organ.3ds", zoo::to_3ds(mesh), 0, 1}};
}

/// By a file that is read, below, or by what is said of one that holds something else.
TEST(ReadMesh, EveryEndingThatIsOfferedHasAReader) {
  const zoo::Folder folder;
  const auto has_reader = [&](const std::string& ending) {
    const auto read = importers::read_mesh(folder.write("organ" + ending, "no organ"));
    return text_of(read.errors()).find("No suitable reader found") == std::string::npos;
  };
  const std::vector<std::string> endings = importers::readable_endings();
  std::set<std::string> shown;
  for (const Written& file : all_formats(sample()))
    if (const std::string name = file.name; name != "UPPER.STL") shown.insert(name.substr(name.rfind('.')));
  for (const std::string& ending : shown) EXPECT_TRUE(std::count(endings.begin(), endings.end(), ending)) << ending;
  EXPECT_FALSE(has_reader(".docx"));
  for (const std::string& ending : endings) EXPECT_TRUE(shown.contains(ending) || has_reader(ending)) << ending;
}

TEST(ReadMesh, EveryFormatGivesTheSameMesh) {
  const zoo::Folder folder;
  const importers::RawMesh mesh = sample();
  const double volume = importers::signed_volume(mesh.vertex, mesh.triangle, {});
  for (const Written& file : all_formats(mesh)) {
    SCOPED_TRACE(file.name);
    const Result<importers::RawMesh> read = importers::read_mesh(folder.write(file.name, file.bytes));
    ASSERT_TRUE(read) << text_of(read.errors());
    EXPECT_EQ(read->vertex.size(), mesh.vertex.size()) << "repeats of one position are joined";
    EXPECT_EQ(read->triangle.size(), mesh.triangle.size());
    EXPECT_NEAR(read->unit_in_metres, file.said_unit, 1e-7);
    const double scale = file.scale;
    EXPECT_NEAR(importers::signed_volume(read->vertex, read->triangle, {}), volume * std::pow(scale, 3), 1e-5 * volume);
    const importers::BoundingBox box = importers::bounding_box({read->vertex, read->triangle}),
                                 wanted = importers::bounding_box({mesh.vertex, mesh.triangle});
    EXPECT_LT(norm(box.least - scale * wanted.least), kFloat);
    EXPECT_LT(norm(box.most - scale * wanted.most), kFloat);
  }
}

TEST(ReadMesh, JoinsPartsOrTakesOneByName) {
  const zoo::Folder folder;
  const importers::RawMesh liver = zoo::sphere(1, 1), stone = zoo::sphere(0.1, 0, {3, 0, 0});
  std::string text = zoo::to_obj_text(liver, "liver") + "o stone\n";
  for (const Vec3& p : stone.vertex)
    text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
  for (const importers::Triangle& t : stone.triangle) {
    text += "f";
    for (const std::int32_t v : t) text += " " + std::to_string(v + 1 + std::int32_t(liver.vertex.size()));
    text += "\n";
  }
  const std::string path = folder.write("two.obj", text);
  const Result<importers::RawMesh> all = importers::read_mesh(path);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->parts, (std::vector<std::string>{"liver", "stone"}));
  EXPECT_EQ(all->triangle.size(), liver.triangle.size() + stone.triangle.size());
  importers::ReadOptions options;
  options.part = "stone";
  const Result<importers::RawMesh> one = importers::read_mesh(path, options);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->triangle.size(), stone.triangle.size());
  EXPECT_GT(importers::bounding_box({one->vertex, one->triangle}).least.x, 2.8);
  options.part = "spleen";
  const Result<importers::RawMesh> none = importers::read_mesh(path, options);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.errors()[0].where, path);
  EXPECT_EQ(none.errors()[0].message, "no mesh named \"spleen\"");
  EXPECT_EQ(none.errors()[0].hint, "the file holds \"liver\", \"stone\"");
}

TEST(ReadMesh, CutsPolygonsIntoTriangles) {
  const zoo::Folder folder;
  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const Result<importers::RawMesh> read = importers::read_mesh(folder.write("cube.obj", cube));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->triangle.size(), 12u);
  EXPECT_NEAR(importers::signed_volume(read->vertex, read->triangle, {}), 1, kFloat);
}

/// A file that must be refused, and words that the message must hold.
struct Bad {
  const char* name;
  std::string bytes;
  const char* message;
};

TEST(ReadMesh, RefusesWhatIsNoMeshAndSaysWhy) {
  const zoo::Folder folder;
  std::string nan = zoo::to_binary_stl(zoo::sphere(1, 1));
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  nan.replace(84 + 12, 4, reinterpret_cast<const char*>(&not_a_number), 4);
  for (const Bad& bad : std::vector<Bad>{{"empty.obj", "", "is empty"},
                                         {"noise.obj", "hello, I am a letter to a surgeon\n", "no triangles"},
                                         {"noise.stl", std::string(300, '\xEE'), "not a mesh that can be read"},
                                         {"noise.glb", "glTF but not really", "not a mesh that can be read"},
                                         {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n", "no triangles"},
                                         {"organ.docx", "word", "not a mesh that can be read"},
                                         {"organ", "v 0 0 0\n", "not a mesh that can be read"},
                                         {"nan.stl", nan, "corners whose coordinates are not finite"}}) {
    SCOPED_TRACE(bad.name);
    const std::string path = folder.write(bad.name, bad.bytes);
    const Result<importers::RawMesh> read = importers::read_mesh(path);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.errors()[0].where, path);
    EXPECT_NE(read.errors()[0].message.find(bad.message), std::string::npos) << text_of(read.errors());
    EXPECT_NE(read.errors()[0].hint, "");
  }
}

TEST(ReadMesh, RefusesNanTextVertices) {
  const zoo::Folder folder;
  const std::string path = folder.write("nan.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
  const Result<importers::RawMesh> read = importers::read_mesh(path);
  ASSERT_FALSE(read) << "a vertex that is not a number became " << read->vertex[2].x;
  EXPECT_EQ(read.errors()[0].message, "1 triangle of 2 has corners whose coordinates are not finite numbers");
}

TEST(ReadMesh, RefusesWhatIsNoFile) {
  const zoo::Folder folder;
  const auto message = [](const std::string& path) {
    const Result<importers::RawMesh> read = importers::read_mesh(path);
    return read ? std::string("read") : read.errors()[0].message;
  };
  EXPECT_EQ(message(folder.path() + "/none.obj"), "no such file");
  EXPECT_EQ(message(folder.path()), "is a folder, not a mesh file");
  const std::string fifo = folder.path() + "/pipe.obj";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(message(fifo), "is not a regular file") << "and it must not wait for a writer";
}

TEST(ReadMesh, TimeAndMemoryAreLimited) {
  const zoo::Folder folder;
  const std::string path = folder.write("large.stl", zoo::to_binary_stl(zoo::sphere(1, 7)));
  importers::ReadOptions options;
  options.time_limit_s = 0.01;
  const Result<importers::RawMesh> late = importers::read_mesh(path, options);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.errors()[0].message, "the reader took longer than 0.01 s");
  EXPECT_EQ(late.errors()[0].where, path);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  options.time_limit_s = 60;
  options.memory_limit_mib = 12;
  const Result<importers::RawMesh> hungry = importers::read_mesh(path, options);
  ASSERT_FALSE(hungry);
  EXPECT_EQ(hungry.errors()[0].message, "the reader needs more than 12 MiB of memory");
#endif
}

TEST(Unit, GivenBeatsFileBeatsGuess) {
  importers::RawMesh mesh = zoo::box({100, 100, 100});
  const importers::UsualSize usual{0.05, 0.5};
  importers::UnitChoice choice = importers::choose_unit(mesh, {}, usual);
  EXPECT_EQ(choice.source, importers::UnitSource::guessed);
  EXPECT_EQ(choice.in_metres, 0.001);
  EXPECT_TRUE(choice.is_usual_size);
  mesh.unit_in_metres = 0.01;
  choice = importers::choose_unit(mesh, {}, usual);
  EXPECT_EQ(choice.source, importers::UnitSource::file);
  EXPECT_EQ(choice.in_metres, 0.01);
  EXPECT_FALSE(choice.is_usual_size);
  choice = importers::choose_unit(mesh, 1.0, usual);
  EXPECT_EQ(choice.source, importers::UnitSource::given);
  EXPECT_EQ(choice.in_metres, 1.0);
}

TEST(Unit, EachIsGuessedFromAnOrganOfUsualSize) {
  const importers::UsualSize liver{0.15, 0.35};
  for (const double unit : {1.0, 0.01, 0.001}) {
    const double side = 0.25 / std::sqrt(3.0) / unit;  // 25 cm from corner to corner
    EXPECT_EQ(importers::choose_unit(zoo::box({side, side, side}), {}, liver).in_metres, unit);
  }
  // Inches and decimetres only where no other unit gives a usual size.
  const double side = 10.0 / std::sqrt(3.0);
  EXPECT_EQ(importers::choose_unit(zoo::box({side, side, side}), {}, {0.2, 0.3}).in_metres, 0.0254);
  const double small = 2.0 / std::sqrt(3.0);
  EXPECT_EQ(importers::choose_unit(zoo::box({small, small, small}), {}, {0.15, 0.3}).in_metres, 0.1);
  EXPECT_EQ(importers::unit_name(0.0254), "inch");
  EXPECT_EQ(importers::unit_name(0.001), "mm");
}

TEST(Unit, AMeshThatNoUnitMakesAnOrganIsScaled) {
  // A liver of 6 units is not one of 6 cm.
  const double side = 6 / std::sqrt(3.0);
  const importers::UsualSize liver{0.2, 0.3};
  const importers::UnitChoice choice = importers::choose_unit(zoo::box({side, side, side}), {}, liver);
  EXPECT_EQ(choice.source, importers::UnitSource::scaled);
  EXPECT_NEAR(6 * choice.in_metres, std::sqrt(0.2 * 0.3), 1e-12);
  EXPECT_TRUE(choice.is_usual_size);
}

TEST(Unit, AFilesUnitIsNotBelievedIfNoOrganIsThatLarge) {
  importers::RawMesh mesh = zoo::box({100, 100, 100});
  mesh.unit_in_metres = 1;  // 173 m across, as a format says that means metres whatever was drawn
  const importers::UnitChoice choice = importers::choose_unit(mesh, {}, {0.05, 0.5});
  EXPECT_EQ(choice.source, importers::UnitSource::guessed);
  EXPECT_EQ(choice.in_metres, 0.001);
}

TEST(Unit, LiverOfASegmentationIsInCentimetresAndItsFoldIsMended) {
  const std::string path = CTPM_SOURCE_DIR "/../shared/meshes/liver-smooth.obj";
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) GTEST_SKIP() << "no such mesh here";
  const Result<importers::RawMesh> read = importers::read_mesh(path);
  ASSERT_TRUE(read) << text_of(read.errors());
  const importers::UnitChoice choice = importers::choose_unit(*read, {}, {0.08, 0.40});
  EXPECT_EQ(choice.in_metres, 0.01);
  EXPECT_TRUE(choice.is_usual_size);
  const Result<importers::CheckedMesh> mesh = importers::repair_mesh(*read, choice.in_metres);
  ASSERT_TRUE(mesh) << text_of(mesh.errors());
  const importers::Finding* crossing = zoo::find(mesh->findings, "self_intersection");
  ASSERT_NE(crossing, nullptr) << zoo::summary(mesh->findings);
  EXPECT_EQ(crossing->count, 8);
  EXPECT_EQ(crossing->remains, "");
}

TEST(Read, AFormatWithoutColoursSaysNone) {
  const zoo::Folder folder;
  for (const auto& [name, bytes] :
       {std::pair{"a.off", zoo::to_off(sample())}, {"a.stl", zoo::to_binary_stl(sample())}}) {
    const Result<importers::RawMesh> mesh = importers::read_mesh(folder.write(name, bytes));
    ASSERT_TRUE(mesh) << text_of(mesh.errors());
    for (const std::optional<Vec3>& colour : mesh->part_colour) EXPECT_FALSE(colour) << name;
  }
}

TEST(Read, ADicomFileIsRefusedWithTheWayOut) {
  const zoo::Folder folder;
  const Result<importers::RawMesh> mesh =
      importers::read_mesh(folder.write("IM0001", std::string(128, '\0') + "DICM" + std::string(500, '\x02')));
  ASSERT_FALSE(mesh);
  EXPECT_NE(zoo::text_of(mesh.errors()).find("is a DICOM file, which is not read (save the segmentation as NRRD"),
            std::string::npos)
      << zoo::text_of(mesh.errors());
}

}  // namespace
}  // namespace ctpm
