#pragma once

#include <optional>
#include <vector>

#include "core/model/result.h"
#include "core/model/state.h"
#include "core/model/vec3.h"
#include "studio/render/scene_view.h"

namespace ctpm::views {

/// What tools did to the tissue, as far as a State tells.
enum class Event {
  wound,  ///< all that was cut
  press   ///< the tissue at the tools that are no blades, at State::last_inputs
};

struct EventCamera {
  render::Camera camera;
  std::vector<Vec3> pieces;  ///< where what was cut off lies beside its organ [m]
};

/// A camera on an event: of directions around the organs the one from which most of it is visible, rather those near
/// `usual`. It shows the event and what is around it. None if the State
/// tells of no such event. Errors: no OpenGL 3.3.
Result<std::optional<EventCamera>> event_camera(Event event, const render::SceneView& scene, const State& state,
                                                const render::Camera& usual, double aspect);

}  // namespace ctpm::views
