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
};

/// Finds a script that touches and cuts the only organ of `scene`, `filled` at rest, where it has settled: at the usual
/// place first, then at others; else one that touches it. None if `should_stop` ended it.
std::optional<ScriptChoice> choose_script(const scenes::SceneSpec& scene, const FilledOrgan& filled,
                                          const AnchorChoice& standing, const std::function<bool()>& should_stop);

}  // namespace ctpm::authoring
