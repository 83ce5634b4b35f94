#pragma once

#include <optional>

#include "core/model/result.h"
#include "core/model/state.h"
#include "studio/render/scene_view.h"

namespace ctpm::views {

/// A camera on the cuts of a State: of directions around the organs the one from which most of the wound is visible,
/// rather those near `usual`. It shows the wound and what is around it. None if nothing is cut. Errors: no OpenGL 3.3.
Result<std::optional<render::Camera>> wound_camera(const render::SceneView& scene, const State& state,
                                                   const render::Camera& usual, double aspect);

}  // namespace ctpm::views
