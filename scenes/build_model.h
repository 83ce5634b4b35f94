#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/result.h"
#include "core/stepping/integrator.h"
#include "scenes/problems.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// A Model, and where the scene's anchors and probes lie in it.
struct BuiltScene {
  Model model;
  std::vector<std::int32_t> anchored_count;  ///< spheres that each organ's anchors hold         (organ_count)
  std::vector<std::int32_t> probe_sphere;    ///< sphere of each probe                            (probe_count)
  stepping::IntegratorChoice integrator;     ///< of the Model, and why
};

/// The closed mesh of an obstacle; empty for one of another kind.
struct ObstacleMesh {
  std::vector<Vec3> vertex;                           ///< [m]                                     (vertex_count)
  std::vector<std::array<std::int32_t, 3>> triangle;  ///< counter-clockwise seen from outside   (triangle_count)
};

/// The spheres of an organ that is given as a rig instead of by a mesh. It has no surface to draw.
FilledOrgan fill_rig(const OrganSpec& organ);

/// OrganSettings::inversion_resistance of an organ: its own, or else 10 with a mesh and 0 as a rig.
double inversion_resistance_of(const OrganSpec& organ);

/// Builds the Model. `organs` are the filled organs in the scene's order, `meshes` those of its obstacles, none if no
/// obstacle is a mesh. Errors, each with the JSON pointer of its
/// cause: an anchor that holds no sphere; a layer deeper than the organ or without spheres; moduli out of range;
/// spheres of which no two are neighbours; an integrator that is unstable for the scene.
Result<BuiltScene> build_model(const SceneSpec& scene, std::span<const FilledOrgan> organs,
                               std::span<const ObstacleMesh> meshes = {});

/// As above for a scene that may have refused values: adds its errors to `problems`, and builds nothing if there are
/// any. An organ that could not be filled has no spheres here; nothing in it is judged. FORMAT.md says what else
/// cannot be judged.
std::optional<BuiltScene> build_model(const SceneSpec& scene, std::span<const FilledOrgan> organs, Problems& problems,
                                      std::span<const ObstacleMesh> meshes = {});

/// True if no value is refused that decides which spheres fill organ `index` of the scene.
bool can_be_filled(const Problems& problems, std::size_t index);

/// The sphere nearest to `point` [m] at rest; the first of several.
std::int32_t nearest_sphere(const Model& model, Vec3 point);

}  // namespace ctpm::scenes
