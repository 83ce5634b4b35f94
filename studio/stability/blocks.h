#pragma once

#include "scenes/scene_spec.h"
#include "studio/stability/stability.h"

/// Parts of the stability cases: blocks of liver, and a ball that presses them.
namespace ctpm::stability {

constexpr double kGravity = 9.81;      ///< [m/s^2]
constexpr double kSpacing = 12e-3;     ///< of every block [m]
constexpr double kBallRadius = 10e-3;  ///< [m]
constexpr std::int32_t kBall = 0, kScalpel = 1;

/// A block of nx x ny x nz spheres with the moduli of the paper's liver, its lowest spheres anchored, without
/// gravity.
scenes::SceneSpec block(double nx, double ny, double nz);

/// The Model of a scene of rigs. The scene must be valid.
Model build(const scenes::SceneSpec& scene);

Inputs ball_at(Vec3 place);

/// Centre of the ball [m] when it touches the middle of a block that is `nz` spheres high.
Vec3 touch(double nz);

/// The ball starts at `from` [m], presses a block `depth` [m] deep, holds, and leaves, each within `stretch` ticks.
/// Then no tool is held.
std::function<Inputs(std::int64_t)> press(Vec3 from, double depth, std::int64_t stretch);

/// A block that is pressed 6 mm deep, released, and recovers as far as its tissue allows.
StabilityCase pressed(const std::string& key, const std::string& title, const scenes::SceneSpec& scene, double seconds);

}  // namespace ctpm::stability
