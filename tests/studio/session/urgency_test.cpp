// Threads that go before others.

#include "studio/session/urgency.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <ctime>
#include <thread>

namespace ctpm::session {
namespace {

constexpr double kInterval = 1e-4;  // [s]
constexpr int kEnough = 250;        // times until it was judged twice

bool may_go_first() {
  sched_param parameters{};
  parameters.sched_priority = 1;
  bool may = false;
  std::thread([&] { may = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0; }).join();
  return may;
}

/// Uses the processor for `share` of each interval.
void go_on(Precedence& precedence, double share) {
  for (int i = 0; i < kEnough; ++i) {
    const std::clock_t busy = std::clock_t(share * kInterval * CLOCKS_PER_SEC);
    for (const std::clock_t end = std::clock() + busy; std::clock() < end;) {
    }
    precedence.go_on();
  }
}

TEST(Urgency, AThreadGoesFirstWhileItLeavesTheProcessorFreeForOthers) {
  if (!may_go_first()) GTEST_SKIP() << "this user may not schedule in real time";
  std::thread([] {
    become(Urgency::tick);
    Precedence precedence(kInterval);
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER) << "before anything is known";
    go_on(precedence, 0.1);
    EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO);
    go_on(precedence, 3);
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER) << "it cannot keep up";
    go_on(precedence, 0.1);
    EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO) << "again";
    precedence.give_up();
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
  }).join();
}

TEST(Urgency, TicksInRealTimeGoFirstAndThenTheThreadIsAsItWas) {
  if (!may_go_first()) GTEST_SKIP() << "this user may not schedule in real time";
  std::thread([] {
    const auto nice = [] { return getpriority(PRIO_PROCESS, id_t(gettid())); };
    ASSERT_EQ(setpriority(PRIO_PROCESS, id_t(gettid()), 3), 0);
    {
      TickUrgency urgency(kInterval);
      EXPECT_EQ(nice(), -15);
      for (int i = 0; i < kEnough; ++i) urgency.go_on();
      EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO);
    }
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
    EXPECT_EQ(nice(), 3);
  }).join();
}

TEST(Urgency, ProcessorsStayAwakeAsLongAsTicksRunInRealTime) {
  const auto longest_latency = [] {
    const int file = open("/dev/cpu_dma_latency", O_RDONLY);
    std::int32_t latency = -1;  // [us]
    if (file >= 0 && read(file, &latency, sizeof latency) != sizeof latency) latency = -1;
    if (file >= 0) close(file);
    return latency;
  };
  if (access("/dev/cpu_dma_latency", W_OK) != 0) GTEST_SKIP() << "this user may not keep processors awake";
  const std::int32_t before = longest_latency();
  if (before == 0) GTEST_SKIP() << "somebody else keeps them awake";
  {
    const TickUrgency urgency(kInterval);
    EXPECT_EQ(longest_latency(), 0);
  }
  EXPECT_EQ(longest_latency(), before);
}

TEST(Urgency, AThreadKnowsHowLongOthersHadItsProcessor) {
  std::thread([] {
    cpu_set_t all, one;
    CPU_ZERO(&one);
    if (sched_getaffinity(0, sizeof all, &all) != 0) GTEST_SKIP() << "threads cannot be kept on a processor here";
    int first = 0;
    while (!CPU_ISSET(first, &all)) ++first;
    CPU_SET(first, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    std::atomic<bool> ends = false;
    const double before = thread_wait();
    std::thread other([&] {  // on the same processor
      while (!ends) {
      }
    });
    for (const double start = thread_time(); thread_time() - start < 0.1;) {
    }
    ends = true;
    other.join();
    if (thread_wait() == 0) GTEST_SKIP() << "this kernel does not tell";
    EXPECT_GT(thread_wait() - before, 0.02) << "the other one had about half of the time";
  }).join();
}

}  // namespace
}  // namespace ctpm::session
