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
/// after the last one was taken or dropped.
class NewestState {
 public:
  /// Called after each tick.
  void offer(const State& state, const recordings::TickRecord& record, std::int64_t late_ticks, double tick_p99) {
    if (is_full_.load(std::memory_order_acquire)) return;
    tick_.state = state, tick_.record = record, tick_.late_ticks = late_ticks, tick_.tick_p99 = tick_p99;
    is_full_.store(true, std::memory_order_release);
  }

  /// Empties the slot, so that the next tick is in it.
  void refresh() { is_full_.store(false, std::memory_order_release); }

  /// Gives `take` the tick in the slot, if there is one, and empties it.
  template <class Take>
  bool take(Take&& take) {
    if (!is_full_.load(std::memory_order_acquire)) return false;
    take(tick_);
    is_full_.store(false, std::memory_order_release);
    return true;
  }

 private:
  LiveTick tick_;
  std::atomic<bool> is_full_{false};
};

}  // namespace ctpm::server
