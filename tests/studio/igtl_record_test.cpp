// `ctpm record` with a device, from outside: the device's side is OpenIGTLink's own classes. Nothing is asserted about time.

#include <gtest/gtest.h>
#include <openigtlink/igtlServerSocket.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/studio/igtl_client.h"
#include "tests/studio/running_program.h"

namespace ctpm {
namespace {

using testing::IgtlPeer;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::RunningProgram;
using testing::sensor_bytes;
using testing::TemporaryFolder;
using testing::transform_bytes;

/// The device's frame lies 30 mm over the table; the block's uppermost spheres are touched at -6 mm in it.
const Vec3 kHome{0, 0, 0};

class IgtlRecord : public ::testing::Test {
 protected:
  IgtlRecord() {
    std::ofstream(folder_.path() / "block.json") << R"({"format": "ctpm-scene", "version": 1, "name": "block",
      "settle_s": 0, "organs": [{"name": "block", "rig": {"block": [3, 3, 2]}, "material": {"preset": "liver"},
      "anchors": [{"lowest_mm": 1}]}], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8},
      {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 30}]})";
  }
  std::vector<std::string> listening(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"record", "block.json", "-o", "a.ctpm", "--igtl-listen", "0",
                                       "--device-offset-mm", "0", "0", "30"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  static int port_of(RunningProgram& program) {
    return std::atoi(program.wait_for("waiting for a device on 127.0.0.1:").c_str());
  }
  std::string ctpm(const std::vector<std::string>& arguments, int code = 0) {
    const ProgramOutcome outcome = run_ctpm(arguments, folder_.path());
    EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
    return outcome.out;
  }
  static bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
  /// A number of `ctpm info --json`.
  static double number(const std::string& info, const std::string& key) {
    const std::size_t at = info.find("\"" + key + "\":");
    EXPECT_NE(at, std::string::npos) << key << " is not in: " << info;
    return at == std::string::npos ? 0 : std::atof(info.c_str() + at + key.size() + 3);
  }

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
    EXPECT_TRUE(holds(outcome.err, "a.ctpm: error: the device was lost: nothing usable came for 2.0 s (it hung up); "
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

  TemporaryFolder folder_;
};

TEST_F(IgtlRecord, AClientAtAThousandPosesASecondIsRecordedWholeAndFeelsTheTissue) { a_whole_session_is_recorded(3); }

class IgtlRecordSlow : public IgtlRecord {};
TEST_F(IgtlRecordSlow, AClientAtAThousandPosesASecondIsRecordedWholeFor20Seconds) { a_whole_session_is_recorded(20); }

}  // namespace
}  // namespace ctpm
