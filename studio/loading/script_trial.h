#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"
#include "core/stepping/step.h"
#include "scenes/script.h"

namespace ctpm::loading {

/// What a script did to a scene.
struct ScriptTrial {
  double most_force = 0;       ///< on a tool [N]
  std::int64_t severed = 0;    ///< elements
  std::vector<char> was_cut;   ///< whether a blade went through tissue of the organ that was whole (organ_count)
  bool is_refused = false;     ///< a tick was refused
  bool is_inside_out = false;  ///< a cell of tissue was, in a tick with a blade in a hand
  /// The farthest that a blade took all spheres along: length of their mean displacement since the start [m].
  double dragged = 0;
  /// Processor time of a tick on this machine: median of all, and p99 of those in which a tool was in contact or in a
  /// cut [s]; other programs do not count.
  double usual_work = 0, dearest_work = 0;
};

/// Runs a script from `state` with a Stepper of the Model. Ends early, where `until_cut` names an organ, when a tool
/// felt force, that organ was cut, and no hand holds a blade any more. None if `should_stop` ended it.
std::optional<ScriptTrial> try_script(const Model& model, stepping::Stepper& stepper, const State& state,
                                      const scenes::Script& script, std::optional<std::size_t> until_cut = {},
                                      const std::function<bool()>& should_stop = {});

}  // namespace ctpm::loading
