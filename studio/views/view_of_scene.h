#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "scenes/scene_spec.h"
#include "studio/render/scene_view.h"

namespace ctpm::views {

/// The renderer's view of a scene: its surfaces in the organs' colours. `model` must outlive the view.
render::SceneView view_of(const scenes::SceneSpec& scene, const Model& model);

/// One of the tissues of an organ that is made of several, and of how many spheres.
struct TissueOfOrgan {
  std::string text;  ///< what it is, in the words of a legend
  std::string colour_name;
  render::Colour colour{};
  std::int64_t spheres = 0;
};

/// The tissues of an organ: its layers', outermost first, and then what lies below them.
struct OrganTissues {
  std::vector<TissueOfOrgan> tissue;
  std::vector<std::int32_t> of_sphere;  ///< index into `tissue`  (spheres of the organ)
};

/// The tissues of each organ, no two in a scene of one colour while there are colours. `organs` are those that the
/// Model was built of.
std::vector<OrganTissues> tissues_of(const scenes::SceneSpec& scene, std::span<const FilledOrgan> organs);

/// Colours a view's spheres by their tissue. Returns what each colour is, in the words of a legend.
std::vector<std::string> colour_by_material(const scenes::SceneSpec& scene, std::span<const FilledOrgan> organs,
                                            render::SceneView& view);

}  // namespace ctpm::views
