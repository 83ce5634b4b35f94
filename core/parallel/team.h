#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace ctpm::parallel {

/// A fixed set of threads that share numbered tasks. Results do not depend on which thread runs a task, and so are the
/// same for any number of threads. Between calls the threads first spin, then sleep. The caller runs the tasks that
/// they have not begun, so that a thread that the system keeps off its core delays nobody.
class Team {
 public:
  /// `threads` >= 1 includes the thread of the caller; 1 starts none.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return int(workers_.size()) + 1; }

  /// Calls `task(i)` once for each i in [0, count), possibly in parallel, and returns when all are done; count < 65536.
  template <class Task>
  void for_each(int count, Task&& task) {
    if (workers_.empty() || count <= 1) {
      for (int i = 0; i < count; ++i) task(i);
      return;
    }
    run(
        count, [](void* what, int i) { (*static_cast<std::remove_reference_t<Task>*>(what))(i); },
        const_cast<void*>(static_cast<const void*>(&task)));
  }

 private:
  using Call = void (*)(void* what, int task);
  void run(int count, Call call, void* what);
  void work();
  bool claim(std::uint32_t round, bool from_below, int& task);

  std::vector<std::thread> workers_;
  Call call_ = nullptr;
  void* what_ = nullptr;
  std::atomic<bool> stops_{false};
  alignas(64) std::atomic<std::uint32_t> round_{0};  ///< rises when there is work
  alignas(64) std::atomic<std::uint64_t> open_{0};   ///< the round, and the range of tasks not yet begun
  alignas(64) std::atomic<int> undone_{0};           ///< tasks of the round that are not finished
};

}  // namespace ctpm::parallel
