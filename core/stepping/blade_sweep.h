#pragma once

#include <vector>

#include "core/contact/contacts.h"
#include "core/contact/held_tool.h"
#include "core/cutting/cutting.h"
#include "core/cutting/near_elements.h"
#include "core/cutting/pieces.h"
#include "core/model/inputs.h"
#include "core/model/state.h"
#include "core/stepping/step.h"

namespace ctpm::stepping {

/// Severs what a scalpel cuts in one tick, and counts the pieces that come loose.
class BladeSweep {
 public:
  /// `model` must outlive the BladeSweep and have a scalpel.
  explicit BladeSweep(const Model& model);

  /// Moves the scalpel from `last` to `inputs` through the resting tissue, and severs what it sweeps. Sets in `tool`
  /// the motion of the blade, the elements near it and those that it severed.
  void sweep(const contact::Contacts& contacts, const Inputs& last, const Inputs& inputs, contact::HeldTool& tool,
             State& state, StepReport& report);

  /// Severs the elements that moved through the resting blade while positions went from `before` [m] to those of
  /// `state`.
  void sever_moved(const contact::HeldTool& tool, const Vec3Array& before, State& state, StepReport& report);

  /// Reports the pieces that came loose since sweep().
  void report_pieces(const State& state, StepReport& report);

 private:
  const Model& model_;
  cutting::NearElements near_;
  std::vector<cutting::Crossing> crossings_;  ///< elements severed in this tick
  cutting::Pieces pieces_;
};

}  // namespace ctpm::stepping
