#pragma once

#include <optional>
#include <vector>

#include "core/model/model.h"
#include "scenes/scene_spec.h"
#include "scenes/script.h"
#include "studio/render/marks.h"

namespace ctpm::views {

/// Marks of what a scene's author placed: axes, anchored spheres, probes, loads, where tools are taken up, and the ways
/// of a script's tools.
std::vector<render::Mark> marks_of(const scenes::SceneSpec& scene, const Model& model, const State& state,
                                   const std::optional<scenes::Script>& script);

}  // namespace ctpm::views
