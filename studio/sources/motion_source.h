#pragma once

#include <optional>
#include <utility>

#include "studio/sources/input_source.h"
#include "studio/sources/motion_file.h"

namespace ctpm::sources {

/// A measured motion as the source of a session, sampled once per tick.
class MotionSource : public InputSource {
 public:
  MotionSource(Motion motion, double tick) : motion_(std::move(motion)), tick_(tick) {}

  std::optional<Inputs> next(std::int64_t tick, const stepping::StepReport&) override {
    if (tick >= tick_count()) return std::nullopt;
    return motion_at(motion_, double(tick) * tick_);
  }
  std::int64_t tick_count() const override { return motion_tick_count(motion_, tick_); }

 private:
  Motion motion_;
  double tick_;  ///< [s]
};

}  // namespace ctpm::sources
