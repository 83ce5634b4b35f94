#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/model/state.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::loading {

/// What is odd about where the things of a scene are, although it can be built, each with its place: a probe, a load or
/// a camera far from all tissue; an organ that is too thin for its spheres, or lies in another one.
Errors find_odd_places(const LoadedScene& scene);

/// What is odd about how a scene stands once it has settled: an organ that sags by more than a tenth of its size, or
/// goes away as a whole; one that is held everywhere, or nowhere with nothing to rest on.
Errors find_unsteady(const LoadedScene& scene, const State& settled);

/// All that is odd: odd places, and how it stands. Settles the scene. None if `should_stop` ended it.
std::optional<Errors> find_oddities(const LoadedScene& scene, const std::function<bool()>& should_stop = {});

}  // namespace ctpm::loading
