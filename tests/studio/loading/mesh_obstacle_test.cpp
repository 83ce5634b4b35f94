// A scene's obstacle is a mesh file.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "studio/loading/loaded_scene.h"

namespace ctpm {
namespace {

const std::string kOrgan = std::string(CTPM_SOURCE_DIR) + "/scenes/organs/kidney.obj";

/// A scene with a kidney on `obstacle`, in a folder of its own, beside `tray.obj` with `tray`.
std::string scene_on(const std::string& obstacle, const std::string& tray) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "ctpm_mesh_obstacle";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(kOrgan, folder / "kidney.obj", std::filesystem::copy_options::overwrite_existing);
  std::ofstream(folder / "tray.obj") << tray;
  std::ofstream(folder / "scene.json") << R"({"format": "ctpm-scene", "version": 1, "name": "s",
"organs": [{"name": "kidney", "mesh": "kidney.obj", "fill": {"radius_mm": 6}, "material": {"preset": "kidney"}}],
"obstacles": [
)" << obstacle << "]}";
  return (folder / "scene.json").string();
}

/// A flat box from z = -2 to 0, of six quads.
const std::string kTray =
    "v -20 -10 -2\nv 20 -10 -2\nv 20 10 -2\nv -20 10 -2\nv -20 -10 0\nv 20 -10 0\nv 20 10 0\nv -20 10 0\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST(MeshObstacleOfAScene, IsReadInItsUnitAndClosed) {
  const auto loaded =
      loading::load_whole_scene(scene_on(R"({"name": "tray", "mesh": "tray.obj", "mesh_unit": "cm"})", kTray));
  ASSERT_TRUE(loaded) << to_string(loaded.errors().front());
  ASSERT_EQ(loaded->built.model.obstacles.size(), 1u);
  const Obstacle& tray = loaded->built.model.obstacles.front();
  EXPECT_EQ(tray.kind, ObstacleKind::mesh);
  EXPECT_EQ(tray.name, "tray");
  EXPECT_EQ(tray.vertex.size(), 8u);
  EXPECT_EQ(tray.corner.size(), 36u);
  double volume = 0;
  for (std::size_t i = 0; i < tray.corner.size(); i += 3) {
    const auto at = [&](std::size_t c) { return tray.vertex[std::size_t(tray.corner[i + c])]; };
    volume += dot(at(0), cross(at(1), at(2))) / 6;
  }
  EXPECT_NEAR(volume, 0.4 * 0.2 * 0.02, 1e-12) << "outwards, in metres";
  // Built again, it is still there.
  const auto again = loading::build_changed(*loaded, [](scenes::SceneSpec& spec) { spec.contact_friction = 0; });
  ASSERT_TRUE(again);
  EXPECT_EQ(again->model.obstacles.size(), 1u);
}

TEST(MeshObstacleOfAScene, IsRefusedAtItsPlace) {
  const auto errors_of = [](const std::string& obstacle, const std::string& tray) {
    std::string all;
    const auto loaded = loading::load_whole_scene(scene_on(obstacle, tray));
    if (!loaded)
      for (const Error& error : loaded.errors()) all += to_string(error) + "\n";
    return all;
  };
  const auto has = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << all;
  };
  has(errors_of(R"({"name": "tray", "mesh": "bowl.obj"})", kTray),
      "scene.json:4:26: error: /obstacles/0/mesh: there is no file");
  has(errors_of(R"({"name": "tray", "mesh": "../tray.obj"})", kTray), "leaves the scene's folder");
  has(errors_of(R"({"name": "tray", "mesh": "tray.obj"})", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
      "scene.json:4:26: error: /obstacles/0/mesh: ");
  has(errors_of(R"({"name": "tray", "mesh": "tray.obj", "box": {"min_mm": [0, 0, 0], "max_mm": [1, 1, 1]}})", kTray),
      "/obstacles/0: must have exactly one of plane, box, mesh");
}

}  // namespace
}  // namespace ctpm
