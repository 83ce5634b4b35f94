// Where the things of a scene are, and what is odd about it.

#include "studio/loading/oddities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "studio/loading/standing.h"

namespace ctpm {
namespace {

/// Two shipped kidneys, the second one moved along y by so much [mm], and `keys` of the scene.
Result<loading::LoadedScene> two_kidneys(double along, const std::string& keys = "") {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "ctpm_oddities";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(CTPM_SOURCE_DIR "/scenes/organs/kidney.obj", folder / "kidney.obj",
                             std::filesystem::copy_options::overwrite_existing);
  const auto organ = [](const std::string& name, double at) {
    return R"({"name": ")" + name +
           R"(", "mesh": "kidney.obj", "fill": {"radius_mm": 4}, "material": {"preset": "kidney"}, "at_mm": [0, )" +
           std::to_string(at) + R"(, 0], "anchors": [{"lowest_mm": 8}]})";
  };
  std::ofstream(folder / "scene.json") << R"({"format": "ctpm-scene", "version": 1, "name": "s", "organs": [)"
                                       << organ("left", 0) << ",\n"
                                       << organ("right", along) << "]" << keys << "}";
  return loading::load_whole_scene((folder / "scene.json").string());
}

TEST(Oddities, AnOrganInAnotherOneIsOneAndOneBesideItIsNot) {
  const auto beside = two_kidneys(200), in = two_kidneys(20);
  ASSERT_TRUE(beside && in);
  EXPECT_TRUE(loading::find_odd_places(*beside).empty());
  const Errors odd = loading::find_odd_places(*in);
  ASSERT_EQ(odd.size(), 1u);
  // Of the two it is the one that has more of its spheres in the other.
  EXPECT_NE(odd[0].where.find("scene.json:1:64"), std::string::npos) << odd[0].where << " is not the first organ";
  EXPECT_NE(odd[0].message.find("/organs/0: lies in right with "), std::string::npos) << odd[0].message;
}

TEST(Oddities, AnOrganThatFallsFarOntoItsTableIsOneAndOneThatLiesOnItIsNot) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "ctpm_on_table";
  std::filesystem::create_directories(folder / "organs");
  std::filesystem::copy_file(CTPM_SOURCE_DIR "/scenes/organs/kidney.obj", folder / "organs/kidney.obj",
                             std::filesystem::copy_options::overwrite_existing);
  std::stringstream text;
  text << std::ifstream(CTPM_SOURCE_DIR "/scenes/kidney-on-table.json").rdbuf();
  const std::string above = R"("point_mm": [0, 0, 0])";
  ASSERT_NE(text.str().find(above), std::string::npos);
  for (const char* point : {"[0, 0, 0]", "[0, 0, -150]"}) {
    std::string scene = text.str();
    scene.replace(scene.find(above), above.size(), std::string(R"("point_mm": )") + point);
    std::ofstream(folder / "scene.json") << scene;
    const auto loaded = loading::load_whole_scene((folder / "scene.json").string());
    ASSERT_TRUE(loaded) << to_string(loaded.errors().front());
    const std::optional<Errors> odd = loading::find_oddities(*loaded);
    ASSERT_TRUE(odd);
    // A page learns it from the State that it has settled anyway.
    const Errors unsteady =
        loading::find_unsteady(*loaded, loading::settle_scene(loaded->scene.spec, loaded->built.model)->state);
    EXPECT_EQ(unsteady.size(), odd->size());
    const auto falls = std::count_if(odd->begin(), odd->end(), [](const Error& error) {
      return error.message.find("/organs/0: nothing holds the organ where it is") != std::string::npos;
    });
    EXPECT_EQ(falls, point == std::string("[0, 0, 0]") ? 0 : 1) << point;
  }
}

TEST(Oddities, AnOrganTooThinForItsSpheresIsOneWithTheRadiusThatWouldDo) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "ctpm_thin";
  std::filesystem::create_directories(folder);
  std::ofstream plate(folder / "plate.obj");
  for (const char* corner : {"0 0 0", "90 0 0", "90 90 0", "0 90 0", "0 0 4", "90 0 4", "90 90 4", "0 90 4"})
    plate << "v " << corner << "\n";
  for (const char* quad : {"4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"})
    plate << "f " << quad << "\n";
  plate.close();
  std::ofstream(folder / "scene.json") << R"({"format": "ctpm-scene", "version": 1, "name": "s", "organs": [
    {"name": "plate", "mesh": "plate.obj", "mesh_unit": "mm", "fill": {"radius_mm": 4, "gap_mm": 4},
     "material": {"preset": "skin"}, "anchors": [{"lowest_mm": 1}]}]})";
  const auto scene = loading::load_whole_scene((folder / "scene.json").string());
  ASSERT_TRUE(scene);
  const Errors odd = loading::find_odd_places(*scene);
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_NE(odd[0].message.find("/organs/0/fill: "), std::string::npos) << odd[0].message;
  EXPECT_NE(odd[0].message.find("100 % of its vertices"), std::string::npos) << odd[0].message;
  EXPECT_NE(odd[0].hint.find("spheres of radius 0.67 mm, 2 mm apart"), std::string::npos) << odd[0].hint;
}

TEST(Oddities, OrgansMayTouch) {
  // Their surfaces overlap by half a millimetre.
  const auto alone = two_kidneys(1000);
  ASSERT_TRUE(alone);
  double least = INFINITY, most = -INFINITY;
  for (const Vec3& p : alone->organs[0].surface.vertex) least = std::min(least, p.y), most = std::max(most, p.y);
  const auto touching = two_kidneys(1e3 * (most - least) - 0.5);
  ASSERT_TRUE(touching);
  EXPECT_TRUE(loading::find_odd_places(*touching).empty());
}

TEST(Oddities, OfPlacesAreFoundWithoutSettling) {
  const auto far = two_kidneys(200, R"(, "probes": [{"name": "far", "at_mm": [0, 0, 900]}])");
  ASSERT_TRUE(far);
  const Errors odd = loading::find_odd_places(*far);
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_NE(odd[0].message.find("from the nearest tissue"), std::string::npos);
}

}  // namespace
}  // namespace ctpm
