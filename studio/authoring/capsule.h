#pragma once

#include <optional>

#include "core/model/organ.h"
#include "scenes/scene_spec.h"

namespace ctpm::authoring {

/// What an organ is under in the body.
struct Tension {
  scenes::LayerSpec capsule;  ///< the outermost spacing, under tension
  double inside = 0;          ///< prestrain of the tissue below, which the capsule presses: negative
  double strain = 0;          ///< of the capsule against what is below it
};

/// The tension of an organ's capsule (MaterialPreset::InSitu), with which cuts gape. A capsule holds an inner pressure
/// p with the tension p R / 2 per length (Laplace; R: radius of the sphere of the organ's volume). Relaxed tissue of
/// depth d, modulus E and Poisson ratio 1/4 has this tension at the strain p R (1 - 1/4) / (2 E d). A mesh has the
/// shape that the organ has under tension. The mean strain of a body without loads is none, so the tissue inside is
/// pressed as much as the capsule is stretched. Not set if nothing is known of the material's preset, or if the
/// outermost spacing holds no spheres or all of them.
std::optional<Tension> tension_of(const scenes::MaterialSpec& material, const FilledOrgan& filled);

}  // namespace ctpm::authoring
