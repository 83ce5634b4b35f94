// The thread of the ticks never waits for a socket. Shown without a clock: a tick needs nothing of the thread that
// reads the socket, and makes no system call that can wait.

#include <dirent.h>
#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/futex.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "studio/devices/device_source.h"
#include "studio/devices/igtl_link.h"
#include "tests/studio/devices/igtl_client.h"

namespace ctpm {
namespace {

using testing::IgtlPeer;
using testing::transform_bytes;

/// Threads of this process.
std::set<pid_t> threads() {
  std::set<pid_t> all;
  DIR* const folder = ::opendir("/proc/self/task");
  CTPM_CHECK(folder, "the threads of a process");
  while (const dirent* entry = ::readdir(folder))
    if (const pid_t thread = pid_t(std::atoi(entry->d_name)); thread > 0) all.insert(thread);
  ::closedir(folder);
  return all;
}

std::atomic<bool> stands{false}, may_go_on{false};

/// Runs in the thread that is stopped, wherever it is.
void stand_still(int) {
  stands = true;
  while (!may_go_on) ::usleep(1000);
}

std::atomic<long> waiting_call{-1};

/// Runs in the thread of the ticks in place of a call that can wait.
void note_call(int, siginfo_t* info, void*) { waiting_call = info->si_syscall; }

/// From now on, calls of this thread that can wait raise SIGSYS instead. False: the kernel allows no such rule.
bool forbid_waiting() {
  std::vector<sock_filter> rule{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  const auto forbid = [&](std::initializer_list<long> calls) {
    for (const long call : calls) {
      rule.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, std::uint32_t(call), 0, 1));
      rule.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
    }
  };
  forbid({SYS_socket, SYS_connect, SYS_accept, SYS_accept4, SYS_sendto, SYS_sendmsg, SYS_recvfrom, SYS_recvmsg,
          SYS_read, SYS_readv, SYS_ppoll, SYS_pselect6, SYS_epoll_pwait, SYS_clock_nanosleep, SYS_nanosleep, SYS_fsync,
          SYS_fdatasync});
#ifdef SYS_poll
  forbid({SYS_poll, SYS_select, SYS_epoll_wait});
#endif
  // A lock that another thread holds, but not the wake-up that lets one go.
  rule.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, std::uint32_t(SYS_futex), 0, 4));
  rule.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[1])));
  rule.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, std::uint32_t(FUTEX_CMD_MASK)));
  rule.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, FUTEX_WAKE, 1, 0));
  rule.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  rule.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  const sock_fprog program{static_cast<unsigned short>(rule.size()), rule.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) == 0;
}

class Waiting : public ::testing::Test {
 protected:
  static constexpr double kTick = 1e-3;  // [s]

  Waiting() {
    const std::set<pid_t> before = threads();
    devices::IgtlSettings listening;
    listening.listens = true;
    auto link = devices::IgtlLink::open(listening);
    CTPM_CHECK(bool(link), "a free port on this machine");
    for (const pid_t thread : threads())
      if (!before.contains(thread)) socket_thread_ = thread;
    port_ = (*link)->port();
    devices::DeviceSettings settings;
    settings.map.tool = 0;
    settings.guard.give_up_after = 1e6;
    source_ = std::make_unique<devices::DeviceSource>(std::move(*link), settings, kTick);
  }

  /// Sends poses until the object goes.
  struct Sender {
    explicit Sender(int port)
        : thread([this, port] {
            IgtlPeer peer = IgtlPeer::connect(port);
            while (!is_over && peer.send(transform_bytes({0, 0, 50}))) continue;
          }) {}
    ~Sender() { is_over = true, thread.join(); }
    std::atomic<bool> is_over{false};
    std::thread thread;
  };

  /// So many ticks at once. How many had a pose.
  int tick(int count) {
    int known = 0;
    for (int i = 0; i < count; ++i) {
      stepping::StepReport last;
      last.tool_force = {0, 0, 0.1};
      if (source_->next(i, last)) ++known;
      source_->take_events();
    }
    return known;
  }

  pid_t socket_thread_ = -1;
  int port_ = 0;
  std::unique_ptr<devices::DeviceSource> source_;
};

TEST_F(Waiting, TicksGoOnWhileTheThreadOfTheSocketStandsStill) {
  ASSERT_GT(socket_thread_, 0);
  struct sigaction action {};
  action.sa_handler = stand_still, action.sa_flags = SA_RESTART;
  ASSERT_EQ(::sigaction(SIGUSR2, &action, nullptr), 0);
  const Sender flood(port_);
  ASSERT_TRUE(source_->wait_for_first_pose([] { return false; }));
  stands = may_go_on = false;
  ASSERT_EQ(::syscall(SYS_tgkill, ::getpid(), socket_thread_, SIGUSR2), 0);
  while (!stands) std::this_thread::yield();
  // More than what waits in the buffers between the two threads, in both directions.
  EXPECT_EQ(tick(20000), 20000);
  EXPECT_FALSE(may_go_on);
  may_go_on = true;
  // It goes on where it was.
  ASSERT_TRUE(source_->wait_for_first_pose([] { return false; }));
}

TEST_F(Waiting, NoTickMakesACallThatCanWaitInAnyFlood) {
  struct sigaction action {};
  action.sa_sigaction = note_call, action.sa_flags = SA_SIGINFO;
  ASSERT_EQ(::sigaction(SIGSYS, &action, nullptr), 0);
  const Sender flood(port_);
  ASSERT_TRUE(source_->wait_for_first_pose([] { return false; }));
  std::atomic<bool> is_over{false};
  std::thread scan([&] {  // and connections that come and go
    while (!is_over) IgtlPeer::connected(port_);
  });
  waiting_call = -1;
  bool is_forbidden = false;
  int known = 0;
  long known_call = -1;
  std::thread ticks([&] {
    is_forbidden = forbid_waiting();
    if (!is_forbidden) return;
    known = tick(100000);
    known_call = waiting_call.exchange(-1);
    ::usleep(1);  // the rule holds
  });
  ticks.join();
  is_over = true;
  scan.join();
  if (!is_forbidden) GTEST_SKIP() << "the kernel allows no rule for system calls here";
  EXPECT_NE(waiting_call, -1) << "a call that waits is seen";
  EXPECT_EQ(known_call, -1) << "the number of the call that a tick made";
  EXPECT_EQ(known, 100000);
}

}  // namespace
}  // namespace ctpm
