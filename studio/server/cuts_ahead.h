#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "core/model/model.h"
#include "core/model/state.h"
#include "studio/server/drawn_cuts.h"

namespace ctpm::server {

/// Draws the cuts of a session ahead of time, as they are at its keyframes: in the order of time, each quick after the
/// one before. It has a thread of low priority.
class CutsAhead {
 public:
  /// Draws those of `file`, whose Model is `model`, for stage `stage` into `cuts`.
  CutsAhead(const std::string& file, const Model& model, std::uint32_t stage, std::shared_ptr<DrawnCuts> cuts);
  ~CutsAhead();

 private:
  class Walk;

  std::shared_ptr<DrawnCuts> cuts_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace ctpm::server
