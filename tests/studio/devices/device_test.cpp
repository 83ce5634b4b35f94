// A device as a source, told step by step by the test: what is believed, held, noted and sent back. No network, no
// clock.

#include "studio/devices/device_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "studio/sources/rotation.h"

namespace ctpm {
namespace {

constexpr double kTick = 1e-3;  // [s]
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class ToldDevice : public devices::Device {
 public:
  bool next(devices::DeviceReport& report) override {
    if (waiting.empty()) return false;
    report = waiting.front();
    waiting.pop_front();
    return true;
  }
  void send_force(Vec3 force) override { forces.push_back(force); }

  std::deque<devices::DeviceReport> waiting;
  std::vector<Vec3> forces;
};

class DeviceSession : public ::testing::Test {
 protected:
  DeviceSession() { start({}); }
  void start(devices::DeviceSettings settings) {
    if (settings.map.tool < 0 && settings.map.button_tools.empty()) settings.map.tool = 0;
    auto device = std::make_unique<ToldDevice>();
    device_ = device.get();
    source_ = std::make_unique<devices::DeviceSource>(std::move(device), settings, kTick, [this] { return now_; });
    events_.clear();
    tell({0, 0, 0.05});
  }
  devices::DeviceReport report(Vec3 position) const {
    devices::DeviceReport report;
    report.arrival = now_, report.pose.position = position;
    return report;
  }
  void tell(Vec3 position) { device_->waiting.push_back(report(position)); }
  void tell(devices::DeviceNews news, const char* text = "") {
    devices::DeviceReport told = report({});
    told.news = news, told.text = text;
    device_->waiting.push_back(told);
  }
  /// One tick; its events are kept.
  std::optional<Inputs> tick(Vec3 tissue_force = {}) {
    stepping::StepReport last;
    last.tool_force = tissue_force;
    const auto inputs = source_->next(0, last);
    for (recordings::Event& event : source_->take_events()) events_.push_back(event);
    now_ += kTick;
    return inputs;
  }
  /// So many ticks, in each of which the device says that it is at `position`.
  Inputs hold(Vec3 position, int ticks) {
    std::optional<Inputs> inputs;
    for (int i = 0; i < ticks; ++i) {
      tell(position);
      inputs = tick();
    }
    return inputs.value_or(Inputs{});
  }
  /// Ticks in which nothing comes.
  Inputs be_silent(int ticks) {
    std::optional<Inputs> inputs;
    for (int i = 0; i < ticks; ++i) inputs = tick();
    return inputs.value_or(Inputs{});
  }
  /// "lost: text" and "back", one a line.
  std::string story() const {
    std::string all;
    for (const recordings::Event& event : events_)
      all += (event.kind == recordings::EventKind::device_lost   ? "lost: " + recordings::describe(event, {})
              : event.kind == recordings::EventKind::device_back ? std::string("back")
                                                                 : "note: " + event.text) +
             "\n";
    return all;
  }

