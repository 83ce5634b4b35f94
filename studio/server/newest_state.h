#pragma once

#include <atomic>

#include "core/model/state.h"
#include "recordings/session.h"

namespace ctpm::server {

/// A State and the record of the tick that led to it.
struct LiveTick {
  State state;
  recordings::TickRecord record;
  std::int64_t late_ticks = 0;
  double tick_p99 = 0;  ///< session::RecentTimes::p99() [s]
};

/// One slot between the thread of the ticks, which never waits, and one that makes pictures: a tick is copied only
/// after it was asked for.
class NewestState {
 public:
  /// Called after each tick.
  void offer(const State& state, const recordings::TickRecord& record, std::int64_t late_ticks, double tick_p99) {
    if (slot_.load(std::memory_order_acquire) != Slot::asked) return;
    tick_.state = state, tick_.record = record, tick_.late_ticks = late_ticks, tick_.tick_p99 = tick_p99;
    slot_.store(Slot::full, std::memory_order_release);
  }

  /// The next tick is wanted; for the thread that takes it.
  void ask() { slot_.store(Slot::asked, std::memory_order_release); }

  /// Gives `take` the tick that was asked for, if it is there.
  template <class Take>
  bool take(Take&& take) {
    if (slot_.load(std::memory_order_acquire) != Slot::full) return false;
    take(tick_);
    slot_.store(Slot::empty, std::memory_order_release);
    return true;
  }

 private:
  enum class Slot { empty, asked, full };

  LiveTick tick_;
  std::atomic<Slot> slot_{Slot::empty};
};

}  // namespace ctpm::server
