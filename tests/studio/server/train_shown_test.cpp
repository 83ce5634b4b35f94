// What a client that leads a session sees of it, and feels.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "studio/server/newest_state.h"
#include "tests/studio/devices/igtl_client.h"
#include "tests/studio/server/serving.h"
#include "tests/studio/server/training.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::event_of;
using testing::press;
using testing::Serving;
using testing::SocketClient;
using testing::TrainingTest;
using testing::value_at;

/// What comes for a page in a training: of each frame the triangles that came before it, without their number, or
/// nothing, and the elements severed by then.
struct ShownFrame {
  std::string triangles;
  std::uint32_t severed = 0;
};
class ShownFrames {
 public:
  explicit ShownFrames(SocketClient& client) : client_(client) {}
  /// Takes what has come.
  void read() {
    while (client_.has_news()) take();
  }
  std::vector<ShownFrame> until_end() {
    while (!has_ended_) take();
    return std::move(frames_);
  }

 private:
  void take() {
    const auto message = client_.receive();
    if (message.is_text) {
      has_ended_ = has_ended_ || nlohmann::json::parse(message.bytes).value("event", "") == "train_ended";
      return;
    }
    const std::uint32_t kind = value_at<std::uint32_t>(message.bytes, 0);
    if (kind == 1) next_.triangles = message.bytes.substr(12);
    if (kind != 2) return;
    next_.severed = value_at<std::uint32_t>(message.bytes, 92);
    frames_.push_back(std::exchange(next_, {}));
  }

  SocketClient& client_;
  ShownFrame next_;
  std::vector<ShownFrame> frames_;
  bool has_ended_ = false;
};

TEST_F(TrainingTest, TrianglesComeAtItsBeginningAndThenOnlyWhenACutChangedThem) {
  fs::copy(fs::path(CTPM_SHIPPED_SESSIONS) / "kidney-cut-expert.ctpm", folder_.path() / "expert.ctpm");
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto train = [&](const auto& lead) {
    const nlohmann::json begun = client.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}});
    EXPECT_TRUE(begun.contains("result")) << begun;
    ShownFrames frames(client);
    lead(begun["result"]["view"], frames);
    client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
    return frames.until_end();
  };
  // A press moves every vertex, and changes no triangle.
  const std::vector<ShownFrame> pressed =
      train([&](const nlohmann::json& view, ShownFrames&) { press(client, view, 150, 1); });
  ASSERT_GT(pressed.size(), 20u);
  // Those of the beginning may come before the answer.
  EXPECT_LE(std::count_if(pressed.begin(), pressed.end(), [](const ShownFrame& f) { return !f.triangles.empty(); }), 1);
  // The expert's cut, led once more.
  const nlohmann::json motion = client.call("session.motion", {{"path", "expert.ctpm"}, {"rate_hz", 125}})["result"];
  const std::vector<ShownFrame> cut = train([&](const nlohmann::json&, ShownFrames& frames) {
    const auto begin = std::chrono::steady_clock::now();
    double time = 0;
    for (const nlohmann::json& pose : motion["poses"]) {
      if (pose[0].get<int>() < 0) continue;
      time += motion["interval_s"].get<double>();
      std::this_thread::sleep_until(begin + std::chrono::duration<double>(time));
      client.send({{"hand",
                    {{"position", {pose[1], pose[2], pose[3]}},
                     {"orientation", {pose[4], pose[5], pose[6], pose[7]}},
                     {"buttons", 1 << pose[0].get<int>()},
                     {"time_s", 100 + time}}}});
      frames.read();
    }
    std::this_thread::sleep_until(begin + std::chrono::duration<double>(time + 0.5));  // it rests
    frames.read();
  });
  int came = 0, before = 0, alike = 0, severed_last = 0, resting = 0;
  std::string triangles;
  for (const ShownFrame& frame : cut) {
    before += came <= 1 && frame.triangles.empty();
    resting = frame.triangles.empty() ? resting + 1 : 0;
    severed_last = int(frame.severed);
    if (frame.triangles.empty()) continue;
    alike += frame.triangles == triangles;
    triangles = frame.triangles, ++came;
  }
  std::printf("%d frames of a cut, %d of them with other triangles, %d before the first of those, %d after the last\n",
              int(cut.size()), came, before, resting);
  EXPECT_GT(severed_last, 10);
  EXPECT_GT(came, 3);
  EXPECT_EQ(alike, 0) << "nothing was cut since the triangles before";
  EXPECT_GT(before, 10) << "until the blade is in the tissue they are those of the beginning";
  EXPECT_GT(resting, 10) << "a blade that rests cuts nothing";
}

