#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace ctpm::server {

/// When the next picture of a running session is made: sixty times a second, or, for a page that says when it is ready
/// for one, then. A browser that draws slower would take the others from the network and throw them away, which costs
/// it time that it needs for drawing and for the poses of the hand.
class PicturePace {
 public:
  /// The page would draw the next picture at once, and will say so again.
  void ready() {
    {
      const std::lock_guard lock(mutex_);
      follows_page_ = is_ready_ = true;
    }
    changed_.notify_one();
  }

  /// Waits until the next picture is due; for the thread that makes them.
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, last_ + (follows_page_ ? kPatience : kInterval), [&] { return is_ready_; });
    is_ready_ = false, last_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::microseconds kInterval{16667};
  static constexpr std::chrono::milliseconds kPatience{250};  ///< with a page that is hidden, or has lost a picture

  std::mutex mutex_;
  std::condition_variable changed_;
  bool follows_page_ = false, is_ready_ = false;
  Clock::time_point last_ = Clock::now();  ///< when the last one was due
};

}  // namespace ctpm::server
