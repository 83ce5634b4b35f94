#pragma once

#include <atomic>
#include <chrono>

namespace ctpm::server {

/// While one lives, what may be of use later waits: a training runs. It also waits for a moment after each picture that
/// somebody asked for, until the browser has drawn it: a nice value does not hold between programs whose sessions the
/// kernel groups (autogroup).
class IdlePause {
 public:
  IdlePause() { ++count_; }
  ~IdlePause() { --count_; }
  IdlePause(const IdlePause&) = delete;
  IdlePause& operator=(const IdlePause&) = delete;

  static bool is_on() { return count_ > 0 || Clock::now().time_since_epoch().count() < held_until_; }

  /// From now on for a moment.
  static void hold() { held_until_ = (Clock::now() + kDrawing).time_since_epoch().count(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kDrawing{250};  ///< of a picture, by a browser without a GPU

  static inline std::atomic<int> count_{0};
  static inline std::atomic<Clock::rep> held_until_{0};
};

}  // namespace ctpm::server
