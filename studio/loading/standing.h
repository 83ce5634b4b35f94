#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"
#include "scenes/script.h"

namespace ctpm::loading {

/// A sag of more than this part of an organ's size is no longer the organ that its author made.
inline constexpr double kMostSag = 0.1;

/// How one organ comes to rest.
struct OrganStanding {
  double sag = 0;  ///< largest way of a sphere from its rest position, without that of the whole if nothing is held [m]
  double size = 0;        ///< diagonal of the box around its spheres at rest [m]
  std::int32_t held = 0;  ///< spheres that never move

  double share() const { return size > 0 ? sag / size : 0; }
  bool stands() const { return share() <= kMostSag; }
};

/// How a scene comes to rest.
struct Standing {
  std::vector<OrganStanding> organ;  ///< (organ_count)
  State state;                       ///< settled
  bool is_refused = false;           ///< the integrator gave up
  bool stands() const;
};

/// Lets a scene come to rest as a session does before its first tick, for at most `ticks` ticks. Ends as soon as an
/// organ sags by more than `most_sag` of its size; unset: never. None if `should_stop` ended it.
std::optional<Standing> settle_scene(const Model& model, std::int64_t ticks, std::optional<double> most_sag = {},
                                     const std::function<bool()>& should_stop = {});

/// What a script did to a scene.
struct ScriptTrial {
  double most_force = 0;      ///< on a tool [N]
  std::int64_t severed = 0;   ///< elements
  std::vector<char> was_cut;  ///< whether a blade went through tissue of the organ that was whole (organ_count)
  bool is_refused = false;    ///< a tick was refused
  double tick_time = 0;       ///< median of all ticks on this machine [s]
};

/// Runs a script from `state`. Ends early, where `until_cut` names an organ, when a tool felt force and that organ was
/// cut. None if `should_stop` ended it.
std::optional<ScriptTrial> try_script(const Model& model, const State& state, const scenes::Script& script,
                                      std::optional<std::size_t> until_cut = {},
                                      const std::function<bool()>& should_stop = {});

}  // namespace ctpm::loading
