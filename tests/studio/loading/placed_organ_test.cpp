// Organs have a place, a turn and a scale in their scene.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "studio/loading/loaded_scene.h"

namespace ctpm {
namespace {

/// The shipped kidney in a scene of its own, with `keys`.
Result<loading::LoadedScene> kidney_with(const std::string& keys) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "ctpm_placed_organ";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(CTPM_SOURCE_DIR "/scenes/organs/kidney.obj", folder / "kidney.obj",
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(folder / "scene.json") << R"({"format": "ctpm-scene", "version": 1, "name": "s", "organs": [
{"name": "kidney", "mesh": "kidney.obj", "fill": {"radius_mm": 4}, "material": {"preset": "kidney"},
"anchors": [{"lowest_mm": 8}])" << keys << "}]}";
  return loading::load_whole_scene((folder / "scene.json").string());
}

struct Box {
  Vec3 least{INFINITY, INFINITY, INFINITY}, most{-INFINITY, -INFINITY, -INFINITY};
};
Box box_of(const loading::LoadedScene& scene) {
  Box box;
  for (const Vec3& p : scene.organs[0].surface.vertex) {
    box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y), std::min(box.least.z, p.z)};
    box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y), std::max(box.most.z, p.z)};
  }
  return box;
}

TEST(PlacedOrgan, IsScaledTurnedAndThenMoved) {
  const auto plain = kidney_with(""),
             placed = kidney_with(R"(, "scale": 1.5, "turn_deg": [0, 0, 90], "at_mm": [200, 0, 5])");
  ASSERT_TRUE(plain && placed);
  const Box was = box_of(*plain), is = box_of(*placed);
  // A quarter turn about z brings x to y, and y to -x.
  const Vec3 at{0.2, 0, 0.005};
  EXPECT_LT(norm(is.least - at - 1.5 * Vec3{-was.most.y, was.least.x, was.least.z}), 1e-9);
  EXPECT_LT(norm(is.most - at - 1.5 * Vec3{-was.least.y, was.most.x, was.most.z}), 1e-9);
  EXPECT_NEAR(placed->reports[0].mesh_volume, std::pow(1.5, 3) * plain->reports[0].mesh_volume, 1e-9);
  EXPECT_EQ(placed->organs[0].spacing, plain->organs[0].spacing) << "the spheres stay as large as they are";
  EXPECT_GT(placed->organs[0].centre.size(), 2 * plain->organs[0].centre.size());
  // What lies on the ground is held, whichever way the mesh lies: on its side more of it does.
  const auto on_side = kidney_with(R"(, "turn_deg": [90, 0, 0])");
  ASSERT_TRUE(on_side);
  EXPECT_NE(on_side->built.anchored_count[0], plain->built.anchored_count[0]);
  EXPECT_NEAR(box_of(*on_side).most.z - box_of(*on_side).least.z, was.most.y - was.least.y, 1e-9);
}

TEST(PlacedOrgan, IsRefusedOutOfRangeAndAsARig) {
  const auto says = [](const Errors& errors, const std::string& part) {
    return std::any_of(errors.begin(), errors.end(),
                       [&](const Error& error) { return to_string(error).find(part) != std::string::npos; });
  };
  const auto wrong = kidney_with(R"(, "scale": 0, "turn_deg": [0, 0, 400])");
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(says(wrong.errors(), "/organs/0/scale: got 0, must be in [0.001, 1000]"));
  EXPECT_TRUE(says(wrong.errors(), "/organs/0/turn_deg/2: got 400, must be in [-360, 360] deg"))
      << to_string(wrong.errors().front());
  const auto rig = scenes::read_scene(R"({"format": "ctpm-scene", "version": 1, "name": "s", "organs": [
{"name": "r", "rig": {"block": [2, 2, 2]}, "material": {"preset": "liver"}, "scale": 2, "turn_deg": [0, 0, 90]}]})",
                                      "s.json");
  ASSERT_FALSE(rig);
  EXPECT_TRUE(says(rig.errors(), "s.json:2:86: error: /organs/0/scale: only an organ from a mesh has this key"))
      << to_string(rig.errors().front());
  EXPECT_TRUE(says(rig.errors(), "/organs/0/turn_deg: only an organ from a mesh has this key"));
}

}  // namespace
}  // namespace ctpm
