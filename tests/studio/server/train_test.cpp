// A session that a client of the protocol leads.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <thread>
#include <utility>

#include "studio/server/page_hand.h"
#include "tests/studio/devices/igtl_client.h"
#include "tests/studio/server/serving.h"
#include "tests/studio/server/training.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::Serving;
using testing::SocketClient;
using testing::value_at;

using testing::event_of;
using testing::press;
using testing::TrainingTest;

TEST_F(TrainingTest, WhatTheHandDidIsRecordedAndReplaysToTheBit) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json begun =
      client.call("train.begin", {{"scene", "kidney.json"}, {"output", "mine.ctpm"}, {"stage", 2}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  press(client, begun["result"]["view"], 200, 1);
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  int live_frames = 0;
  const nlohmann::json ended = event_of(client, "train_ended", &live_frames);
  EXPECT_EQ(ended["path"], "mine.ctpm") << ended;
  EXPECT_TRUE(ended["errors"].empty()) << ended;
  EXPECT_GT(ended["max_force_n"].get<double>(), 0.05) << ended;
  EXPECT_GT(live_frames, 10);

  const testing::ProgramOutcome verdict = testing::run_ctpm({"verify", "mine.ctpm"}, folder_.path());
  EXPECT_EQ(verdict.code, 0) << verdict.out << verdict.err;
  const nlohmann::json info = info_of("mine.ctpm");
  EXPECT_EQ(info["metadata"]["source"], "studio");
  EXPECT_TRUE(info["ended_cleanly"].get<bool>());
  EXPECT_EQ(info["ticks"], ended["ticks"]);
  EXPECT_EQ(info["values"]["device_samples_refused"], 0);
  // The same name is not used twice.
  EXPECT_NE(client.call("train.begin", {{"scene", "kidney.json"}, {"output", "mine.ctpm"}, {"stage", 2}})
                .dump()
                .find("exists already"),
            std::string::npos);
}

TEST_F(TrainingTest, APageLeadsNoBallThroughAnOrgan) {
  for (const char* name : {"liver.json", "organs/liver.obj"})
    fs::copy(fs::path(CTPM_SOURCE_DIR) / "scenes" / name, folder_.path() / name);
  struct Case {
    const char* scene;
    double x, y, top, force_n, least_m, most_m;  // of the surface below the hand; where it gives way
  };
  for (const Case& one : {Case{"kidney.json", -0.015, 0, 0.056, 15, 0.018, 0.025},
                          Case{"liver.json", -0.045, 0.03, 0.106, 15, 0.024, 0.024}}) {
    const Serving serving(folder_.path());
    SocketClient client(serving);
    const std::string file = std::string(one.scene) + ".ctpm";
    const nlohmann::json begun = client.call("train.begin", {{"scene", one.scene}, {"output", file}, {"stage", 2}});
    ASSERT_TRUE(begun.contains("result")) << begun;
    EXPECT_EQ(begun["result"]["gives_way"]["force_n"], one.force_n);
    const double depth_m = begun["result"]["gives_way"]["depth_m"];
    EXPECT_GE(depth_m, one.least_m);  // the kidney is 45 mm thick, the liver is damaged 12 mm deep
    EXPECT_LE(depth_m, one.most_m);
    const double before = testing::stand_until_ticks(client, {one.x, one.y, one.top + 0.01});
    // 0.3 m/s down, right through, and it stands again.
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 150; ++i) {
      std::this_thread::sleep_until(begin + std::chrono::milliseconds(8 * i));
      const double z = one.top + 0.01 - std::min(0.3 * 0.008 * i, one.top);
      client.send({{"hand",
                    {{"position", {one.x, one.y, z}},
                     {"orientation", {1, 0, 0, 0}},
                     {"buttons", 1},
                     {"time_s", before + 0.008 * (i + 1)}}}});
    }
    client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
    const nlohmann::json ended = event_of(client, "train_ended");
    ASSERT_TRUE(ended["errors"].empty()) << ended;
    const double force = ended["max_force_n"], depth = ended["max_depth_m"];
    EXPECT_GT(force, 0.4 * one.force_n) << ended;
    EXPECT_LT(force, 1.1 * one.force_n) << ended;
    EXPECT_LT(depth, depth_m + 5e-3) << ended;
    EXPECT_EQ(testing::run_ctpm({"verify", file}, folder_.path()).code, 0);
  }
}