/// Holds the ball above the organ for so many times 8 ms, and says each `every`-th time, if that is not 0, that the
/// page is ready. Returns how many frames came for it.
std::size_t frames_of_a_training(SocketClient& client, int count, int every) {
  const nlohmann::json begun = client.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}});
  EXPECT_TRUE(begun.contains("result")) << begun;
  const nlohmann::json& most = begun["result"]["view"]["most"];
  const nlohmann::json above = {most[0], most[1], most[2].get<double>() + 0.02};
  ShownFrames frames(client);
  for (int i = 0; i < count; ++i) {
    if (every > 0 && i % every == 0) client.send({{"ready", {{"stage", 2}}}});
    client.send(
        {{"hand", {{"position", above}, {"orientation", {1, 0, 0, 0}}, {"buttons", 1}, {"time_s", 100 + 0.008 * i}}}});
    std::this_thread::sleep_for(std::chrono::milliseconds(8));
    frames.read();
  }
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  return frames.until_end().size();
}

TEST_F(TrainingTest, FramesComeAsOftenAsThePageIsReadyForThem) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  constexpr int kPoses = 125;  // in a second at least
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t pushed = frames_of_a_training(client, kPoses, 0), asked = frames_of_a_training(client, kPoses, 25);
  const std::size_t hidden = frames_of_a_training(client, kPoses, kPoses);
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf(
      "%zu frames for a client that says nothing, %zu for one that is ready five times, %zu for one that is once\n",
      pushed, asked, hidden);
  // One comes before the first tick, one may come at the end, and one every 250 ms in any case.
  const std::size_t others = 2 + std::size_t(took / 0.25);
  EXPECT_GT(pushed, 20u);
  EXPECT_GE(asked, 5u);
  EXPECT_LE(asked, 5 + others);
  EXPECT_GE(hidden, 3u) << "a page that is hidden gets some";
  EXPECT_LE(hidden, 1 + others);
}

TEST(NewestState, HoldsTheFirstTickAfterItWasAskedFor) {
  server::NewestState newest;
  const auto offer = [&](int tick) {
    State state;
    state.tick = tick;
    newest.offer(state, {}, 0, 0);
  };
  std::int64_t taken = 0;
  const auto take = [&] { return newest.take([&](const server::LiveTick& tick) { taken = tick.state.tick; }); };
  offer(1);
  EXPECT_FALSE(take()) << "nothing is copied unasked";
  newest.ask();
  EXPECT_FALSE(take());
  offer(2), offer(3);
  EXPECT_TRUE(take());
  EXPECT_EQ(taken, 2);
  EXPECT_FALSE(take());
  offer(4);
  newest.ask();
  offer(5);
  EXPECT_TRUE(take());
  EXPECT_EQ(taken, 5);
}

/// A tick of a session: how high the tool is [mm], and the force on it [N].
struct Felt {
  double height, force;
};

/// The ticks of a session from its first touch on.
std::vector<Felt> felt_in(const std::string& session, const fs::path& folder) {
  EXPECT_EQ(testing::run_ctpm({"replay", session, "--csv", session + ".csv"}, folder).code, 0);
  std::ifstream csv(folder / (session + ".csv"));
  std::vector<Felt> ticks;
  std::string row, field;
  for (std::getline(csv, row); std::getline(csv, row);) {
    std::istringstream fields(row);
    Felt felt{};
    for (int i = 0; i <= 14; ++i) {
      std::getline(fields, field, ',');
      if (i == 5) felt.height = std::atof(field.c_str());
    }
    felt.force = std::atof(field.c_str());
    if (felt.force > 0.005 || !ticks.empty()) ticks.push_back(felt);
  }
  return ticks;
}

