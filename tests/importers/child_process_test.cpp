#include "importers/child_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace ctpm {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

importers::ChildLimits short_limits() {
  importers::ChildLimits limits;
  limits.time_s = 0.3;
  limits.memory_mib = 64;
  limits.output_mib = 8;
  return limits;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Child, SendsWhatItComputes) {
  const importers::ChildResult child = importers::run_in_child({}, [](const importers::Send& send) {
    send("abc", 3);
    const std::string much(1 << 20, 'x');
    send(much.data(), much.size());
  });
  EXPECT_TRUE(child.is_whole) << child.trouble;
  EXPECT_EQ(child.output, "abc" + std::string(1 << 20, 'x'));
}

TEST(Child, CrashIsTroubleOfTheChildAlone) {
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGKILL}) {
    const importers::ChildResult child = importers::run_in_child(short_limits(), [number](const importers::Send& send) {
      send("half", 4);
      std::raise(number);
    });
    EXPECT_FALSE(child.is_whole);
    EXPECT_NE(child.trouble.find("crashed"), std::string::npos) << child.trouble;
    EXPECT_NE(child.trouble.find(strsignal(number)), std::string::npos) << child.trouble;
  }
}

TEST(Child, SleepingChildIsKilledInTime) {
  importers::ChildResult child;
  const double seconds =
      seconds_of([&] { child = importers::run_in_child(short_limits(), [](const importers::Send&) { pause(); }); });
  EXPECT_EQ(child.trouble, "took longer than 0.3 s");
  EXPECT_LT(seconds, 2.0);
}

TEST(Child, SpinningChildThatIgnoresSignalsIsKilledInTime) {
  importers::ChildResult child;
  const double seconds = seconds_of([&] {
    child = importers::run_in_child(short_limits(), [](const importers::Send&) {
      for (int number = 1; number < 32; ++number) std::signal(number, SIG_IGN);
      for (volatile bool goes_on = true; goes_on;) {
      }
    });
  });
  EXPECT_EQ(child.trouble, "took longer than 0.3 s");
  EXPECT_LT(seconds, 2.0);
}

TEST(Child, ChildThatDripsForeverIsKilledInTime) {
  const importers::ChildResult child = importers::run_in_child(short_limits(), [](const importers::Send& send) {
    while (send("x", 1)) usleep(1000);
  });
  EXPECT_EQ(child.trouble, "took longer than 0.3 s");
}

TEST(Child, MemoryHungerEndsAtTheLimit) {
  if (kIsSanitized) GTEST_SKIP() << "sanitizers need far more address space than any limit";
  importers::ChildLimits limits = short_limits();
  limits.time_s = 20;
  const importers::ChildResult child = importers::run_in_child(limits, [](const importers::Send&) {
    for (std::vector<std::vector<char>> hoard;;) hoard.emplace_back(std::size_t(1) << 20, 'x');
  });
  EXPECT_EQ(child.trouble, "needs more than 64 MiB of memory");
}

TEST(Child, FloodEndsAtTheLimit) {
  importers::ChildLimits limits = short_limits();
  limits.time_s = 20;
  const importers::ChildResult child = importers::run_in_child(limits, [](const importers::Send& send) {
    const std::string much(1 << 20, 'x');
    while (send(much.data(), much.size())) {
    }
  });
  EXPECT_EQ(child.trouble, "sent more than 8 MiB");
}

TEST(Child, ExceptionIsTroubleToo) {
  const importers::ChildResult child =
      importers::run_in_child(short_limits(), [](const importers::Send&) { throw std::runtime_error("no"); });
  EXPECT_FALSE(child.is_whole);
  EXPECT_NE(child.trouble.find("gave up"), std::string::npos) << child.trouble;
}

TEST(Child, HasNoFilesOfTheParentAndWritesNone) {
  const int open_in_parent = open("/dev/null", O_RDONLY);
  ASSERT_GE(open_in_parent, 3);
  const importers::ChildResult child = importers::run_in_child(short_limits(), [&](const importers::Send& send) {
    const char is_closed = fcntl(open_in_parent, F_GETFD) < 0 && errno == EBADF ? 'y' : 'n';
    send(&is_closed, 1);
    std::signal(SIGXFSZ, SIG_IGN);
    const int file = open("/tmp", O_TMPFILE | O_RDWR, 0600);
    const char is_refused = file < 0 || write(file, "x", 1) < 0 ? 'y' : 'n';
    send(&is_refused, 1);
  });
  EXPECT_TRUE(child.is_whole) << child.trouble;
  EXPECT_EQ(child.output, "yy");
  close(open_in_parent);
}

TEST(Child, LeavesNeitherZombieNorFileBehind) {
  const int before = open("/dev/null", O_RDONLY);
  close(before);
  for (int run = 0; run < 20; ++run)
    (void)importers::run_in_child(short_limits(), [run](const importers::Send&) {
      if (run % 2) std::abort();
    });
  const int after = open("/dev/null", O_RDONLY);
  close(after);
  EXPECT_EQ(before, after) << "a descriptor leaked";
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

}  // namespace
}  // namespace ctpm
