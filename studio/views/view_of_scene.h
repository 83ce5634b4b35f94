#pragma once

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

/// Colours a view's spheres by their material: each organ's layers, and the tissue below them, have one of their own.
/// Returns what each colour is, in the words of a legend. `organs` are those that the Model was built of.
std::vector<std::string> colour_by_material(const scenes::SceneSpec& scene, std::span<const FilledOrgan> organs,
                                            render::SceneView& view);

}  // namespace ctpm::views
