#pragma once

#include <cstdint>

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::contact {

/// A cut opens, and is touched from then on, so long after the blade has left it [s] (our choice). Until then its
/// surface is made beside the ticks, which takes some tenths of a second.
inline constexpr double kOpensAfter = 0.5;

/// The same in ticks, at least one.
std::int64_t ticks_until_open(const Model& model);

/// Whether follow_open_cuts() will change `state`.
bool changes_open_cuts(bool cuts, const State& state);

/// Opens what is due at the start of a tick, and takes down what the blade has left since. `cuts`: a blade is held.
void follow_open_cuts(const Model& model, bool cuts, State& state);

}  // namespace ctpm::contact
