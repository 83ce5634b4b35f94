#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace ctpm::film {

/// Hands things from one thread to another, at most `capacity` of them waiting: whoever is ahead waits, so
/// that memory stays the same however long the work.
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

  /// Waits for the next thing. Nothing: the queue is closed and empty.
  std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    has_things_.wait(lock, [&] { return !waiting_.empty() || is_closed_; });
    if (waiting_.empty()) return std::nullopt;
    std::optional<T> thing(std::move(waiting_.front()));
    waiting_.pop_front();
    has_room_.notify_one();
    return thing;
  }

  /// Nothing more comes; what waits can still be taken.
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    has_room_.notify_all(), has_things_.notify_all();
  }

  /// Nothing more is wanted: what waits is dropped, and whoever pushes is told.
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
