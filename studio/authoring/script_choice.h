#pragma once

#include <functional>
#include <optional>

#include "core/model/organ.h"
#include "scenes/scene_spec.h"
#include "scenes/script.h"
#include "studio/authoring/anchor_choice.h"

namespace ctpm::authoring {

/// A script for an organ, and what it does there.
struct ScriptChoice {
  scenes::Script script;
  double most_force = 0;  ///< on a tool [N]
  bool was_cut = false;
  bool is_refused = false;                  ///< a tick was
  bool is_inside_out = false;               ///< as in loading::ScriptTrial
  double dragged = 0;                       ///< as in loading::ScriptTrial [m]
  bool drags = false;                       ///< a blade turns tissue inside out, or one that does not go through takes
                                            ///< the organ along
  double usual_work = 0, dearest_work = 0;  ///< as in loading::ScriptTrial [s]

  bool works() const { return most_force > 0 && was_cut && !is_refused; }
};

/// Finds a script that touches and cuts the only organ of `scene`, `filled` at rest, where it has settled: at the usual
/// place first, then without a press before the cut, then at others, then right through it; else one that touches it.
/// Where a blade takes the organ along, it goes in less deep; of those that go through, one is sought that turns no
/// tissue inside out. `is_timed`: each is run to its end, so that the times of its ticks are those of the whole cut.
/// None if `should_stop` ended it.
std::optional<ScriptChoice> choose_script(const scenes::SceneSpec& scene, const FilledOrgan& filled,
                                          const AnchorChoice& standing, bool is_timed,
                                          const std::function<bool()>& should_stop);

}  // namespace ctpm::authoring
