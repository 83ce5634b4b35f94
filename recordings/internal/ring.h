#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace ctpm::recordings::session_file {

/// A lock-free queue from one producer thread to one consumer thread. It never allocates after construction: slots are
/// filled and emptied in place.
template <class T>
class Ring {
 public:
  Ring(std::size_t capacity, const T& prototype) : slots_(capacity, prototype) {}

  /// Producer: the slot to fill, or null if the ring is full. push() hands it over.
  T* free_slot() {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    return tail - head_.load(std::memory_order_acquire) < slots_.size() ? &slots_[tail % slots_.size()] : nullptr;
  }
  void push() { tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// Consumer: number of waiting items, the i-th of them, and release of the first `count` slots.
  std::size_t waiting() const { return tail_.load(std::memory_order_acquire) - head_.load(std::memory_order_relaxed); }
  const T& waiting_at(std::size_t i) const {
    return slots_[(head_.load(std::memory_order_relaxed) + i) % slots_.size()];
  }
  void pop(std::size_t count) { head_.store(head_.load(std::memory_order_relaxed) + count, std::memory_order_release); }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> head_{0};  // written by the consumer only
  alignas(64) std::atomic<std::size_t> tail_{0};  // written by the producer only
};

}  // namespace ctpm::recordings::session_file
