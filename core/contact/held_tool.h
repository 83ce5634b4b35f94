#pragma once

#include <array>

#include "core/cutting/cut_front.h"
#include "core/model/model.h"

namespace ctpm::contact {

/// The tool that a hand holds, and its motion over one tick.
struct HeldTool {
  const Tool* tool = nullptr;                ///< null: the hand is empty
  Vec3 from, to;                             ///< the tool's origin at the start and the end of the tick [m]
  cutting::BladeEdge edge_from, edge_to;     ///< the same of a scalpel's edge
  const cutting::CutFront* front = nullptr;  ///< of the cut that a scalpel makes

  /// Where the tool's origin is at `share` of the tick, 0 to 1 [m].
  Vec3 at(double share) const { return from + share * (to - from); }
  cutting::BladeEdge edge_at(double share) const {
    return {edge_from.tip + share * (edge_to.tip - edge_from.tip),
            edge_from.heel + share * (edge_to.heel - edge_from.heel),
            edge_from.back + share * (edge_to.back - edge_from.back)};
  }

  bool is(ToolKind kind) const { return tool != nullptr && tool->kind == kind; }
};

/// Those of both hands. One of them at most holds a scalpel.
using HeldTools = std::array<HeldTool, kMostHands>;

/// The scalpel that a hand holds; null: none does.
inline const HeldTool* held_scalpel(const HeldTools& tools) {
  for (const HeldTool& tool : tools)
    if (tool.is(ToolKind::scalpel)) return &tool;
  return nullptr;
}

}  // namespace ctpm::contact
