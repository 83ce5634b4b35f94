// Devices that fail and devices that vanish, from outside: `ctpm record` goes on, and a good device is believed within
// a second of the session.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "recordings/session_reader.h"
#include "tests/studio/devices/igtl_record.h"

namespace ctpm {
namespace {

using testing::IgtlPeer;
using testing::kHome;
using testing::ProgramOutcome;
using testing::RunningProgram;
using testing::stay;
using testing::transform_bytes;

using Clock = std::chrono::steady_clock;

constexpr std::size_t kKinds = 14;  ///< of faults

/// Where the device stands behind fault `i`, so that the session shows when it was believed again.
Vec3 place_behind(int i) { return kHome + Vec3{0, 0, 0.5 * (i + 1)}; }

class IgtlFaults : public testing::IgtlRecord {
 protected:
  void faults_are_forgiven(const std::vector<std::size_t>& kinds);
  void expect_forgiven_within_a_second(const std::vector<double>& lasted);
};

/// Between the places behind two faults, no pose was older than the fault lasted [s] and a second, in the session's
/// ticks.
void IgtlFaults::expect_forgiven_within_a_second(const std::vector<double>& lasted) {
  auto reader = recordings::SessionReader::open((folder_.path() / "a.ctpm").string());
  ASSERT_TRUE(reader);
  const auto records = reader->ticks(0, reader->tick_count());
  ASSERT_TRUE(records);
  const double home = records->front().inputs.position.z;
  std::size_t fault = 0;
  double oldest = 0, worst = 0;
  for (const recordings::TickRecord& record : *records) {
    if (fault == lasted.size()) break;
    oldest = record.input_age > 0.05 ? oldest + 1e-3 : 0;
    worst = std::max(worst, oldest - lasted[fault]);
    EXPECT_LT(oldest, lasted[fault] + 1) << "fault " << fault;
    if (record.inputs.position.z - home > 1e-3 * (place_behind(int(fault)).z - 0.25)) ++fault;
  }
  EXPECT_EQ(fault, lasted.size()) << "each was followed by the pose behind it";
  std::printf("%zu faults: good poses were believed %.3f s behind their end at the latest\n", fault, worst);
}

/// One session with faults of a device of these kinds, one after the other. Behind each the device is good again for a
/// second or more, and what is there of the session verifies.
void IgtlFaults::faults_are_forgiven(const std::vector<std::size_t>& kinds) {
  RunningProgram program(listening({"--overwrite"}), folder_.path());
  const int port = port_of(program);
  ASSERT_GT(port, 0);
  auto peer = std::make_unique<IgtlPeer>(port);
  Vec3 at = kHome;
  stay(*peer);
  const auto reconnect = [&] {
    peer.reset();  // while this one sends poses, another is turned away
    peer = std::make_unique<IgtlPeer>(port);
  };
  const auto send = [&](const std::string& bytes) { peer->send(bytes); };
  const auto pose = [&] { return transform_bytes(at); };
  const auto with_size = [&](const char* kind, char highest) {
    std::string bytes = pose().substr(0, 58);
    bytes.replace(2, 12, std::string(kind) + std::string(12 - std::string(kind).size(), '\0'));
    bytes[46] = highest;  // of the lower four bytes of the body's size
    return bytes;
  };
  const auto broken = [&] {
    std::string bytes = pose();
    bytes[90] = char(bytes[90] ^ 4);
    return bytes;
  };
  igtl::ClientSocket::Pointer silent;
  const std::vector<std::function<void()>> faults{
      [&] {
        send(transform_bytes({NAN, 0, 0}));
      },
      [&] {
        send(transform_bytes({-3.7e28, -3.7e28, -3.7e28}));
      },
      [&] {
        send(transform_bytes({500, 0, 0}));
      },
      [&] { send(transform_bytes(at, 3e9)); },
      [&] { send(transform_bytes(at, 1)); },
      [&] { send(broken()); },
      [&] { send(with_size("TRANSFORM", '\x7f')); },
      [&] { send(with_size("IMAGE", '\x7f')); },
      [&] { send(std::string(200, 'x')), peer->wait_for_end(), reconnect(); },
      [&] { send(pose().substr(0, 70)), reconnect(); },
      [&] { std::this_thread::sleep_for(std::chrono::milliseconds(300)); },
      [&] {  // a port scan
        std::thread scan([&] {
          for (int i = 0; i < 30; ++i) igtl::ClientSocket::New()->ConnectToServer("127.0.0.1", port);
        });
        stay(*peer, at, 300);
        scan.join();
      },
      [&] {  // a flood
        for (int i = 0; i < 20000; ++i) send(pose());
      },
      [&] {  // the device leaves, and something silent that stays takes its place first
        peer.reset();
        silent = IgtlPeer::connected(port);
        reconnect();
      },
  };
  ASSERT_EQ(faults.size(), kKinds);
  std::vector<double> lasted;
  for (int i = 0; i < int(kinds.size()); ++i) {
    send(pose());
    const Clock::time_point began = Clock::now();
    faults[kinds[std::size_t(i)]]();
    lasted.push_back(std::chrono::duration<double>(Clock::now() - began).count());
    at = place_behind(i);
    std::atomic<bool> is_verified{false};
    std::thread device([&] {
      do stay(*peer, at, 1000);
      while (!is_verified);
    });
    const std::string verdict = ctpm({"verify", "a.ctpm"});
    is_verified = true;
    device.join();
    EXPECT_TRUE(holds(verdict, "same: ")) << "after fault " << i << ": " << verdict;
    ASSERT_TRUE(peer->send(pose())) << "turned away after fault " << i;
  }
  program.interrupt();
  const ProgramOutcome outcome = program.outcome();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  expect_forgiven_within_a_second(lasted);
  EXPECT_EQ(number(ctpm({"info", "a.ctpm", "--json"}), "max_force_n"), 0) << "the tool never came near the tissue";
  EXPECT_LT(program.most_memory(), 500l << 20);
  EXPECT_TRUE(holds(ctpm({"verify", "a.ctpm"}), "same"));
}

TEST_F(IgtlFaults, EachKindOfFaultIsForgivenWithinASecond) {
  std::vector<std::size_t> kinds(kKinds);
  std::iota(kinds.begin(), kinds.end(), std::size_t{0});
  faults_are_forgiven(kinds);
}

class IgtlFaultsSlow : public IgtlFaults {};
TEST_F(IgtlFaultsSlow, FiftyFaultsAreEachForgivenWithinASecond) {
  // A session grows while it is verified, so ten faults are enough for one.
  std::uint64_t random = 7;
  for (int session = 0; session < 5; ++session) {
    std::vector<std::size_t> kinds;
    for (int i = 0; i < 10; ++i) {
      random = random * 6364136223846793005ull + 1442695040888963407ull;
      kinds.push_back(std::size_t(random >> 33) % kKinds);
    }
    faults_are_forgiven(kinds);
    if (HasFatalFailure()) return;
  }
}

/// A device that was followed and then is silent for good, while its connection stays: a computer that hangs.
TEST_F(IgtlFaults, ADeviceThatHangsIsDisplacedByTheNextAndThatIsNoted) {
  RunningProgram program(listening(), folder_.path());
  const int port = port_of(program);
  ASSERT_GT(port, 0);
  const pid_t device = ::fork();
  if (device == 0) {
    const igtl::ClientSocket::Pointer socket = IgtlPeer::connected(port);
    for (int i = 0; i < 300; ++i) {
      const std::string bytes = transform_bytes(kHome);
      socket->Send(bytes.data(), int(bytes.size()));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::raise(SIGSTOP);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(device, &status, WUNTRACED), device);
  ASSERT_TRUE(WIFSTOPPED(status));
  const Clock::time_point began = Clock::now();
  // While it counts as there, others are turned away at once; they come back, as devices do.
  std::unique_ptr<IgtlPeer> next;
  for (int sent = 0; sent < 1000;) {
    if (!next) next = std::make_unique<IgtlPeer>(port);
    if (next->send(transform_bytes(place_behind(0))))
      ++sent;
    else
      next.reset(), sent = 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const double lasted = std::chrono::duration<double>(Clock::now() - began).count() - 1;
  program.interrupt();
  const ProgramOutcome outcome = program.outcome();
  ::kill(device, SIGKILL);
  ::waitpid(device, nullptr, 0);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(
      holds(ctpm({"info", "a.ctpm", "--json"}), "it was silent, and another device that sends poses took its place"));
  EXPECT_TRUE(holds(ctpm({"verify", "a.ctpm"}), "same: "));
  expect_forgiven_within_a_second({lasted});
}

/// An interface of this machine, in a network of the process's own.
class OwnNetwork {
 public:
  /// False: the machine gives processes no networks of their own.
  bool enter() {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWNET) != 0) return false;
    socket_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    return set_up("lo", nullptr) && set_up("lo:1", "10.7.7.7");
  }
  /// What was sent from 10.7.7.7 stays unanswered, and nothing reaches it: the device lost its power.
  bool cut_off() {
    ifreq request = named("lo:1");
    return ::ioctl(socket_, SIOCSIFFLAGS, &request) == 0;  // no flags: down
  }

 private:
  static ifreq named(const char* name) {
    ifreq request{};
    std::strcpy(request.ifr_name, name);
    return request;
  }
  bool set_up(const char* name, const char* address) {
    ifreq request = named(name);
    if (address) {
      auto& at = reinterpret_cast<sockaddr_in&>(request.ifr_addr);
      at.sin_family = AF_INET;
      ::inet_pton(AF_INET, address, &at.sin_addr);
      if (::ioctl(socket_, SIOCSIFADDR, &request) != 0) return false;
    }
    request = named(name);
    request.ifr_flags = IFF_UP | IFF_RUNNING;
    return ::ioctl(socket_, SIOCSIFFLAGS, &request) == 0;
  }
  int socket_ = -1;
};

/// A connection from 10.7.7.7 to `port` of this machine.
int connect_from_there(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in from{}, to{};
  from.sin_family = to.sin_family = AF_INET;
  ::inet_pton(AF_INET, "10.7.7.7", &from.sin_addr), ::inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  to.sin_port = htons(std::uint16_t(port));
  if (::bind(socket, reinterpret_cast<sockaddr*>(&from), sizeof from) != 0 ||
      ::connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
    return -1;
  return socket;
}

class IgtlHalfOpen : public IgtlFaults {
 protected:
  static constexpr int kNoNetwork = 77;

  /// In a process of its own, whose exit code says what failed.
  int lose_a_device_without_a_word() {
    OwnNetwork network;
    if (!network.enter()) return kNoNetwork;
    RunningProgram program(listening({"--device-timeout-s", "60"}), folder_.path());
    const int port = port_of(program), device = connect_from_there(port);
    if (device < 0) return 2;
    const std::string bytes = transform_bytes(kHome);
    for (int i = 0; i < 500; ++i) {
      if (::send(device, bytes.data(), bytes.size(), MSG_NOSIGNAL) <= 0) return 3;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    // Every force that was sent is acknowledged: nothing of the program's waits for an answer.
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    if (!network.cut_off()) return 4;
    // The kernel of the dead machine says no more. That the connection is dead comes from the program's own probes.
    bool is_noted = false;
    for (int i = 0; i < 60 && !is_noted; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      is_noted = holds(testing::run_ctpm({"info", "a.ctpm"}, folder_.path()).out, "it hung up; the pose is held");
    }
    if (!is_noted) return 5;
    IgtlPeer next(port);
    stay(next, kHome, 1000);
    if (!next.send(bytes)) return 6;
    program.interrupt();
    return program.outcome().code == 0 ? 0 : 7;
  }
};

TEST_F(IgtlHalfOpen, ADeviceThatLosesItsPowerIsNoticedThoughNothingIsSentAndTheNextOneIsTaken) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(lose_a_device_without_a_word());
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNoNetwork) GTEST_SKIP() << "this machine gives processes no networks of their own";
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const std::string info = ctpm({"info", "a.ctpm"});
  EXPECT_TRUE(holds(info, "good poses come again; the pose was held for ")) << info;
  EXPECT_TRUE(holds(ctpm({"verify", "a.ctpm"}), "same: "));
}

}  // namespace
}  // namespace ctpm