TEST_F(TrainingTest, TheEndSaysHowLongATickOfTheSceneIs) {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(folder_.path() / "kidney.json"));
  scene["tick_s"] = 0.002;
  std::ofstream(folder_.path() / "slow.json") << scene;
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json begun =
      client.call("train.begin", {{"scene", "slow.json"}, {"output", "slow.ctpm"}, {"stage", 2}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  press(client, begun["result"]["view"], 20, 1);
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  const nlohmann::json ended = event_of(client, "train_ended"), info = info_of("slow.ctpm");
  EXPECT_EQ(ended["tick_s"], 0.002) << ended;
  EXPECT_EQ(info["tick_s"], 0.002);
  EXPECT_NEAR(ended["ticks"].get<double>() * ended["tick_s"].get<double>(), info["duration_s"].get<double>(), 1e-9);
  std::int64_t late = 0;
  for (const auto& [cause, count] : ended["late_by"].items()) late += count.get<std::int64_t>();
  EXPECT_EQ(late, ended["late_ticks"].get<std::int64_t>()) << ended["late_by"];
}

TEST_F(TrainingTest, TwoHandsAreLedAndRecordedAndShown) {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(folder_.path() / "kidney.json"));
  scene["hands"] = 2;
  std::ofstream(folder_.path() / "two.json") << scene;
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json begun =
      client.call("train.begin", {{"scene", "two.json"}, {"output", "two.ctpm"}, {"stage", 2}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  const nlohmann::json view = begun["result"]["view"];
  EXPECT_EQ(view["hands"], 2);
  const auto middle = [&](int axis) {
    return 0.5 * (view["least"][axis].get<double>() + view["most"][axis].get<double>());
  };
  const double top = view["most"][2].get<double>();
  const auto first = std::find_if(view["tools"].begin(), view["tools"].end(),
                                  [](const nlohmann::json& tool) { return tool["kind"] == "ball"; }) -
                     view["tools"].begin();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 150; ++i) {
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(8 * i));
    const double z = top + 0.02 - 0.03 * (1 - std::cos(3.14159 * i / 150)) / 2;
    client.send({{"hand",
                  {{"position", {middle(0), middle(1), z}},
                   {"orientation", {1, 0, 0, 0}},
                   {"buttons", 1 << first},
                   {"time_s", 100 + 0.008 * i},
                   {"second",
                    {{"position", {middle(0) + 0.05, middle(1), top + 0.08}},
                     {"orientation", {1, 0, 0, 0}},
                     {"buttons", 1 << (1 - first)}}}}}});
  }
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  float x = 0;
  for (;;) {
    const auto message = client.receive();
    if (message.is_text && nlohmann::json::parse(message.bytes).value("event", "") == "train_ended") break;
    constexpr std::size_t kSecond = 64;  // bytes at the end of a frame
    if (!message.is_text && value_at<std::uint32_t>(message.bytes, 0) == 2 &&
        value_at<std::int32_t>(message.bytes, message.bytes.size() - kSecond) == 1 - first)
      x = value_at<float>(message.bytes, message.bytes.size() - kSecond + 4);
  }
  EXPECT_NEAR(x, middle(0) + 0.05, 2e-3) << "frames show the second hand's tool";
  EXPECT_EQ(testing::run_ctpm({"verify", "two.ctpm"}, folder_.path()).code, 0);
  const nlohmann::json poses = client.call("session.motion", {{"path", "two.ctpm"}, {"rate_hz", 100}})["result"];
  ASSERT_FALSE(poses["second_poses"].empty());
  EXPECT_EQ(poses["second_poses"].back()[0], 1 - first);
  EXPECT_EQ(info_of("two.ctpm")["values"]["second_device_samples_refused"], 0);
}

TEST_F(TrainingTest, APageThatDoesNotReadFor10SecondsHoldsUpNoTickAndThenSeesTheNewestOne) {
  const Serving serving(folder_.path());
  SocketClient slow(serving), other(serving);
  slow.keep_little();
  const nlohmann::json begun = slow.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  int answers = 0;
  std::atomic<bool> ends{false};
  std::thread goes_on([&] {
    for (; !ends; ++answers) EXPECT_TRUE(other.call("folder.list", nlohmann::json::object()).contains("result"));
  });
  constexpr int kPoses = 1250;  // of 8 ms
  press(slow, begun["result"]["view"], kPoses, 1);
  ends = true;
  goes_on.join();
  EXPECT_GT(answers, 100);  // while it did not read

  // What was on its way still comes; the first frame after it is the newest one, and says how many were left out.
  double before = 0, tick = 0;
  std::uint32_t missed = 0;
  for (int i = 0; missed <= 50 && i < kPoses; ++i) {  // a busy machine leaves out one now and then
    const std::string frame = slow.frame();
    before = std::exchange(tick, value_at<double>(frame, 32)), missed = value_at<std::uint32_t>(frame, 12);
  }
  EXPECT_GT(missed, 50u);
  EXPECT_GT(tick - before, double(missed));  // the ticks went on without a reader
  slow.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  const nlohmann::json ended = event_of(slow, "train_ended");
  EXPECT_TRUE(ended["errors"].empty()) << ended;
  EXPECT_LT(ended["ticks"].get<double>() - tick, 0.5 * (tick - before)) << "it was not the newest one";
}

