#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace ctpm::film {

/// A queue between two threads that holds at most `capacity` things. The faster thread waits, so that memory does not
/// grow with the length of the work.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  /// Waits for room. False: the queue is closed, and `thing` was not taken.
  bool push(T thing) {
    std::unique_lock lock(mutex_);
    has_room_.wait(lock, [&] { return waiting_.size() < capacity_ || is_closed_; });
    if (is_closed_) return false;
    waiting_.push_back(std::move(thing));
    has_things_.notify_one();
    return true;
  }

  /// Waits for the next thing. None: the queue is closed and empty.
  std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    has_things_.wait(lock, [&] { return !waiting_.empty() || is_closed_; });
    if (waiting_.empty()) return std::nullopt;
    std::optional<T> thing(std::move(waiting_.front()));
    waiting_.pop_front();
    has_room_.notify_one();
    return thing;
  }

  /// Ends the pushing: the things in the queue can still be popped.
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    has_room_.notify_all(), has_things_.notify_all();
  }

  /// Ends the popping: drops the things in the queue, and push() returns false.
  void abandon() {
    close();
    const std::lock_guard lock(mutex_);
    waiting_.clear();
  }

 private:
  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable has_room_, has_things_;
  std::deque<T> waiting_;
  bool is_closed_ = false;
};

}  // namespace ctpm::film
