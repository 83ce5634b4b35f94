// `ctpm record` with a device, from outside: the device's side is OpenIGTLink's own classes. Nothing is asserted about
// time.

#include <gtest/gtest.h>
#include <openigtlink/igtlServerSocket.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "recordings/session_reader.h"
#include "tests/studio/commands/running_program.h"
#include "tests/studio/devices/igtl_record.h"

namespace ctpm {
namespace {

using testing::IgtlPeer;
using testing::kHome;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::RunningProgram;
using testing::sensor_bytes;
using testing::stay;
using testing::TemporaryFolder;
using testing::transform_bytes;

class IgtlRecord : public testing::IgtlRecord {
 protected:
  /// Sends poses at 1 kHz for `seconds`, pressing up and down on the block once a second. Returns how many.
  static int press_for(IgtlPeer& peer, double seconds) {
    auto deadline = std::chrono::steady_clock::now();
    const int count = int(seconds * 1000);
    for (int i = 0; i < count; ++i, deadline += std::chrono::milliseconds(1)) {
      std::this_thread::sleep_until(deadline);
      const double depth = 6 - 6 * std::cos(i * 2 * 3.14159265358979 / 1000);  // 0 to 12 mm
      if (!peer.send(transform_bytes({0, 0, -depth}, 1000 + i * 1e-3))) return i;
    }
    return count;
  }

