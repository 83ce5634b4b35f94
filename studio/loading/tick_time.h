#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::loading {

/// Ticks that the median is of.
inline constexpr int kMeasuredTicks = 41;
inline constexpr int kTicksToMeasure = 20 + kMeasuredTicks;  ///< with those that only warm up

/// Median time of a tick without a tool on this machine, now [s], from `state`: one that has settled, for a tick at
/// rest. `progress` gets the ticks that are done, of kTicksToMeasure. None if `should_stop` ended it.
std::optional<double> measure_tick(const Model& model, State state, const std::function<bool()>& should_stop = {},
                                   const std::function<void(std::int64_t done)>& progress = {});

/// Mean processor time of the first ticks of a scene that has not settled [s], which cost about what those of a press
/// cost. The Model's tools lie aside meanwhile. None if `should_stop` ended it.
std::optional<double> measure_tick_work(Model& model, const std::function<bool()>& should_stop = {});

}  // namespace ctpm::loading
