#pragma once

#include "scenes/problems.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// Checks the rules between the values of a scene: those of FORMAT.md that need neither files nor filled organs. A rule
/// that uses a refused value is not checked. Internal to scenes.
void check_rules(Problems& problems, const SceneSpec& scene);

}  // namespace ctpm::scenes
