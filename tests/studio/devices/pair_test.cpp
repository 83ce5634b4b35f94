// Two devices, one for each hand of a session.

#include "studio/devices/device_pair.h"

#include <gtest/gtest.h>

#include <deque>
#include <string>

#include "studio/devices/open_device.h"

namespace ctpm {
namespace {

constexpr double kTick = 1e-3;  // [s]
const Vec3 kLeft{-0.05, 0, 0.05}, kRight{0.05, 0, 0.05};

class ToldDevice : public devices::Device {
 public:
  bool next(devices::DeviceReport& report) override {
    if (waiting.empty()) return false;
    report = waiting.front();
    waiting.pop_front();
    return true;
  }
  void send_force(Vec3 force) override { last = force; }

  std::deque<devices::DeviceReport> waiting;
  Vec3 last;
};

Model model_of_two() {
  Model model;
  model.tick = kTick, model.hands = 2;
  model.tools = {
      {"ball", ToolKind::ball, 0.01, 0}, {"other", ToolKind::ball, 0.01, 0}, {"knife", ToolKind::scalpel, 0, 0.05}};
  return model;
}

class Pair : public ::testing::Test {
 protected:
  Pair() {
    std::array<std::unique_ptr<devices::DeviceSource>, 2> sources;
    for (std::size_t hand = 0; hand < 2; ++hand) {
      devices::DeviceSettings settings;
      settings.map.tool = std::int32_t(hand);
      settings.map.button_tools = {{0, 2}};
      settings.guard.give_up_after = 1;
      auto device = std::make_unique<ToldDevice>();
      devices_[hand] = device.get();
      sources[hand] =
          std::make_unique<devices::DeviceSource>(std::move(device), settings, kTick, [this] { return now_; });
    }
    pair_ = std::make_unique<devices::DevicePair>(std::move(sources[0]), std::move(sources[1]), model_);
  }
  void tell(std::size_t hand, Vec3 position) {
    devices::DeviceReport report;
    report.arrival = now_, report.pose.position = position;
    devices_[hand]->waiting.push_back(report);
  }
  void press(std::size_t hand, std::uint32_t buttons) {
    devices::DeviceReport report;
    report.arrival = now_, report.news = devices::DeviceNews::buttons, report.buttons = buttons;
    devices_[hand]->waiting.push_back(report);
  }
  std::optional<Inputs> tick(const stepping::StepReport& last = {}) {
    const auto inputs = pair_->next(0, last);
    for (recordings::Event& event : pair_->take_events()) events_.push_back(event);
    now_ += kTick;
    return inputs;
  }
  Inputs hold(int ticks, const stepping::StepReport& last = {}) {
    std::optional<Inputs> inputs;
    for (int i = 0; i < ticks; ++i) {
      tell(0, kRight), tell(1, kLeft);
      inputs = tick(last);
    }
    return inputs.value_or(Inputs{});
  }

  double now_ = 1000;
  Model model_ = model_of_two();
  std::array<ToldDevice*, 2> devices_{};
  std::unique_ptr<devices::DevicePair> pair_;
  std::vector<recordings::Event> events_;
};

TEST_F(Pair, EachHandFollowsItsDeviceAndFeelsItsForce) {
  stepping::StepReport last;
  const Inputs free = hold(300);
  EXPECT_EQ(free.tool, 0);
  EXPECT_EQ(free.second.tool, 1);
  EXPECT_NEAR(norm(free.position - kRight), 0, 1e-9);
  EXPECT_NEAR(norm(free.second.position - kLeft), 0, 1e-9);
  last.second.tool_force = {0, 0, 0.5};
  const Inputs pushed = hold(500, last);
  EXPECT_NEAR(norm(pushed.position - kRight), 0, 1e-9) << "the other hand's tissue does not push this one";
  EXPECT_GT(pushed.second.position.z, kLeft.z + 1e-4);
  EXPECT_NEAR(norm(devices_[0]->last), 0, 1e-12);
  EXPECT_TRUE(events_.empty());
  EXPECT_GT(pair_->statistics().size(), 6u);
}

TEST_F(Pair, AGapIsThatOfItsHandAndTheOtherGoesOn) {
  hold(200);
  Vec3 place = kRight;
  std::optional<Inputs> inputs;
  for (int i = 0; i < 300; ++i) {
    place.x += 2e-5;
    tell(0, place);
    inputs = tick();
  }
  ASSERT_TRUE(inputs);
  EXPECT_GT(inputs->position.x, kRight.x + 4e-3);
  EXPECT_NEAR(norm(inputs->second.position - kLeft), 0, 1e-9) << "held";
  ASSERT_EQ(events_.size(), 1u);
  EXPECT_EQ(events_[0].kind, recordings::EventKind::device_lost);
  EXPECT_EQ(events_[0].hand, 1);
  EXPECT_NEAR(pair_->input_age(), 0.3, 0.01) << "the older of both";
  for (int i = 0; i < 900 && inputs; ++i) {
    tell(0, place);
    inputs = tick();
  }
  EXPECT_FALSE(inputs) << "given up";
  EXPECT_TRUE(pair_->fault().starts_with("second hand: ")) << pair_->fault();
}

TEST_F(Pair, ATwiceWantedToolStaysInTheHandThatHasIt) {
  hold(100);
  press(1, 1);
  EXPECT_EQ(hold(10).second.tool, 2);
  press(0, 1);
  Inputs inputs = hold(10);
  EXPECT_EQ(inputs.second.tool, 2);
  EXPECT_EQ(inputs.tool, -1);
  ASSERT_EQ(events_.size(), 1u) << "said once";
  EXPECT_EQ(events_[0].text, "both hands hold the same tool: the first hand stays empty");
  press(1, 0);
  inputs = hold(10);
  EXPECT_EQ(inputs.tool, 2);
  EXPECT_EQ(inputs.second.tool, 1);
}

TEST(FollowDevices, NeedsTwoHandsAndToolsThatGoTogether) {
  Model model = model_of_two();
  const auto errors = [&](const std::string& second_tool) {
    devices::DeviceRequest first, second;
    second.tool = second_tool;
    const auto pair =
        devices::follow_devices(first, std::make_unique<ToldDevice>(), devices::as_second_hand(second, first),
                                std::make_unique<ToldDevice>(), model);
    return pair ? std::string() : to_string(pair.errors().front());
  };
  EXPECT_EQ(errors(""), "") << "the scene's second tool";
  EXPECT_EQ(errors("knife"), "");
  EXPECT_NE(errors("ball").find("both hands hold the same tool"), std::string::npos);
  EXPECT_NE(errors("spoon").find("the scene has no tool 'spoon'"), std::string::npos);
  model.hands = 1;
  EXPECT_NE(errors("").find("the scene has one hand"), std::string::npos);
}

}  // namespace
}  // namespace ctpm
