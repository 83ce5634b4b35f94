#pragma once

#include <optional>
#include <string>

#include "core/model/result.h"
#include "scenes/scene_spec.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::calibrate {

/// The specimen as a block of spheres on a plate that holds it, pressed on the middle of its top. `size`: along x, y
/// and z, its thickness [mm]; spheres as those of the material's preset, or of `sphere_radius` [mm] with gaps as wide.
/// `scenes`: the folder of the shipped scenes. Errors: fewer than 5 x 5 x 3 spheres; too many to be fitted.
Result<loading::LoadedScene> make_block(const std::string& scenes, const scenes::MaterialSpec& material, Vec3 size,
                                        std::optional<double> sphere_radius);

}  // namespace ctpm::calibrate
