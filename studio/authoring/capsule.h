#pragma once

#include <optional>

#include "core/model/organ.h"
#include "scenes/scene_spec.h"

namespace ctpm::authoring {

/// The outermost spacing of an organ under the tension that it has in the body (MaterialPreset::InSitu), so that cuts
/// gape. A capsule holds an inner pressure p with the tension p R / 2 per length, as a sphere of the organ's volume
/// would (Laplace), which relaxed tissue of depth d, modulus E and Poisson ratio 1/4 has at the strain p R (1 - 1/4) /
/// (2 E d). Not set if nothing is known of the organ's preset, or if the outermost spacing holds no spheres or all of
/// them.
std::optional<scenes::LayerSpec> capsule_of(const scenes::MaterialSpec& material, const FilledOrgan& filled);

}  // namespace ctpm::authoring