/// Root of the mean square of how far the forces of two sessions are apart on the way down, at equal heights of the
/// tool: when poses arrive is the machine's affair.
double apart_on_the_way(const std::vector<Felt>& one, const std::vector<Felt>& other) {
  double squares = 0, lowest = INFINITY;
  std::size_t at = 0, count = 0;
  for (const Felt& felt : one) {
    if (felt.height >= lowest) continue;
    lowest = felt.height;
    while (at < other.size() && other[at].height > lowest) ++at;
    if (at == other.size()) break;
    squares += (felt.force - other[at].force) * (felt.force - other[at].force), ++count;
  }
  EXPECT_GT(count, 100u);
  return std::sqrt(squares / double(count));
}

TEST_F(TrainingTest, AHandOfThePageAndADeviceFeelTheSameOfTheSameMotion) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json view = client.call("scene.show", {{"path", "kidney.json"}, {"stage", 3}})["result"]["view"];
  const auto middle = [&](int axis) {
    return 0.5 * (view["least"][axis].get<double>() + view["most"][axis].get<double>());
  };
  const double top = view["most"][2].get<double>() + 0.02;
  // Down by 30 mm in a second, and held there for half of one.
  const auto depth = [](double time) { return 0.015 * (1 - std::cos(3.14159265 * std::min(time, 1.0))); };
  const auto led = [&](const auto& send) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 190; ++i) {
      std::this_thread::sleep_until(begin + std::chrono::milliseconds(8 * i));
      send(0.008 * i);
    }
    client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
    EXPECT_TRUE(event_of(client, "train_ended")["errors"].empty());
  };
  const auto by_page = [&](const std::string& session) {
    client.call("train.begin", {{"scene", "kidney.json"}, {"output", session}, {"stage", 2}});
    led([&](double time) {
      client.send({{"hand",
                    {{"position", {middle(0), middle(1), top - depth(time)}},
                     {"orientation", {1, 0, 0, 0}},
                     {"buttons", 1},
                     {"time_s", 100 + time}}}});
    });
    return felt_in(session, folder_.path());
  };
  const auto by_device = [&](const std::string& session) {
    const nlohmann::json begun =
        client.call("train.begin", {{"scene", "kidney.json"},
                                    {"output", session},
                                    {"stage", 2},
                                    {"device", {{"listen_port", 0}, {"offset_m", {middle(0), middle(1), top}}}}});
    const std::string awaited = begun["result"]["awaited"];
    testing::IgtlPeer device(std::atoi(awaited.substr(awaited.rfind(':') + 1).c_str()));
    led([&](double time) {
      EXPECT_TRUE(device.send(testing::transform_bytes({0, 0, -1e3 * depth(time)}, 100 + time)));
    });
    return felt_in(session, folder_.path());
  };
  constexpr std::size_t kHeld = 100;  // ticks
  constexpr double kAlike = 0.01;     // of the force that is held; the same spring holds both
  constexpr double kOnTheWay = 0.1;   // of the largest: what comes late comes faster, and tissue is viscous
  // A machine that stands still on the way makes a motion another one, in few of several.
  constexpr int kMostTries = 4;
  double apart = INFINITY, most = 0;
  for (int i = 0; i < kMostTries && apart >= kOnTheWay * most; ++i) {
    const std::string number = std::to_string(i);
    const std::vector<Felt> page = by_page("page-" + number + ".ctpm"),
                            device = by_device("device-" + number + ".ctpm");
    ASSERT_GT(std::min(page.size(), device.size()), 2 * kHeld);
    double held_page = 0, held_device = 0;
    most = 0;
    for (const Felt& felt : page) most = std::max(most, felt.force);
    for (std::size_t k = 1; k <= kHeld; ++k)
      held_page += page[page.size() - k].force / kHeld, held_device += device[device.size() - k].force / kHeld;
    apart = apart_on_the_way(page, device);
    std::printf("at most %.3f N, held %.4f and %.4f N, apart by %.4f N (root of the mean square)\n", most, held_page,
                held_device, apart);
    EXPECT_GT(most, 0.2);
    EXPECT_NEAR(held_page, held_device, kAlike * held_page);
  }
  EXPECT_LT(apart, kOnTheWay * most);
}

}  // namespace
}  // namespace ctpm
