#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/model.h"
#include "core/organ.h"
#include "studio/render/camera.h"

namespace ctpm {

/// An sRGB colour, each part in [0, 1].
using Colour = std::array<double, 3>;

/// How one organ looks.
struct OrganLook {
  std::string name;                ///< of the organ
  Colour outer{0.50, 0.17, 0.13};  ///< of its surface
  Colour inner{0.46, 0.06, 0.06};  ///< of its inside, seen where it is cut
  double wetness = 1;              ///< strength of the wet film's mirror, in [0, 1]
};

/// The look of a known tissue (liver, kidney, skin), found in the organ's name; a plain red one for others.
OrganLook look_of(std::string_view organ_name);

/// What is drawn: a Model, and one surface and look for each of its organs.
struct SceneView {
  const Model* model = nullptr;   ///< must outlive the Renderer
  std::vector<Surface> surfaces;  ///< bound to the spheres of their organ    (organ_count)
  std::vector<OrganLook> looks;   ///< empty: look_of() each organ's name     (organ_count)
};

/// The box around everything at rest [m].
Bounds rest_bounds(const SceneView& scene);

/// Up in the scene: against gravity, +z without gravity.
Vec3 up_of(const Model& model);

/// A camera in front of the scene, a little above it and to the right, with everything in sight.
Camera default_camera(const SceneView& scene, double aspect = 16.0 / 9);

enum class View {
  surface,  ///< the organs' surfaces, as tissue
  spheres,  ///< the spheres, coloured by layer
  both,     ///< the spheres through a glassy surface
};

struct DrawOptions {
  Camera camera;
  View view = View::surface;
  bool show_tool = true;    ///< at the pose of State::last_inputs
  bool show_ground = true;  ///< a soft shadow below the scene
};

/// Colour of a layer, 1 = outermost, of an organ with `layer_count` layers.
Colour layer_colour(int layer, int layer_count);

}  // namespace ctpm