  void a_whole_session_is_recorded(double seconds) {
    RunningProgram program(listening({"--device-timeout-s", "2"}), folder_.path());
    const int port = port_of(program);
    ASSERT_GT(port, 0);
    int sent = 0;
    double most_force = 0;
    {
      IgtlPeer peer = IgtlPeer::connect(port);
      sent = press_for(peer, seconds);
      ASSERT_EQ(sent, int(seconds * 1000));
      peer.hang_up();
      EXPECT_EQ(peer.wrong_messages(), 0);
      EXPECT_GT(peer.forces().size(), 10u);
      for (const Vec3& force : peer.forces()) most_force = std::max(most_force, norm(force));
    }
    EXPECT_GT(most_force, 0.05);
    EXPECT_LE(most_force, 3 * (1 + 1e-12));
    // A device that leaves for good ends the session; that it was lost is said, and everything is saved.
    const ProgramOutcome outcome = program.outcome();
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_TRUE(holds(outcome.err,
                      "a.ctpm: error: the device was lost: nothing usable came for 2.0 s (it hung up); "
                      "what came before is saved"))
        << outcome.err;
    EXPECT_TRUE(holds(outcome.out, "input age p50")) << outcome.out;

    const std::string info = ctpm({"info", "a.ctpm", "--json"});
    EXPECT_TRUE(holds(info, "\"ended_cleanly\": true")) << info;
    EXPECT_EQ(number(info, "device_samples"), sent);
    EXPECT_EQ(number(info, "device_samples_refused"), 0);
    EXPECT_GE(number(info, "device_forces_sent"), 10);
    EXPECT_GT(number(info, "input_age_p99_s"), 0);
    EXPECT_GT(number(info, "max_force_n"), 0.05);
    EXPECT_TRUE(holds(info, "it hung up; the pose is held")) << info;
    const std::string verdict = ctpm({"verify", "a.ctpm"});
    EXPECT_TRUE(holds(verdict, "same")) << verdict;
    EXPECT_TRUE(holds(verdict, std::to_string(int(number(info, "ticks"))))) << verdict;
  }
};

TEST_F(IgtlRecord, AClientAtAThousandPosesASecondIsRecordedWholeAndFeelsTheTissue) { a_whole_session_is_recorded(3); }

TEST_F(IgtlRecord, EveryFaultIsHeldAndNotedAndTheSessionGoesOnToACleanEnd) {
  RunningProgram program(listening(), folder_.path());
  const int port = port_of(program);
  ASSERT_GT(port, 0);
  {
    IgtlPeer peer = IgtlPeer::connect(port);
    stay(peer);
    peer.send(transform_bytes({NAN, 0, 0}));
    stay(peer);
    peer.send(transform_bytes({50, 0, 0}));
    stay(peer);
    peer.send(transform_bytes(kHome, 2000));
    peer.send(transform_bytes(kHome, 1999));
    stay(peer);
    std::string broken = transform_bytes(kHome);
    broken[90] = char(broken[90] ^ 4);
    peer.send(broken);
    stay(peer);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    stay(peer);
    peer.send(std::string(200, 'x'));  // garbage: the program hangs up
    peer.wait_for_end();
  }
  {
    IgtlPeer peer = IgtlPeer::connect(port);
    stay(peer);
    peer.send(transform_bytes(kHome).substr(0, 70));  // half a message, and gone
  }
  {
    IgtlPeer peer = IgtlPeer::connect(port);
    stay(peer);
    std::string huge = transform_bytes(kHome);
    huge[42] = '\x7f';  // the highest byte of the body's size
    peer.send(huge);
    peer.wait_for_end();
  }
  IgtlPeer peer = IgtlPeer::connect(port);
  stay(peer);
  program.interrupt();
  const ProgramOutcome outcome = program.outcome();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(program.most_memory(), 500l << 20);

  const std::string info = ctpm({"info", "a.ctpm", "--json"});
  EXPECT_TRUE(holds(info, "\"ended_cleanly\": true"));
  std::size_t at = 0;
  for (const std::string fault :
       {"pose is not finite", "jumps farther than a hand moves", "time goes backwards",
        "a message with a wrong checksum", "nothing usable comes", "what it sends is not OpenIGTLink", "it hung up",
        "what it sends is not OpenIGTLink"}) {
    const std::size_t lost = info.find("\"" + fault + "; the pose is held\"", at);
    ASSERT_NE(lost, std::string::npos) << fault << " is not, or not in its place, in " << info;
    at = info.find("\"device back\"", lost);
    ASSERT_NE(at, std::string::npos) << "no way back from: " << fault;
  }
  EXPECT_EQ(number(info, "max_force_n"), 0);  // the tool stood where it was all the while
  EXPECT_TRUE(holds(ctpm({"verify", "a.ctpm"}), "same"));
}

TEST_F(IgtlRecord, ASecondClientIsTurnedAwayAndTheFirstOneStays) {
  RunningProgram program(listening(), folder_.path());
  const int port = port_of(program);
  ASSERT_GT(port, 0);
  IgtlPeer first = IgtlPeer::connect(port);
  stay(first);
  {
    IgtlPeer second = IgtlPeer::connect(port);
    second.wait_for_end();
    EXPECT_TRUE(second.forces().empty());
  }
  stay(first);
  program.interrupt();
  EXPECT_EQ(program.outcome().code, 0);
  first.wait_for_end();
  EXPECT_FALSE(first.forces().empty());
  EXPECT_EQ(first.forces().back(), Vec3{});  // no hand is left with a force
  EXPECT_TRUE(holds(ctpm({"info", "a.ctpm", "--json"}), "a second device came and was turned away"));
}

TEST_F(IgtlRecord, APortInUseAndANobodyAreToldAtOnceAndNothingIsWritten) {
  RunningProgram program(listening(), folder_.path());
  const int port = port_of(program);
  ASSERT_GT(port, 0);
  const TemporaryFolder other;
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
    const ProgramOutcome outcome = run_ctpm(arguments, other.path());
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_TRUE(holds(outcome.err, part)) << outcome.err;
    EXPECT_EQ(other.list(), "");
  };
  const std::string scene = (folder_.path() / "block.json").string(), number = std::to_string(port);
  refused({"record", scene, "-o", "b.ctpm", "--igtl-listen", number},
          "127.0.0.1:" + number + ": error: the port is in use");
  program.interrupt();
  const ProgramOutcome stopped = program.outcome();
  EXPECT_EQ(stopped.code, 2);
  EXPECT_TRUE(holds(stopped.err, "stopped before a pose came; nothing was recorded")) << stopped.err;
  EXPECT_EQ(folder_.list(), "block.json");
  refused({"record", scene, "-o", "b.ctpm", "--igtl", "127.0.0.1:" + number}, "cannot connect: Connection refused");
  refused(
      {"record", scene, "-o", "b.ctpm", "--igtl-listen", "0", "--igtl-bind", "192.0.2.1", "--igtl-allow", "192.0.2.7"},
      "cannot listen here");
  refused({"record", scene, "-o", "b.ctpm", "--igtl-listen", "0", "--igtl-bind", "0.0.0.0"},
          "--igtl-allow: error: name the addresses that may connect");
  refused({"record", scene, "-o", "b.ctpm", "--igtl-listen", "0", "--igtl-second-listen", "0"},
          "--igtl-second: error: the scene has one hand");
}

TEST_F(IgtlRecord, WhileAnotherDeviceThanTheNamedOneSendsItsNameIsSaid) {
  RunningProgram program(listening({"--igtl-name", "Stylus"}), folder_.path());
  const int port = port_of(program);
  ASSERT_GT(port, 0);
  IgtlPeer peer = IgtlPeer::connect(port);
  EXPECT_TRUE(program.wait_until([&] {
    (void)peer.send(transform_bytes(kHome, 0, "Probe"));
    return holds(testing::slurp(folder_.path() / ".stderr"),
                 "poses of 'Probe' come, and another device is asked for\n");
  }));
  stay(peer);
  program.interrupt();
  EXPECT_EQ(program.outcome().code, 0);
}

TEST_F(IgtlRecord, ADeviceThatSendsMetresIsToldOfWhileItIsRecordedAndInTheSession) {
  RunningProgram program(listening(), folder_.path());
  const int port = port_of(program);
  ASSERT_GT(port, 0);
  IgtlPeer peer = IgtlPeer::connect(port);
  const std::string warning = "warning: all places of the hand so far lie within 2 mm of the device's origin";
  int sent = 0;
  EXPECT_TRUE(program.wait_until([&] {
    (void)peer.send(transform_bytes({0, 0, 0.1 * std::sin(0.01 * ++sent)}));
    return holds(testing::slurp(folder_.path() / ".stderr"), warning);
  }));
  program.interrupt();
  EXPECT_EQ(program.outcome().code, 0);
  EXPECT_TRUE(holds(ctpm({"info", "a.ctpm"}), "a device that sends metres needs a scale of 1000"));
}

TEST_F(IgtlRecord, OptionsOfADeviceAreRefusedWhereNoneIsAskedFor) {
  const ProgramOutcome outcome = run_ctpm({"record", "block.json", "-o", "a.ctpm", "--fast", "--device-tool", "ball",
                                           "--igtl-name", "Stylus", "--device-second-tip", "0", "0", "1"},
                                          folder_.path());
  EXPECT_EQ(outcome.code, 2) << outcome.out;
  for (const char* flag : {"--device-tool", "--igtl-name", "--device-second-tip"})
    EXPECT_TRUE(holds(outcome.err, std::string(flag) + ": error: is of a device, and none is asked for"))
        << outcome.err;
  EXPECT_EQ(folder_.list(), "block.json");
}

TEST_F(IgtlRecord, WhatIsWrongWithADevicesOptionsIsToldAtOnce) {
  const ProgramOutcome outcome = run_ctpm(
      listening({"--igtl", "nowhere", "--fast", "--device-button", "40=ball", "--device-scale", "0",
                 "--device-rotation", "0", "0", "0", "0", "--device-tip", "0", "nan", "0", "--device-timeout-s", "0"}),
      folder_.path());
  EXPECT_EQ(outcome.code, 2);
  for (const std::string part :
       {"takes one of --script", "--fast: error: a device is followed in real time",
        "--igtl: error: got 'nowhere', must be HOST:PORT", "--device-button: error: got '40=ball'",
        "--device-scale: error:", "--device-rotation: error:", "--device-tip: error:", "--device-timeout-s: error:"})
    EXPECT_TRUE(holds(outcome.err, part)) << part << " is not in: " << outcome.err;
  const ProgramOutcome tools =
      run_ctpm(listening({"--device-tool", "saw", "--device-button", "1=spoon"}), folder_.path());
  EXPECT_EQ(tools.code, 2);
  EXPECT_TRUE(holds(tools.err, "--device-tool: error: the scene has no tool 'saw' (its tools: ball, scalpel)"));
  EXPECT_TRUE(holds(tools.err, "--device-button: error: the scene has no tool 'spoon'")) << tools.err;
  EXPECT_EQ(folder_.list(), "block.json");
}

TEST_F(IgtlRecord, AServerIsConnectedToCalledAgainAndTakesOverFromAnotherSession) {
  std::ofstream(folder_.path() / "press.json") << R"({"format": "ctpm-script", "version": 1, "steps": [
      {"take": {"tool": "ball", "at_mm": [0, 0, 25]}}, {"press": {"distance_mm": 5, "speed_mm_per_s": 10}}]})";
  ctpm({"record", "block.json", "--script", "press.json", "-o", "parent.ctpm", "--fast"});
  igtl::ServerSocket::Pointer server = igtl::ServerSocket::New();
  ASSERT_EQ(server->CreateServer(0), 0);
  const std::string place = "localhost:" + std::to_string(server->GetServerPort());
  RunningProgram program({"record", "--continue", "parent.ctpm", "--at", "0.6", "-o", "a.ctpm", "--igtl", place,
                          "--device-offset-mm", "0", "0", "20", "--device-button", "0=scalpel"},
                         folder_.path());
  {
    igtl::ClientSocket::Pointer socket = server->WaitForConnection(20000);
    ASSERT_TRUE(socket.IsNotNull());
    IgtlPeer peer(socket);
    stay(peer);
  }
  igtl::ClientSocket::Pointer socket = server->WaitForConnection(20000);
  ASSERT_TRUE(socket.IsNotNull());
  IgtlPeer peer(socket);
  stay(peer);
  peer.send(sensor_bytes({1}));
  stay(peer);
  program.interrupt();
  const ProgramOutcome outcome = program.outcome();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string info = ctpm({"info", "a.ctpm", "--json"});
  EXPECT_TRUE(holds(info, "\"source\": \"igtl\"")) << info;
  EXPECT_TRUE(holds(info, "\"parent_tick\": \"600\"")) << info;
  EXPECT_GT(number(info, "max_force_n"), 0.05);  // it began in the dent that the parent had pressed
  EXPECT_TRUE(holds(ctpm({"verify", "a.ctpm"}), "same"));
  ctpm({"replay", "a.ctpm", "--csv", "a.csv"});
  const std::string table = testing::slurp(folder_.path() / "a.csv");
  EXPECT_TRUE(holds(table, ",ball,"));
  EXPECT_TRUE(holds(table, ",scalpel,"));
}

class IgtlRecordSlow : public IgtlRecord {};
TEST_F(IgtlRecordSlow, AClientAtAThousandPosesASecondIsRecordedWholeFor20Seconds) { a_whole_session_is_recorded(20); }

}  // namespace
}  // namespace ctpm
