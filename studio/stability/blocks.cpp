#include "studio/stability/blocks.h"

#include <algorithm>
#include <cmath>

#include "scenes/build_model.h"

namespace ctpm::stability {

scenes::SceneSpec block(double nx, double ny, double nz) {
  scenes::SceneSpec scene;
  scene.name = "block", scene.gravity = {};
  scenes::OrganSpec organ;
  organ.name = "block", organ.material.preset = "liver";
  organ.rig.emplace().block = Vec3{nx, ny, nz};
  organ.anchors.resize(1), organ.anchors[0].lowest = 0;
  scene.organs.push_back(organ);
  scenes::ToolSpec ball{"ball", ToolKind::ball, kBallRadius, {}, {}},
      scalpel{"scalpel", ToolKind::scalpel, {}, 0.4, {}};
  scene.tools = {ball, scalpel};
  return scene;
}

Model build(const scenes::SceneSpec& scene) {
  std::vector<FilledOrgan> organs;
  for (const scenes::OrganSpec& organ : scene.organs) organs.push_back(scenes::fill_rig(organ));
  Result<scenes::BuiltScene> built = scenes::build_model(scene, organs);
  CTPM_CHECK(bool(built), "the scenes of the stability cases are valid");
  return std::move(built->model);
}

Inputs ball_at(Vec3 place) {
  Inputs inputs;
  inputs.tool = kBall, inputs.position = place;
  return inputs;
}

Vec3 touch(double nz) { return {0, 0, kSpacing * (nz - 1) + 0.5 * kSpacing + kBallRadius}; }

std::function<Inputs(std::int64_t)> press(Vec3 from, double depth, std::int64_t stretch) {
  return [=](std::int64_t tick) {
    if (tick >= 3 * stretch) return Inputs{};
    const double in = double(tick + 1) / double(stretch), out = double(tick + 1 - 2 * stretch) / double(stretch);
    const double share = tick < stretch ? in : tick < 2 * stretch ? 1.0 : 1 - out;
    return ball_at(from - Vec3{0, 0, depth * share});
  };
}

StabilityCase pressed(const std::string& key, const std::string& title, const scenes::SceneSpec& scene,
                      double seconds) {
  StabilityCase what{.key = key, .title = title, .expectation = {}, .build = [=] { return build(scene); }};
  what.ticks = std::llround(seconds / scene.tick);
  const std::int64_t stretch = std::max<std::int64_t>(1, what.ticks / 20);
  what.hand = press(touch(scene.organs[0].rig->block->z), 6e-3, stretch);
  what.free_from = 3 * stretch;
  what.reach = 20e-3;
  what.expectation = "pressed 6 mm and let go: within 20 mm, no energy gained after that";
  return what;
}

}  // namespace ctpm::stability
