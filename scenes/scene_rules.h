#pragma once

#include <string>

#include "scenes/problems.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// Checks the rules between the values of a scene: those of FORMAT.md that need neither files nor filled organs. A rule
/// that uses a refused value is not checked. Internal to scenes.
void check_rules(Problems& problems, const SceneSpec& scene);

/// Checks the rules of one material at the pointer `at`: its preset, that no value is missing, its constraint modulus
/// where the structure is ctpm. Internal to scenes.
void check_material(Problems& problems, const std::string& at, const MaterialSpec& spec,
                    network::Structure structure = network::Structure::ctpm);

}  // namespace ctpm::scenes
