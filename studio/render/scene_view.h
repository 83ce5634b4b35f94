#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/render/camera.h"

namespace ctpm::render {

/// An sRGB colour, each part in [0, 1].
using Colour = std::array<double, 3>;

/// How a layer of an organ's tissue looks where it is cut.
struct LayerLook {
  double to_depth = 0;  ///< it ends here, below the surface at rest [m]
  Colour colour{};
  friend bool operator==(const LayerLook&, const LayerLook&) = default;
};

/// Most layers that an organ's picture tells apart; the deeper ones look like the inside.
inline constexpr std::size_t kMostLayerLooks = 8;

/// How one organ looks.
struct OrganLook {
  std::string name;                ///< of the organ
  Colour outer{0.50, 0.17, 0.13};  ///< of its surface
  Colour inner{0.46, 0.06, 0.06};  ///< of its inside, visible where it is cut
  double wetness = 1;              ///< strength of specular reflection by a wet film, in [0, 1]
  double blood = 1;  ///< on fresh walls and around them, not on sections, in [0, 1]; a picture, no physics
  std::vector<LayerLook> layers{};  ///< outermost first; empty: the outermost spheres are a little paler
};

/// The look of the tissue (liver, kidney, skin) that the organ's name contains; plain red for others.
OrganLook look_of(std::string_view organ_name);

class CutSurface;
class ExpertCut;

/// The scene to draw: a Model, and one surface and look for each of its organs.
struct SceneView {
  const Model* model = nullptr;             ///< must outlive the Renderer
  std::vector<OrganLook> looks;             ///< empty: look_of() each organ's name     (organ_count)
  std::vector<Colour> sphere_colours = {};  ///< of each sphere; empty: layer_colour()  (sphere_count)
  /// The surfaces with their cuts, which a Renderer makes if there are none. Renderers that are given another's
  /// scene() follow a cut once for all of them; one thread at a time may use these.
  std::shared_ptr<std::vector<CutSurface>> cuts = nullptr;
};

/// The vertices of all surfaces at rest [m].
std::vector<Vec3> rest_points(const SceneView& scene);

/// The box around everything at rest [m].
Bounds rest_bounds(const SceneView& scene);

/// Up in the scene: against gravity, +z without gravity.
Vec3 up_of(const Model& model);

/// A camera that looks along `direction` and frames all organs at rest.
Camera fitted_camera(const SceneView& scene, Vec3 direction, Vec3 up, double fov_deg, double aspect);

/// A camera on the section of the organs at rest by the plane through `place` across `normal`. It frames their outline
/// as seen along `normal`, so it only moves along with the plane, and a film of it does not shake.
Camera section_camera(const SceneView& scene, Vec3 place, Vec3 normal, Vec3 direction, Vec3 up, double fov_deg,
                      double aspect);

/// A camera in front of the scene, a little above it and to the right, that frames everything.
Camera default_camera(const SceneView& scene, double aspect = 16.0 / 9);

/// Number of moments that a following camera averages, 0.01 s apart: it lags by half of 0.8 s.
inline constexpr std::size_t kFollowedMoments = 80;

/// Ticks before a moment that a following camera looks back at, at most. `tick`: its length [s].
std::size_t followed_ticks(double tick);

/// Of the inputs of the `count` last ticks, 0 the oldest, those of the moments that a following camera averages, oldest
/// first.
std::vector<Inputs> followed_moments(std::size_t count, double tick,
                                     const std::function<const Inputs&(std::size_t)>& inputs);

/// A camera that comes closer as a held tool nears the organs, and looks at the point where it works; with two, at one
/// between them, nearer to the one that is nearer to the organs. `moments` are
/// the inputs of the last moments, oldest first; fewer at a session's beginning. The average makes the camera's motion
/// smooth. The camera depends on nothing else, so a video that starts later shows the same pictures. Without a tool:
/// `base` itself.
Camera following_camera(const SceneView& scene, const Camera& base, std::span<const Inputs> moments);

enum class View {
  surface,   ///< the organs' surfaces, as tissue
  spheres,   ///< the spheres, coloured by layer
  both,      ///< the spheres through a transparent surface
  elements,  ///< the elements, coloured by an ElementQuantity
};

/// The quantity that an element's colour shows.
enum class ElementQuantity {
  stretch,  ///< (length - rest length) / rest length of axial elements
  tilt,     ///< theta of the five-sphere lines [rad]
  force,    ///< magnitude of the force of axial elements, softened (Eq. 8) [N]
};

/// Hides everything on one side of a plane, to show the inside.
struct Cutaway {
  Vec3 point;            ///< on the plane [m]
  Vec3 normal{0, 0, 0};  ///< towards the hidden side, unit length; zero: nothing is hidden

  bool is_on() const { return dot(normal, normal) > 0; }
  bool leaves_out(Vec3 p) const { return is_on() && dot(p - point, normal) > 0; }
};

struct DrawOptions {
  Camera camera;
  View view = View::surface;
  ElementQuantity quantity = ElementQuantity::stretch;
  double full_scale = 0;  ///< value of the last colour [1, rad or N]; 0: default_full_scale()
  Cutaway cutaway;
  bool show_tool = true;           ///< those of both hands, at the poses of State::last_inputs
  bool show_ground = true;         ///< a soft shadow below the scene
  std::optional<Hand> ghost = {};  ///< a tool of another session: it is seen through, and casts nothing
  std::shared_ptr<const ExpertCut> expert =
      nullptr;  ///< its line is on the organs, and what is cut elsewhere is marked
};

/// Full scale of the colours: 20 % stretch, 0.5 rad tilt, 0.05 N force.
double default_full_scale(ElementQuantity quantity);

/// Colour of a value in units of full scale: from blue (-1) over grey to red (1) for stretch, else over [0, 1].
Colour quantity_colour(ElementQuantity quantity, double value);

/// The legend of a view's colours.
struct Legend {
  std::string title;            ///< with its unit; empty: the view needs no legend
  std::string low, high;        ///< values of the first and the last colour
  std::vector<Colour> colours;  ///< in equal steps
  bool is_stepped = false;      ///< each colour stands for one value, not for a range
};

/// The legend of the view that the options ask for.
Legend legend_of(const Model& model, const DrawOptions& options);

/// Of spheres from which a blade has severed an element, whatever their layer.
inline constexpr Colour kCutColour{0.80, 0.03, 0.06};

/// Which spheres those are (sphere_count); empty: nothing is severed.
std::vector<std::uint8_t> spheres_at_cuts(const Model& model, const State& state);

/// Colour of a layer, 1 = outermost, of an organ with `layer_count` layers.
Colour layer_colour(int layer, int layer_count);

}  // namespace ctpm::render
