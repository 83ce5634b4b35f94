#include "core/parallel/team.h"

namespace ctpm::parallel {
namespace {

/// Checks before a thread sleeps or yields: some tens of microseconds, longer than the gaps within a tick.
constexpr int kLooks = 4000;

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// open_ as one number: the round, the first task left and the end of the tasks left.
std::uint64_t packed(std::uint32_t round, std::uint32_t first, std::uint32_t end) {
  return std::uint64_t(round) << 32 | std::uint64_t(first) << 16 | end;
}

}  // namespace

Team::Team(int threads) {
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

Team::~Team() {
  stops_ = true;
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

/// Takes a task of the round that nobody has begun: the caller the first one, workers the last one, so that each thread
/// finds the same data in its own cache. False: none is left, or the round is over.
bool Team::claim(std::uint32_t round, bool from_below, int& task) {
  std::uint64_t seen = open_.load(std::memory_order_acquire);
  for (;;) {
    const auto first = std::uint32_t(seen >> 16 & 0xffff), end = std::uint32_t(seen & 0xffff);
    if (std::uint32_t(seen >> 32) != round || first >= end) return false;
    task = int(from_below ? first : end - 1);
    const std::uint64_t left = from_below ? packed(round, first + 1, end) : packed(round, first, end - 1);
    if (open_.compare_exchange_weak(seen, left, std::memory_order_acq_rel, std::memory_order_acquire)) return true;
  }
}

void Team::run(int count, Call call, void* what) {
  // All tasks of the last round are done, so no thread reads these now.
  call_ = call, what_ = what;
  undone_.store(count, std::memory_order_relaxed);
  const std::uint32_t round = round_.load(std::memory_order_relaxed) + 1;
  open_.store(packed(round, 0, std::uint32_t(count)), std::memory_order_release);
  round_.store(round, std::memory_order_release);
  round_.notify_all();
  for (int task; claim(round, true, task);) {
    call(what, task);
    undone_.fetch_sub(1, std::memory_order_acq_rel);
  }
  for (int looks = 0; undone_.load(std::memory_order_acquire) > 0; ++looks)
    if (looks < kLooks)
      pause();
    else
      std::this_thread::yield();
}

void Team::work() {
  std::uint32_t seen = 0;
  for (;;) {
    std::uint32_t now = round_.load(std::memory_order_acquire);
    for (int looks = 0; now == seen && looks < kLooks; ++looks) pause(), now = round_.load(std::memory_order_acquire);
    if (now == seen) {
      round_.wait(seen, std::memory_order_acquire);
      continue;
    }
    seen = now;
    if (stops_) return;
    for (int task; claim(now, false, task);) {
      call_(what_, task);
      undone_.fetch_sub(1, std::memory_order_acq_rel);
    }
  }
}

}  // namespace ctpm::parallel
