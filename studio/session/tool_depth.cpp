#include "studio/session/tool_depth.h"

namespace ctpm::session {

double ToolDepth::of(const Hand& hand, double ball_depth, const State& state) {
  if (!model_->is_scalpel(hand.tool)) return ball_depth;
  if (!cuts_) cuts_.emplace(*model_);
  return cuts_->edge_depth(state);
}

}  // namespace ctpm::session
