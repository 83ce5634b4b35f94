#pragma once

#include <vector>

#include "core/contact/held_tool.h"
#include "core/cutting/cut_front.h"
#include "core/cutting/cutting.h"
#include "core/cutting/pieces.h"
#include "core/model/inputs.h"
#include "core/model/state.h"
#include "core/stepping/step.h"

namespace ctpm::stepping {

/// What a scalpel cuts in one tick, and the pieces that come loose.
class BladeSweep {
 public:
  /// `model` must outlive the BladeSweep and have a scalpel.
  explicit BladeSweep(const Model& model);

  /// Begins a tick in which the hand with the scalpel goes from `last` to `hand`, and sets its edge and front in
  /// `tool`. `is_taken`: the scalpel has just been picked up.
  void begin_tick(const Hand& last, const Hand& hand, bool is_taken, contact::HeldTool& tool, State& state);

  /// Begins a substep from `state`.
  void begin_substep(const State& state) { front_.begin_substep(state); }

  /// Cuts what the scalpel cut in the substep that ended in `state`, at `share` of the tool's motion in the tick.
  void end_substep(const contact::HeldTool& tool, double share, State& state, StepReport& report);

  /// Reports the pieces that came loose in the tick.
  void report_pieces(const State& state, StepReport& report);

 private:
  cutting::CutFront front_;
  std::vector<cutting::Crossing> crossings_;  ///< elements severed in this tick
  cutting::Pieces pieces_;
};

}  // namespace ctpm::stepping
