#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/studio/commands/running_program.h"
#include "tests/studio/devices/igtl_client.h"

namespace ctpm::testing {

/// The device's frame lies 30 mm over the table; the block's uppermost spheres are touched at -6 mm in it.
inline const Vec3 kHome{0, 0, 0};

/// `ctpm record` of a block, which waits for a device.
class IgtlRecord : public ::testing::Test {
 protected:
  IgtlRecord() {
    std::ofstream(folder_.path() / "block.json") << R"({"format": "ctpm-scene", "version": 1, "name": "block",
      "settle_s": 0, "organs": [{"name": "block", "rig": {"block": [3, 3, 2]}, "material": {"preset": "liver"},
      "anchors": [{"lowest_mm": 1}]}], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8},
      {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 30}]})";
  }
  std::vector<std::string> listening(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"record", "block.json",         "-o", "a.ctpm", "--igtl-listen",
                                       "0",      "--device-offset-mm", "0",  "0",      "30"};
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

  TemporaryFolder folder_;
};

/// Sends the same pose at 1 kHz for a while, so that a device that was away is back.
inline void stay(IgtlPeer& peer, Vec3 position_mm = kHome, int milliseconds = 350) {
  for (int i = 0; i < milliseconds; ++i) {
    if (!peer.send(transform_bytes(position_mm))) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace ctpm::testing
