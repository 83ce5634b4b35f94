#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"
#include "scenes/scene_spec.h"

namespace ctpm::loading {

/// A sag of more than this part of an organ's size is no longer the organ that its author made.
inline constexpr double kMostSag = 0.1;

/// How one organ comes to rest.
struct OrganStanding {
  double sag = 0;  ///< largest way of a sphere from its rest position, without that of the whole if nothing is held [m]
  double way = 0;  ///< of the whole, where nothing of it is held [m]
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

/// How each organ of a State that has settled stands.   (organ_count)
std::vector<OrganStanding> standing_of(const Model& model, const State& settled);

/// Lets the Model of a scene come to rest as a session does before its first tick, for at most the scene's `settle_s`.
/// Ends as soon as an organ sags by more than `most_sag` of its size; unset: never. None if `should_stop` ended it.
/// `progress` gets the ticks that are done, and how many there can be at most. The second lays the Model's tools aside
/// meanwhile, which is sooner where the surfaces are fine; the result is the same.
std::optional<Standing> settle_scene(const scenes::SceneSpec& scene, const Model& model,
                                     std::optional<double> most_sag = {}, const std::function<bool()>& should_stop = {},
                                     const std::function<void(std::int64_t done, std::int64_t most)>& progress = {});
std::optional<Standing> settle_without_tools(const scenes::SceneSpec& scene, Model& model,
                                             std::optional<double> most_sag = {},
                                             const std::function<bool()>& should_stop = {});

}  // namespace ctpm::loading