  double now_ = 1000;
  ToldDevice* device_ = nullptr;
  std::unique_ptr<devices::DeviceSource> source_;
  std::vector<recordings::Event> events_;
};

const Vec3 kHome{0, 0, 0.05};

TEST_F(DeviceSession, AGoodDeviceIsFollowedAndNothingIsNoted) {
  const Inputs inputs = hold(kHome, 500);
  EXPECT_EQ(inputs.tool, 0);
  EXPECT_NEAR(norm(inputs.position - kHome), 0, 1e-12);
  EXPECT_EQ(story(), "");
  EXPECT_EQ(device_->forces.size(), 500u);  // one force for each sample
  EXPECT_LE(source_->input_age(), kTick);
}

TEST_F(DeviceSession, AStallIsHeldAndNotedOnceAndItsEndAsWell) {
  hold(kHome, 100);
  const Inputs held = be_silent(500);
  EXPECT_NEAR(norm(held.position - kHome), 0, 1e-12);
  EXPECT_EQ(story(), "lost: nothing usable comes; the pose is held\n");
  EXPECT_NEAR(source_->input_age(), 0.5, 2 * kTick);
  hold(kHome, 300);
  EXPECT_EQ(story(), "lost: nothing usable comes; the pose is held\nback\n");
  EXPECT_NEAR(events_.back().held, 0.4, 2 * kTick);  // noted after 0.1 s, gone after 0.5 s
}

TEST_F(DeviceSession, ADeviceThatStaysAwayEndsTheSessionWithAReason) {
  hold(kHome, 100);
  tell(devices::DeviceNews::lost, "it hung up");
  int ticks = 0;
  while (tick()) ++ticks;
  EXPECT_NEAR(ticks, 5000, 3);
  EXPECT_EQ(source_->fault(), "the device was lost: nothing usable came for 5.0 s (it hung up)");
  EXPECT_EQ(story(), "lost: it hung up; the pose is held\nlost: nothing usable comes; the pose is held\n");
}

TEST_F(DeviceSession, ADeviceThatComesBackGoesOnFromThePoseThatWasHeldNoFasterThanAHandMoves) {
  hold(kHome, 100);
  tell(devices::DeviceNews::lost, "it hung up");
  be_silent(2000);
  tell(devices::DeviceNews::connected);
  const Vec3 elsewhere = kHome + Vec3{0.3, 0, 0};
  Vec3 before = kHome;
  double fastest = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 at = hold(elsewhere, 1).position;
    fastest = std::max(fastest, norm(at - before) / kTick);
    before = at;
  }
  EXPECT_NEAR(norm(before - elsewhere), 0, 1e-6);
  EXPECT_LT(fastest, 1.3 * devices::GuardSettings().most_speed);  // the coupling swings a little
  EXPECT_EQ(events_.back().kind, recordings::EventKind::device_back);
  EXPECT_EQ(source_->fault(), "");
}

TEST_F(DeviceSession, PosesThatAreUsedBetweenFaultsAreNotSaidToBeHeld) {
  hold(kHome, 100);
  // 2 s in which every 50th message has no pose, and all others are followed.
  for (int i = 0; i < 40; ++i) {
    tell({kNan, 0, 0}), tick();
    hold(kHome, 49);
  }
  hold(kHome, 200);
  EXPECT_EQ(story(), "lost: pose is not finite; the pose is held\nback\n");
  EXPECT_NEAR(events_.back().held, 40 * kTick, 1e-9);
  EXPECT_EQ(events_.back().refused_samples, 40);
}

TEST_F(DeviceSession, WhatIsNotFiniteOrNoRotationIsNotBelieved) {
  hold(kHome, 100);
  for (const Vec3 bad : {Vec3{kNan, 0, 0}, Vec3{0, INFINITY, 0}}) tell(bad);
  devices::DeviceReport twisted = report(kHome);
  twisted.pose.orientation = {0.1, 0.1, 0, 0};
  device_->waiting.push_back(twisted);
  twisted.pose.orientation = {kNan, 0, 0, 0};
  device_->waiting.push_back(twisted);
  const auto inputs = tick();
  ASSERT_TRUE(inputs);
  EXPECT_NEAR(norm(inputs->position - kHome), 0, 1e-12);
  EXPECT_EQ(device_->forces.back(), Vec3{});  // nobody knows where the hand is
  EXPECT_EQ(story(),
            "lost: pose is not finite; the pose is held\nlost: orientation is no rotation; the pose is held\n");
  hold(kHome, 200);
  EXPECT_EQ(events_.back().kind, recordings::EventKind::device_back);
  EXPECT_EQ(events_.back().refused_samples, 4);  // samples refused
}

TEST_F(DeviceSession, ATeleportIsHeldUntilAHandCouldHaveGoneThere) {
  hold(kHome, 100);
  const Vec3 far = kHome + Vec3{0.05, 0, 0};
  // At 1 m/s it takes 49 ms to what is beyond the noise of 1 mm.
  const Inputs held = hold(far, 45);
  EXPECT_NEAR(norm(held.position - kHome), 0, 1e-9);
  EXPECT_EQ(story(), "lost: jumps farther than a hand moves; the pose is held\n");
  const Inputs there = hold(far, 600);
  EXPECT_NEAR(norm(there.position - far), 0, 1e-6);
  EXPECT_EQ(events_.back().kind, recordings::EventKind::device_back);
  for (const Vec3& force : device_->forces) EXPECT_LE(norm(force), 3 * (1 + 1e-12));
}

TEST_F(DeviceSession, OneWildSampleMovesNothing) {
  hold(kHome, 100);
  tell(kHome + Vec3{0, 0, -0.05});
  const auto during = tick();
  const Inputs after = hold(kHome, 300);
  EXPECT_NEAR(norm(during->position - kHome), 0, 1e-12);
  EXPECT_NEAR(norm(after.position - kHome), 0, 1e-12);
  EXPECT_EQ(story(), "lost: jumps farther than a hand moves; the pose is held\nback\n");
}

TEST_F(DeviceSession, ASampleFromThePastIsNotBelievedButANewConnectionMayHaveAnotherClock) {
  const auto tell_at = [&](double device_time, Vec3 position) {
    devices::DeviceReport told = report(position);
    told.device_time = device_time;
    device_->waiting.push_back(told);
  };
  tell_at(50, kHome);
  tick();
  tell_at(49.9, kHome + Vec3{0.001, 0, 0});
  tick();
  EXPECT_EQ(story(), "lost: time goes backwards; the pose is held\n");
  tell_at(50, kHome);  // the same moment again is no step back
  tick();
  tell(devices::DeviceNews::lost, "it hung up");
  tell(devices::DeviceNews::connected);
  tell_at(3, kHome);
  tick();
  EXPECT_EQ(story(), "lost: time goes backwards; the pose is held\nlost: it hung up; the pose is held\n");
  const auto values = source_->statistics();
  EXPECT_EQ(values.at(0), (recordings::NamedValue{"device_samples", 5}));
  EXPECT_EQ(values.at(1), (recordings::NamedValue{"device_samples_refused", 1}));
}

/// The age of the input grows while a hand rests; how long its poses waited does not.
TEST_F(DeviceSession, ItCountsHowLongPosesWaitForTheirTick) {
  const auto wait = [&](std::size_t i) { return source_->statistics().at(i); };
  for (int i = 0; i < 50; ++i) tell(kHome), now_ += kTick;  // the session has not begun
  hold(kHome, 96);                                          // the first one begins it
  for (int i = 0; i < 5; ++i) {
    devices::DeviceReport late = report(kHome);
    late.arrival -= 0.7 * kTick;
    device_->waiting.push_back(late);
    tick();
  }
  be_silent(300);
  EXPECT_GT(source_->input_age(), 0.2);
  EXPECT_EQ(wait(6).first, "device_pose_wait_p50_s");
  EXPECT_LT(wait(6).second, 0.2e-3);
  EXPECT_EQ(wait(7).first, "device_pose_wait_p99_s");
  EXPECT_NEAR(wait(7).second, 0.75e-3, 0.06e-3);
  EXPECT_EQ(wait(9).first, "device_poses_within_5ms");
  EXPECT_EQ(wait(9).second, 1);
  // Of poses that are read late the way is told, and that they missed.
  for (int i = 0; i < 100; ++i) {
    devices::DeviceReport late = report(kHome);
    late.arrival -= 8e-3, late.on_way = 8e-3;
    device_->waiting.push_back(late);
    tick();
  }
  EXPECT_EQ(wait(8).first, "device_pose_way_p99_s");
  EXPECT_NEAR(wait(8).second, 8e-3, 0.11e-3);
  EXPECT_NEAR(wait(9).second, 0.5, 0.02);
}

TEST_F(DeviceSession, AFaultThatComesAndGoesIsNotedAFewTimesASecondAtMost) {
  hold(kHome, 100);
  for (int i = 0; i < 3000; ++i) {
    tell(kHome);
    if (i % 3 == 0) tell(Vec3{kNan, 0, 0});
    if (i % 7 == 0) tell(devices::DeviceNews::bad_message, "a message with a wrong checksum");
    tick();
  }
  EXPECT_EQ(events_.size(), 2u) << story();
}

/// The device's first pose is where optical trackers put an instrument that they do not see, or anywhere else.
TEST_F(DeviceSession, OneWildFirstPoseOrTimeStampDoesNotKeepTheDeviceOut) {
  devices::DeviceSettings settings;
  settings.guard.farthest = 10;
  for (const Vec3 wild : {Vec3{-3.7e25, -3.7e25, -3.7e25}, Vec3{9, 0, 0}, Vec3{-0.4, 0, 0}}) {
    start(settings);
    device_->waiting.clear();
    tell(wild);
    for (int i = 0; i < 1000; ++i) {
      now_ += kTick;
      tell(kHome);
    }
    EXPECT_TRUE(source_->wait_for_first_pose([] { return false; }));
    EXPECT_NEAR(norm(tick()->position - kHome), 0, 1e-12) << wild.x;
  }
  start(settings);
  device_->waiting.clear();
  devices::DeviceReport stamped = report(kHome);
  stamped.device_time = 86400 + 5;
  device_->waiting.push_back(stamped);
  tick();
  int accepted_after = -1;
  for (int i = 0; i < 1000 && accepted_after < 0; ++i) {
    stamped = report(kHome + Vec3{0.001, 0, 0});
    stamped.device_time = 5 + now_ - 1000;
    device_->waiting.push_back(stamped);
    tick();
    if (source_->input_age() < 2 * kTick) accepted_after = i;
  }
  EXPECT_GE(accepted_after, 0);
  EXPECT_LT(accepted_after, 1000);
}

TEST_F(DeviceSession, ADeviceCannotStallBeforeTheFirstTick) {
  start({});
  device_->waiting.clear();
  for (int i = 0; i < 100; ++i) now_ += kTick, tell(kHome);
  ASSERT_TRUE(source_->wait_for_first_pose([] { return false; }));
  now_ += 0.3;  // the session's file is opened, on a machine that does nothing else meanwhile
  be_silent(50);
  hold(kHome, 100);
  EXPECT_EQ(story(), "");
  be_silent(150);
  EXPECT_EQ(story(), "lost: nothing usable comes; the pose is held\n");
}

TEST_F(DeviceSession, AToolIsTakenUpWhereItsHandWasSeenFirstAndFollowsFromThere) {
  start({});
  device_->waiting.clear();
  for (int i = 0; i < 100; ++i) now_ += kTick, tell(kHome);
  int asked = 0;
  ASSERT_TRUE(source_->wait_for_first_pose([&] { return ++asked > 100; }));
  // The session's file is opened meanwhile.
  const Vec3 way{0, 0, -0.05};
  for (int i = 1; i <= 250; ++i) {
    now_ += kTick;
    tell(kHome + i / 250.0 * way);
  }
  Vec3 last = kHome;
  for (int i = 0; i < 200; ++i) {
    const Vec3 at = tick()->position;
    EXPECT_LT(norm(at - last), 1.3e-3) << "a spring behind a hand that moves at 1 m/s at most, in tick " << i;
    last = at;
  }
  EXPECT_LT(norm(last - (kHome + way)), 1e-3);
}

TEST_F(DeviceSession, OneTimeStampADayAheadIsRefusedAndTheNextIsNot) {
  for (int i = 0; i < 300; ++i) {
    devices::DeviceReport stamped = report(kHome);
    stamped.device_time = 5 + i * kTick + (i == 150 ? 86400 : 0);
    device_->waiting.push_back(stamped);
    tick();
  }
  EXPECT_EQ(source_->statistics().at(1).second, 1) << story();
  EXPECT_EQ(story(), "lost: time leaps ahead; the pose is held\nback\n");
}

/// What was held was wrong, and the hand is far away: no tool may go through the tissue on the way.
TEST_F(DeviceSession, AHandThatStaysElsewhereIsBelievedAndItsToolIsPutDownOnTheWay) {
  hold(kHome, 100);
  const Vec3 far = kHome + Vec3{3, 0, 0};
  bool was_away = false;
  int ticks = 0;
  for (; ticks < 1000; ++ticks) {
    tell(far);
    const auto inputs = tick();
    ASSERT_TRUE(inputs);
    was_away = was_away || inputs->tool < 0;
    const double off = std::min(norm(inputs->position - kHome), norm(inputs->position - far));
    ASSERT_TRUE(inputs->tool < 0 || off < 1e-6) << "tick " << ticks;
    if (inputs->tool >= 0 && norm(inputs->position - far) < 1e-6) break;
  }
  EXPECT_LT(ticks, 1000) << "believed within a second";
  EXPECT_TRUE(was_away);
}

TEST_F(DeviceSession, WhatAFloodBringsIsBoundedInATickAndInTheSession) {
  class Endless : public devices::Device {
   public:
    bool next(devices::DeviceReport& report) override {
      report = {};
      report.news = ++told % 2 == 0 ? devices::DeviceNews::turned_away : devices::DeviceNews::pose;
      report.text = "a second device came and was turned away";
      report.arrival = 1000 + 1e-6 * told, report.pose.position = kHome;
      return true;
    }
    void send_force(Vec3) override {}
    int told = 0;
  };
  auto device = std::make_unique<Endless>();
  Endless& endless = *device;
  devices::DeviceSettings settings;
  settings.map.tool = 0;
  devices::DeviceSource source(std::move(device), settings, kTick, [this] { return now_; });
  std::size_t events = 0;
  for (int i = 0; i < 100; ++i, now_ += kTick) {
    const int before = endless.told;
    ASSERT_TRUE(source.next(i, {}));
    EXPECT_LE(endless.told - before, 1000);
    events += source.take_events().size();
  }
  EXPECT_LE(events, 5u);
}

TEST_F(DeviceSession, AHandThatMovesForSecondsWithinTwoMillimetresOfTheOriginMaySendMetres) {
  const auto story_of = [&](bool may_mean_metres, double scale, double sway_m, Vec3 beside = {}) {
    devices::DeviceSettings settings;
    settings.may_mean_metres = may_mean_metres, settings.map.scale = scale;
    start(settings);
    device_->waiting.clear();
    for (int i = 0; i < 4000; ++i) hold(beside + Vec3{sway_m * std::sin(i * 2e-3), 0, 0}, 1);
    return story();
  };
  const std::string said = story_of(true, 1, 2e-4);
  EXPECT_EQ(said.find("note: all places of the hand so far lie within 2 mm of the device's origin"), 0u) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_EQ(story_of(true, 1000, 2e-4), "") << "it was told";
  EXPECT_EQ(story_of(true, 1, 0.05), "") << "a hand that moves as far as hands do";
  EXPECT_EQ(story_of(true, 1, 1e-5), "") << "a hand that rests at the origin";
  EXPECT_EQ(story_of(true, 1, 2e-4, {0, 0, 0.05}), "") << "a still hand elsewhere";
  EXPECT_EQ(story_of(false, 1, 2e-4), "") << "a page's hand, which has a unit";
}

TEST_F(DeviceSession, ASecondDeviceIsNotedAndNothingElse) {
  tell(devices::DeviceNews::turned_away, "a second device came and was turned away");
  hold(kHome, 10);
  EXPECT_EQ(story(), "note: a second device came and was turned away\n");
}

TEST_F(DeviceSession, ASlowDeviceGivesAnEvenMotion) {
  // 50 samples a second of 100 mm/s, so 2 mm from one to the next: the tool must not go in leaps.
  std::vector<Vec3> way;
  for (int i = 0; i < 1000; ++i) {
    if (i % 20 == 0) tell(kHome + i * kTick * Vec3{0.1, 0, 0});
    way.push_back(tick()->position);
  }
  for (std::size_t i = 300; i < way.size(); ++i)
    ASSERT_NEAR((way[i].x - way[i - 1].x) / kTick, 0.1, 0.01) << "tick " << i;
  EXPECT_NEAR(way.back().x, (1 - 0.02) * 0.1, 0.001);  // one sample late
}

TEST_F(DeviceSession, TheDeviceLiesInTheSceneAsTheMapSays) {
  devices::DeviceSettings settings;
  settings.map.scale = 0.5;
  settings.map.offset = {0.1, 0.2, 0.3};
  settings.map.scene_from_device = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // x of the device is y of the scene
  settings.map.tip = {1, 0, 0};
  start(settings);
  const Inputs inputs = hold({0, 0, 0.05}, 1);
  EXPECT_NEAR(norm(inputs.position - Vec3{0.1, 0.2, 0.325}), 0, 1e-12);
  // The instrument's tip, its own +x, is where the tool's -z points: along the scene's y.
  EXPECT_NEAR(norm(rotate(inputs.world_from_tool, {0, 0, -1}) - Vec3{0, 1, 0}), 0, 1e-12);
  const Inputs moved = hold({0.002, 0, 0.05}, 500);
  EXPECT_NEAR(norm(moved.position - Vec3{0.1, 0.201, 0.325}), 0, 1e-9);
  // Tissue that pushes along the scene's y pushes the hand along the device's x. A hand that presses on.
  for (int i = 0; i < 300; ++i) {
    tell({0.002 - i * 1e-6, 0, 0.05});
    tick({0, 0.8, 0});
  }
  EXPECT_NEAR(device_->forces.back().x, 0.8, 0.05);
  EXPECT_NEAR(device_->forces.back().y, 0, 0.01);
}

TEST_F(DeviceSession, AButtonSelectsItsToolAndTheToolIsInTheHandAtOnce) {
  devices::DeviceSettings settings;
  settings.map.tool = 0;
  settings.map.button_tools = {{3, -1}, {0, 1}};
  start(settings);
  hold(kHome, 5);
  const auto press = [&](std::uint32_t buttons) {
    devices::DeviceReport told = report({});
    told.news = devices::DeviceNews::buttons, told.buttons = buttons;
    device_->waiting.push_back(told);
    return hold(kHome, 1);
  };
  EXPECT_EQ(press(1).tool, 1);
  EXPECT_EQ(press(1).buttons, 1u);
  EXPECT_EQ(press(2).tool, 0);
  EXPECT_EQ(press(8 + 1).tool, -1);  // the first that is named counts
  EXPECT_NEAR(norm(press(0).position - kHome), 0, 1e-12);
}

TEST_F(DeviceSession, WhoeverStopsWaitingForADeviceIsHeard) {
  devices::DeviceSource source(std::make_unique<ToldDevice>(), {}, kTick, [] { return 0.0; });
  int asked = 0;
  EXPECT_FALSE(source.wait_for_first_pose([&] { return ++asked > 3; }));
}

}  // namespace
}  // namespace ctpm
