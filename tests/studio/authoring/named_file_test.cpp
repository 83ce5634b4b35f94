// What a file and its meshes are called says which tissue they are.

#include "studio/authoring/named_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "zoo.h"

namespace ctpm {
namespace {

authoring::NamedFile read(const std::string& file, const std::string& mesh, const std::string& organ = "") {
  std::string folder = ::testing::TempDir() + "ctpm-named-file-XXXXXX";
  EXPECT_NE(mkdtemp(folder.data()), nullptr);
  authoring::ImportRequest request;
  request.mesh = folder + "/" + file, request.organ = organ;
  // Its box measures 35 units from corner to corner: 35 mm or 35 cm.
  std::ofstream(request.mesh) << zoo::to_obj_text(zoo::sphere(10.1, 2), mesh);
  Result<authoring::NamedFile> named = authoring::repair_named(request, folder, {});
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(named) << (named ? "" : named.errors().front().message);
  return named ? *std::move(named) : authoring::NamedFile{};
}

TEST(NamedFile, TheOnlyMeshNamesTheTissueWhereTheFileDoesNot) {
  EXPECT_STREQ(read("scan-17.obj", "Spleen.001").tissue.preset->name, "spleen");
  EXPECT_STREQ(read("kidney.obj", "Spleen.001").tissue.preset->name, "kidney");
  EXPECT_STREQ(read("scan-17.obj", "Spleen.001", "heart").tissue.preset->name, "heart");
  EXPECT_TRUE(read("scan-17.obj", "Object").tissue.is_assumed);
  EXPECT_FALSE(read("scan-17.obj", "Spleen.001").tissue.is_assumed);
}

TEST(NamedFile, AUnitIsGuessedByTheSizeOfTheNamedTissue) {
  EXPECT_EQ(read("scan-17.obj", "Object").file.report.unit.in_metres, 1e-3);
  EXPECT_EQ(read("scan-17.obj", "skin").file.report.unit.in_metres, 1e-2) << "35 mm would be little for skin";
}

}  // namespace
}  // namespace ctpm
