#pragma once

namespace ctpm::session {

/// Whom a thread goes before, as the kernel's nice values have it. The browser draws on the same processors.
enum class Urgency {
  tick = -15,     ///< a tick, and the input that it takes: the network never computes
  picture = -10,  ///< what somebody waits for
  idle = 15,      ///< what may be of use later
};

/// How long the calling thread was on a processor [s].
double thread_time();

/// How long the calling thread has waited for a processor while others had them [s]; 0 where the kernel does not tell.
double thread_wait();

/// Gives the calling thread that urgency, and those that it makes. Only a privileged user may go before others; without
/// that a thread stays as it was, but for ticks, which every user may let interrupt the slices of others.
void become(Urgency urgency);

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

/// As long as it lives, processors with nothing to do stay awake: a tick on one that slept for half a millisecond takes
/// up to one and a half times as long. It costs power, but no other thread its processor. Without the privilege to
/// write to /dev/cpu_dma_latency (PM QoS of the kernel) it changes nothing.
class AwakeProcessors {
 public:
  AwakeProcessors();
  ~AwakeProcessors();
  AwakeProcessors(const AwakeProcessors&) = delete;
  AwakeProcessors& operator=(const AwakeProcessors&) = delete;

 private:
  int file_;
};

/// Lets the calling thread run ticks in real time before everything else, with the threads that it makes meanwhile.
class TickUrgency {
 public:
  /// `tick`: from one to the next [s].
  explicit TickUrgency(double tick);
  /// The thread is as it was.
  ~TickUrgency();
  TickUrgency(const TickUrgency&) = delete;
  TickUrgency& operator=(const TickUrgency&) = delete;

  /// After each tick.
  void go_on() { precedence_.go_on(); }

 private:
  int nice_before_;
  Precedence precedence_;
  AwakeProcessors awake_;
};

}  // namespace ctpm::session
