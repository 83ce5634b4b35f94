#pragma once

#include <atomic>
#include <chrono>

namespace ctpm::server {

/// Whom a thread goes before, as the kernel's nice values have it. The browser draws on the same processors.
enum class Urgency {
  tick = -15,     ///< a tick, and the input that it takes: the network never computes
  picture = -10,  ///< what somebody waits for
  idle = 15,      ///< what may be of use later
};

/// Gives the calling thread that urgency, and those that it makes. Only a privileged user may go before others; without
/// that a thread stays as it was, but for ticks, which every user may let interrupt the slices of others.
void become(Urgency urgency);

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

/// Lets a thread that does something over and over in real time go before everything else, as long as it leaves the
/// processor free for a part of the time: it then interrupts even the browser's slices. Without the privilege it
/// changes nothing. Used by that thread alone.
class Precedence {
 public:
  /// `interval`: from one time to the next [s].
  explicit Precedence(double interval) : interval_(interval) {}

  /// After each time.
  void go_on();

  /// It is not needed any more.
  void give_up();

 private:
  double interval_;
  double judged_at_ = 0;  ///< the thread's time on a processor [s]
  int count_ = 0;         ///< of times since then
  bool is_first_ = false;
};

}  // namespace ctpm::server
