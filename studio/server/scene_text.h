#pragma once

#include <string>

#include "core/model/model.h"
#include "scenes/scene_spec.h"

namespace ctpm::server {

/// A text as JSON.
std::string json_text(const std::string& text);

/// What a page needs to draw a scene: its organs' looks, tools, cameras, limits, box and direction up, as JSON.
std::string view_json(const scenes::SceneSpec& scene, const Model& model);

}  // namespace ctpm::server