TEST_F(TrainingTest, WhatNobodyKeepsLeavesNothing) {
  const Serving serving(folder_.path());
  const std::string before = folder_.list();
  SocketClient client(serving);
  const nlohmann::json begun = client.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  press(client, begun["result"]["view"], 30, 1);
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  EXPECT_EQ(event_of(client, "train_ended")["path"], "");
  EXPECT_EQ(folder_.list(), before);
}

/// Threads of this process with that nice value.
int threads_of_urgency(int nice) {
  int count = 0;
  for (const auto& task : fs::directory_iterator("/proc/self/task"))
    count += getpriority(PRIO_PROCESS, id_t(std::stoi(task.path().filename().string()))) == nice;
  return count;
}

TEST_F(TrainingTest, NetworkAndTicksGoBeforeABrowserWhereThatIsAllowed) {
  if (geteuid() != 0) GTEST_SKIP() << "only a privileged user may go before others";
  EXPECT_EQ(threads_of_urgency(-15), 0);
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json begun = client.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  for (int i = 0; i < 200 && threads_of_urgency(-15) < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(threads_of_urgency(-15), 2);
  const int usual = getpriority(PRIO_PROCESS, 0);
  EXPECT_GE(threads_of_urgency(usual), 5) << "what computes for calls and draws does not";
}

TEST_F(TrainingTest, APageThatGoesAwayLeavesAWholeSession) {
  {
    const Serving serving(folder_.path());
    SocketClient client(serving);
    const nlohmann::json begun =
        client.call("train.begin", {{"scene", "kidney.json"}, {"output", "left.ctpm"}, {"stage", 2}});
    press(client, begun["result"]["view"], 60, 1);
  }
  EXPECT_TRUE(info_of("left.ctpm")["ended_cleanly"].get<bool>());
  EXPECT_EQ(testing::run_ctpm({"verify", "left.ctpm"}, folder_.path()).code, 0);
}

TEST_F(TrainingTest, AFileThatIsRemovedWhileItIsRecordedIsToldAtOnceAndEndsTheSession) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json begun =
      client.call("train.begin", {{"scene", "kidney.json"}, {"output", "mine.ctpm"}, {"stage", 2}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  press(client, begun["result"]["view"], 30, 1);
  for (int i = 0; i < 3000 && !fs::exists(folder_.path() / "mine.ctpm-wal"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  fs::remove(folder_.path() / "mine.ctpm");
  press(client, begun["result"]["view"], 30, 1);
  const nlohmann::json told = event_of(client, "train_fails");
  EXPECT_NE(told["text"].get<std::string>().find("the file was removed"), std::string::npos) << told;
  // Nobody ends the session.
  const nlohmann::json ended = event_of(client, "train_ended");
  EXPECT_FALSE(ended["errors"].empty()) << ended;
}

TEST_F(TrainingTest, ADeviceLeadsWhileThePageLooksOn) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  // The device's origin lies 30 mm above the organ's middle.
  const nlohmann::json rest = client.call("scene.show", {{"path", "kidney.json"}, {"stage", 3}})["result"]["view"];
  const auto middle = [&](int axis) {
    return 0.5 * (rest["least"][axis].get<double>() + rest["most"][axis].get<double>());
  };
  const nlohmann::json begun =
      client.call("train.begin", {{"scene", "kidney.json"},
                                  {"output", "device.ctpm"},
                                  {"stage", 2},
                                  {"device",
                                   {{"listen_port", 0},
                                    {"offset_m", {middle(0), middle(1), rest["most"][2].get<double>() + 0.03}},
                                    {"buttons", {"0=scalpel"}}}}});
  ASSERT_TRUE(begun.contains("result")) << begun;
  const std::string awaited = begun["result"]["awaited"];
  ASSERT_NE(awaited.find("waiting for a device on 127.0.0.1:"), std::string::npos) << awaited;
  const int port = std::atoi(awaited.substr(awaited.rfind(':') + 1).c_str());
  // What the page itself sends is no hand's.
  client.send({{"hand", {{"position", {0, 0, 0}}, {"orientation", {1, 0, 0, 0}}, {"buttons", 2}, {"time_s", 1}}}});
  testing::IgtlPeer device(port);
  for (int i = 0; i <= 150; ++i) {
    EXPECT_TRUE(device.send(testing::transform_bytes({0, 0, -40 * std::sin(3.14159 * i / 150)})));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  int live_frames = 0;
  const nlohmann::json ended = event_of(client, "train_ended", &live_frames);
  device.wait_for_end();
  EXPECT_TRUE(ended["errors"].empty()) << ended;
  EXPECT_GT(ended["max_force_n"].get<double>(), 0.05) << ended;
  EXPECT_GT(live_frames, 10);
  double felt = 0;
  for (const Vec3 force : device.forces()) felt = std::max(felt, norm(force));
  EXPECT_GT(felt, 0.02);
  EXPECT_EQ(testing::run_ctpm({"verify", "device.ctpm"}, folder_.path()).code, 0);
  const nlohmann::json info = info_of("device.ctpm");
  EXPECT_EQ(info["metadata"]["source"], "igtl-listen");
  EXPECT_GT(info["values"]["device_samples"].get<double>(), 100) << info["values"];
}

TEST_F(TrainingTest, ADeviceThatCannotBeThereIsToldAndAnAwaitedOneMayNeverCome) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto begin = [&](const nlohmann::json& device) {
    return client.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}, {"device", device}});
  };
  const auto says = [&](const nlohmann::json& device, const char* what) {
    const std::string answer = begin(device).dump();
    EXPECT_NE(answer.find("errors"), std::string::npos) << answer;
    EXPECT_NE(answer.find(what), std::string::npos) << answer;
  };
  says(nlohmann::json::object(), "give either an address or a listen_port");
  says({{"listen_port", 1}, {"address", "127.0.0.1:1"}}, "give either an address or a listen_port");
  says({{"address", "nowhere"}}, "must be HOST:PORT");
  says({{"address", "127.0.0.1:1"}}, "127.0.0.1:1");
  says({{"listen_port", 0}, {"tool", "saw"}}, "saw");
  says({{"listen_port", 0}, {"offset_m", {1, 2}}}, "offset_m");
  says({{"listen_port", 0}, {"bind", "0.0.0.0"}}, "name the addresses that may connect");
  says({{"listen_port", 0}, {"spring", 3}}, "/device/spring");
  ASSERT_TRUE(begin({{"listen_port", 0}}).contains("result"));
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  const nlohmann::json ended = event_of(client, "train_ended");
  EXPECT_NE(ended["errors"].dump().find("nothing was recorded"), std::string::npos) << ended;
}

