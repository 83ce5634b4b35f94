#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/result.h"
#include "core/stepping/integrator.h"
#include "scenes/scene_spec.h"

namespace ctpm {

/// A Model and what the scene's words became in it.
struct BuiltScene {
  Model model;
  std::vector<std::int32_t> anchored_count;  ///< spheres that each organ's anchors hold         (organ_count)
  std::vector<std::int32_t> probe_sphere;    ///< sphere of each probe                            (probe_count)
  IntegratorChoice integrator;               ///< of the Model, and why
};

/// The spheres of an organ that is given as a rig instead of by a mesh. It has no surface to draw.
FilledOrgan fill_rig(const OrganSpec& organ);

/// Builds the Model. `organs` are the filled organs in the order of the scene's. Errors,
/// each with the JSON pointer of its cause: an anchor that catches no sphere, a layer deeper than the organ
/// or without spheres, moduli out of range, spheres of which no two are neighbours.
Result<BuiltScene> build_model(const SceneSpec& scene, std::span<const FilledOrgan> organs);

/// The sphere nearest to `point` [m] at rest; the first of several.
std::int32_t nearest_sphere(const Model& model, Vec3 point);

}  // namespace ctpm
