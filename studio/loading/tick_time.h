#pragma once

#include <functional>
#include <optional>

#include "core/model/model.h"

namespace ctpm::loading {

/// Ticks that the median is of.
inline constexpr int kMeasuredTicks = 41;

/// Median time of a tick at rest on this machine, now [s]. None if `should_stop` ended it.
std::optional<double> measure_tick(const Model& model, const std::function<bool()>& should_stop = {});

/// Mean processor time of a tick at rest on this machine [s]: what measure_tick() would give if no other program ran.
/// None if `should_stop` ended it.
std::optional<double> measure_tick_work(const Model& model, const std::function<bool()>& should_stop = {});

}  // namespace ctpm::loading
