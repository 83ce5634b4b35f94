#pragma once

#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "scenes/scene_spec.h"
#include "studio/render/scene_view.h"

namespace ctpm::views {

/// The renderer's view of a scene: its surfaces in the organs' colours. `model` must outlive the view.
render::SceneView view_of(const scenes::SceneSpec& scene, const Model& model);

}  // namespace ctpm::views
