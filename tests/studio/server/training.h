#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/studio/server/serving.h"

namespace ctpm::testing {

/// A folder with the scene of a kidney, for sessions that a client leads.
class TrainingTest : public ::testing::Test {
 protected:
  TrainingTest() {
    std::filesystem::create_directories(folder_.path() / "organs");
    std::filesystem::copy(std::filesystem::path(CTPM_SOURCE_DIR) / "scenes/kidney.json",
                          folder_.path() / "kidney.json");
    std::filesystem::copy(std::filesystem::path(CTPM_SOURCE_DIR) / "scenes/organs/kidney.obj",
                          folder_.path() / "organs/kidney.obj");
  }
  nlohmann::json info_of(const std::string& file) {
    return nlohmann::json::parse(run_ctpm({"info", file, "--json"}, folder_.path()).out);
  }

  TemporaryFolder folder_;
};

/// Holds the ball at a place until ticks are done with it there, however long a slow machine takes to begin with them.
/// Returns the time of the last pose.
inline double stand_until_ticks(SocketClient& client, const nlohmann::json& position) {
  for (double time = 100;; time += 0.008) {
    client.send({{"hand", {{"position", position}, {"orientation", {1, 0, 0, 0}}, {"buttons", 1}, {"time_s", time}}}});
    std::this_thread::sleep_for(std::chrono::milliseconds(8));
    while (client.has_news()) {
      const auto message = client.receive();
      const bool is_frame = !message.is_text && value_at<std::uint32_t>(message.bytes, 0) == 2;
      if (is_frame && value_at<double>(message.bytes, 32) > 0) return time;
    }
  }
}

/// Holds the ball for `ticks` of 8 ms on its way down onto the organ. The messages are sent `at_once` many together,
/// each with the time at which a hand was there.
inline void press(SocketClient& client, const nlohmann::json& view, int ticks, int at_once) {
  const double x = 0.5 * (view["least"][0].get<double>() + view["most"][0].get<double>());
  const double y = 0.5 * (view["least"][1].get<double>() + view["most"][1].get<double>());
  const double top = view["most"][2].get<double>() + 0.02;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < ticks; ++i) {
    if (i % at_once == 0) std::this_thread::sleep_until(begin + std::chrono::milliseconds(8 * (i + at_once - 1)));
    const double z = top - 0.03 * (1 - std::cos(3.14159 * i / ticks)) / 2;
    client.send(
        {{"hand",
          {{"position", {x, y, z}}, {"orientation", {1, 0, 0, 0}}, {"buttons", 1}, {"time_s", 100 + 0.008 * i}}}});
  }
}

/// The content of the next event of that name.
inline nlohmann::json event_of(SocketClient& client, const std::string& name, int* live_frames = nullptr) {
  for (;;) {
    const auto message = client.receive();
    if (!message.is_text) {
      if (live_frames && value_at<std::uint32_t>(message.bytes, 0) == 2)
        *live_frames += (value_at<std::uint32_t>(message.bytes, 20) & 2u) != 0;
      continue;
    }
    const nlohmann::json json = nlohmann::json::parse(message.bytes);
    if (json.value("event", "") == name) return json["content"];
  }
}

}  // namespace ctpm::testing
