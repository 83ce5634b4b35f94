#pragma once

#include <span>
#include <string>

#include "core/model/result.h"
#include "scenes/scene_spec.h"
#include "studio/render/scene_view.h"

namespace ctpm::views {

/// The user's request for a picture, as text; find_look() checks it.
struct LookRequest {
  std::string view = "surface";  ///< surface, spheres, both or elements
  std::string by;                ///< quantity of the colours: layer (spheres); stretch, tilt or force (elements)
  double full_scale =
      0;  ///< value of the last colour [%, deg or N as in the legend]; 0: in a film its own range, else the default
  std::string cutaway;  ///< axis of the cutting plane, alone or with a position [mm]: y=12.5; empty: no cutaway
  /// A camera of the scene, `fitted`, `wound`, `press` or `follow`, or two places in mm: `X,Y,Z:X,Y,Z` looks from the
  /// first at the second, a third triple points up, and a single number at the end is the vertical field of view in
  /// degrees (else 32). Empty: with a cutaway one that sees the section, else wound where something is cut, else press
  /// where something is pressed, else the scene's first, else fitted.
  std::string camera;
};

/// The draw options and the camera of one scene.
struct Look {
  render::DrawOptions draw;  ///< with the base camera
  bool follows = false;      ///< the camera follows the tool
  bool is_found = false;     ///< the camera stands where it sees best, not where somebody placed it
  std::string camera;        ///< its name: a camera of the scene, `fitted`, `section`, `wound`, `press` or `follow`
  std::vector<Vec3> pieces;  ///< where what was cut off lies beside its organ, if a camera was found for it [m]

  /// The options for one moment of the scene. `moments`: see following_camera().
  render::DrawOptions at(const render::SceneView& scene, std::span<const Inputs> moments) const;
};

/// The unit of a quantity in legends and requests, in SI: %, degrees, N.
double unit_of(render::ElementQuantity quantity);

/// Checks a request against a scene. `told`: a State that tells what a camera may look at, its wound or the press of
/// its last inputs; null: there is none. A camera that follows a tool there sees it from where it is seen best. Errors,
/// all at once: an unknown view, quantity or camera (the known ones are listed); a quantity that the view does not
/// have; a cutaway outside the organs; `wound` where nothing is cut, `press` where nothing is pressed.
Result<Look> find_look(const LookRequest& request, const scenes::SceneSpec& scene, const render::SceneView& view,
                       double aspect, const State* told = nullptr);

}  // namespace ctpm::views
