#pragma once

#include "core/cutting/cut_front.h"
#include "core/model/model.h"

namespace ctpm::contact {

/// The held tool and its motion over one tick.
struct HeldTool {
  const Tool* tool = nullptr;                ///< null: no tool is held
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

}  // namespace ctpm::contact
