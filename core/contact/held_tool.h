#pragma once

#include <span>

#include "core/contact/blade_motion.h"
#include "core/cutting/cutting.h"
#include "core/cutting/near_elements.h"
#include "core/model/model.h"

namespace ctpm::contact {

/// The held tool and its motion over one tick.
struct HeldTool {
  const Tool* tool = nullptr;                ///< null: no tool is held
  Vec3 from, to;                             ///< the tool's origin at the start and the end of the tick [m]
  BladeMotion blade;                         ///< of a scalpel
  cutting::NearElements* near = nullptr;     ///< elements that a scalpel can meet in this tick
  std::span<const cutting::Crossing> swept;  ///< elements that a scalpel severed by its own motion in this tick

  /// Where the tool's origin is at `share` of the tick, 0 to 1 [m].
  Vec3 at(double share) const { return from + share * (to - from); }

  bool is(ToolKind kind) const { return tool != nullptr && tool->kind == kind; }
};

}  // namespace ctpm::contact
