#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace ctpm::devices {

/// Lock-free ring buffer for one producer and one consumer thread. Neither ever waits.
template <class T, std::size_t capacity>
class HandOver {
  static_assert((capacity & (capacity - 1)) == 0, "a power of two");

 public:
  /// False if it is full; the value is then not taken.
  bool push(const T& value) {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == capacity) return false;
    slots_[end % capacity] = value;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }

  /// False if it is empty.
  bool pop(T& value) {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    value = slots_[begin % capacity];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

 private:
  std::array<T, capacity> slots_;
  std::atomic<std::size_t> begin_{0}, end_{0};  ///< values popped and pushed so far
};

}  // namespace ctpm::devices
