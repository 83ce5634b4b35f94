#pragma once

#include <cstdint>

#include "core/model/model.h"
#include "core/model/state.h"
#include "studio/bench/bench.h"

// What tools do in the study in time, from a State in which the organs rest.
namespace ctpm::bench {

/// Index of the Model's first tool of a kind; -1: it has none.
std::int32_t first_tool(const Model& model, ToolKind kind);

/// The ball presses 6 mm deep at 100 mm/s from where it touches the highest place of the first organ's drawn surface,
/// or where there is none, the highest free sphere; stays, and leaves.
BenchMotion press_the_top(const Model& model, std::int32_t ball, const State& start);

/// A pin, added to `model`, moves the highest free sphere as the ball would, without contact.
BenchMotion move_the_top(Model& model, const State& start);

/// The ball goes between the shipped liver and the kidney behind it, and presses both.
BenchMotion press_between(const Model& model, std::int32_t ball, const State& start);

/// The scalpel goes along x through the middle of the organ's upper half, at 400 mm/s.
BenchMotion cut_along_x(const Model& model, std::int32_t scalpel, const State& start);

}  // namespace ctpm::bench
