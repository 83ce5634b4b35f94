#pragma once

#include <span>
#include <string>

#include "core/model/result.h"
#include "scenes/scene_spec.h"
#include "studio/render/scene_view.h"

namespace ctpm {

/// What a user asks pictures to show, as written: unchecked.
struct LookRequest {
  std::string view = "surface";  ///< surface, spheres, both or elements
  std::string by;                ///< what colours show: layer of spheres; stretch, tilt or force of elements
  double full_scale = 0;         ///< value of the last colour, in the legend's unit; 0: a usual one
  std::string cutaway;           ///< x, y or z, or that and a place: y=12.5 [mm]; empty: nothing is left out
  std::string camera;            ///< a camera of the scene, `fitted` or `follow`; empty: the scene's first, else fitted
};

/// What is drawn of one scene, and from where.
struct Look {
  DrawOptions draw;      ///< with the base camera
  bool follows = false;  ///< the camera follows the tool
  std::string camera;    ///< its name: of the scene, `fitted`, or `follow`

  /// The options for a moment of the scene; `moments` as following_camera() wants them.
  DrawOptions at(const SceneView& scene, std::span<const Inputs> moments) const;
};

/// Finds what the request names. Errors: an unknown view, colour or camera, with those there are; colours
/// that the view does not have; a cutaway that is none. All of them at once.
Result<Look> find_look(const LookRequest& request, const SceneSpec& scene, const SceneView& view, double aspect);

}  // namespace ctpm
