#include "studio/devices/device_source.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "studio/sources/rotation.h"

namespace ctpm::devices {

double device_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

namespace {
constexpr int kMostReports = 512;  // taken in one tick
}

DeviceSource::DeviceSource(std::unique_ptr<Device> device, const DeviceSettings& settings, double tick, Clock clock)
    : device_(std::move(device)),
      settings_(settings),
      tick_(tick),
      clock_(std::move(clock)),
      guard_(settings.guard),
      coupling_(settings.coupling, tick),
      passive_(settings.most_force) {}

bool DeviceSource::wait_for_first_pose(const std::function<bool()>& should_stop,
                                       const std::function<void(const std::string&)>& tell) {
  constexpr double kPatience = 5;  // [s]
  // Poses from before this call are too old.
  const double began = clock_();
  double told = began;
  std::string said;
  while (!guard_.has_pose() || guard_.pose_arrival() < began) {
    if (should_stop()) return false;
    const std::string fault = guard_.last_fault(), &other = guard_.other_name();
    if (tell && (fault + other != said || clock_() - told > kPatience)) {
      std::string text;
      if (!fault.empty()) text = fault + "; samples refused so far: " + std::to_string(guard_.counts().refused);
      if (!other.empty())
        text += (text.empty() ? "" : "; ") + ("poses of '" + other + "' come, and another device is asked for");
      tell(text.empty() ? "nothing has come yet" : text);
      said = fault + other, told = clock_();
    }
    if (!take_reports(clock_())) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  // The tool is taken up here, even if the hand goes on before the first tick.
  hand_ = settings_.map.to_scene(guard_.pose());
  return true;
}

/// Takes all waiting reports. True if a good pose was among them.
bool DeviceSource::take_reports(double now) {
  bool has_new_pose = false;
  const std::int64_t refused_before = guard_.counts().refused + guard_.counts().unread;
  // Those of a flood are left for the next ticks: a tick never waits for a sender.
  DeviceReport report;
  for (int i = 0; i < kMostReports && device_->next(report); ++i) {
    if (!guard_.take(report)) continue;
    has_new_pose = true, waits_.add(now - report.arrival), ways_.add(report.on_way);
    if (settings_.may_mean_metres) unit_.add(settings_.map.scale * guard_.pose().position, report.arrival);
  }
  saw_fault_ = guard_.counts().refused + guard_.counts().unread != refused_before;
  return has_new_pose;
}

/// Interpolates from the hand's present pose to the new one over the last sample interval. Slow devices thus give a
/// smooth motion, delayed by one sample. After a jump the speed is limited to that of a hand.
void DeviceSource::aim(double now) {
  constexpr double kMostInterval = 0.05;  // [s]
  to_ = settings_.map.to_scene(guard_.pose());
  from_ = hand_.value_or(to_);
  const double at_most = settings_.guard.most_speed * settings_.map.scale;
  const double duration = std::max(std::min(guard_.pose_interval(), kMostInterval) - (now - guard_.pose_arrival()),
                                   norm(to_.position - from_.position) / at_most);
  ticks_whole_ = ticks_left_ = std::max<std::int64_t>(1, std::llround(duration / tick_));
}

std::optional<Inputs> DeviceSource::next(std::int64_t, const stepping::StepReport& last) {
  const double now = clock_();
  const bool has_new_pose = take_reports(now);
  if (!has_ticked_) waits_ = {}, ways_ = {}, guard_.watch_from(now);  // what came before waited for the first tick
  has_ticked_ = true;
  guard_.look(now);
  if (!guard_.verdict().empty()) return std::nullopt;
  // A pose that no hand moved to is where the tool is put down and taken up again.
  const bool leapt = guard_.take_leap();
  if (leapt) hand_.reset();
  if (has_new_pose || !hand_) aim(now);
  if (ticks_left_ > 0) {
    const double share = double(ticks_whole_ - --ticks_left_) / double(ticks_whole_);
    hand_ = Pose{from_.position + share * (to_.position - from_.position),
                 sources::turned_towards(from_.orientation, to_.orientation, share)};
  }
  // A tool that was just picked up starts at the hand.
  const std::int32_t tool = leapt ? -1 : settings_.map.tool_for(guard_.buttons());
  if (tool != tool_ || tool < 0)
    coupling_.reset(*hand_);
  else
    coupling_.step(*hand_, last.tool_force, last.depth);
  tool_ = tool;
  send_force(has_new_pose);
  age_ = std::max(now - guard_.pose_arrival(), 1e-9);

  Inputs inputs;
  inputs.tool = tool;
  inputs.buttons = guard_.buttons();
  inputs.position = coupling_.tool().position;
  inputs.world_from_tool = coupling_.tool().orientation;
  return inputs;
}

std::vector<recordings::Event> DeviceSource::take_events() {
  std::vector<recordings::Event> events = guard_.take_events();
  if (unit_.take_suspicion())
    events.push_back({.kind = recordings::EventKind::note,
                      .text = "all places of the hand so far lie within 2 mm of the device's origin: OpenIGTLink means "
                              "millimetres, and a device that sends metres needs a scale of 1000"});
  return events;
}

/// Answers every good pose with a force. While poses are refused the hand's position is unknown, and the force is zero.
void DeviceSource::send_force(bool has_new_pose) {
  if (!has_new_pose && !saw_fault_) return;
  Vec3 force;
  if (has_new_pose)
    force = passive_.pass(settings_.map.to_device(coupling_.hand_force()), guard_.pose().position);
  else
    passive_.release();
  device_->send_force(force);
  ++forces_;
}

std::vector<recordings::NamedValue> DeviceSource::statistics() const {
  const DeviceGuard::Counts& counts = guard_.counts();
  return {{"device_samples", double(counts.samples)},
          {"device_samples_refused", double(counts.refused)},
          {"device_connections_refused", double(counts.turned_away)},
          {"device_messages_unread", double(counts.unread)},
          {"device_forces_sent", double(forces_)},
          {"device_longest_gap_s", counts.longest_gap},
          {"device_pose_wait_p50_s", waits_.at(0.5)},
          {"device_pose_wait_p99_s", waits_.at(0.99)},
          {"device_pose_way_p99_s", ways_.at(0.99)},
          {"device_poses_within_5ms", waits_.share_within(5e-3)}};
}

}  // namespace ctpm::devices
