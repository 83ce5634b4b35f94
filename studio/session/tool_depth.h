#pragma once

#include <optional>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "studio/session/cut_measures.h"

namespace ctpm::session {

/// How deep what a hand holds is in an organ: a ball as its tick says, a blade along itself
/// (CutMeasures::edge_depth()).
class ToolDepth {
 public:
  /// `model` must outlive this.
  explicit ToolDepth(const Model& model) : model_(&model) {}

  /// `ball_depth`: what the tick that made `state` says of this hand [m]. Returns metres.
  double of(const Hand& hand, double ball_depth, const State& state);

 private:
  const Model* model_;
  std::optional<CutMeasures> cuts_;  ///< once a blade is in a hand
};

}  // namespace ctpm::session