TEST_F(TrainingTest, BadRequestsAreToldWhy) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto errors = [&](const nlohmann::json& parameters) { return client.call("train.begin", parameters).dump(); };
  EXPECT_NE(errors({{"scene", "../kidney.json"}, {"stage", 2}}).find("lies outside the folder"), std::string::npos);
  EXPECT_NE(
      errors({{"scene", "kidney.json"}, {"stage", 2}, {"output", "../mine.ctpm"}}).find("lies outside the folder"),
      std::string::npos);
  EXPECT_NE(errors({{"scene", "kidney.json"}, {"stage", 2}, {"output", "mine.mp4"}}).find("must end in .ctpm"),
            std::string::npos);
  std::ofstream(folder_.path() / "bad.json") << "{\"name\": 7}";
  EXPECT_NE(errors({{"scene", "bad.json"}, {"stage", 2}}).find("bad.json:1:"), std::string::npos);
}

TEST(PageHand, MessagesThatArriveTogetherCountFromWhenTheyWereSent) {
  server::PageHand hand;
  hand.move({}, 10.000);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  for (int i = 1; i <= 5; ++i) hand.move({}, 10.000 + 0.010 * i);
  double first = 0, last = 0;
  devices::DeviceReport report;
  ASSERT_TRUE(hand.next(report));
  first = report.arrival;
  for (int i = 1; i <= 5; ++i) {
    ASSERT_TRUE(hand.next(report));
    EXPECT_EQ(report.news, devices::DeviceNews::pose);
    EXPECT_NEAR(report.arrival - first, 0.010 * i, 1e-6);
    last = report.arrival;
  }
  EXPECT_FALSE(hand.next(report));
  EXPECT_LE(last, devices::device_clock());
  // Buttons come before the pose that goes with them, and only when they change.
  hand.move({{}, 2}, 10.2), hand.move({{}, 2}, 10.3);
  ASSERT_TRUE(hand.next(report));
  EXPECT_EQ(report.news, devices::DeviceNews::buttons);
  EXPECT_EQ(report.buttons, 2u);
  ASSERT_TRUE(hand.next(report));
  ASSERT_TRUE(hand.next(report));
  EXPECT_EQ(report.news, devices::DeviceNews::pose);
  EXPECT_FALSE(hand.next(report));
}

}  // namespace
}  // namespace ctpm
