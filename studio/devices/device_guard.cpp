#include "studio/devices/device_guard.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "studio/sources/rotation.h"

namespace ctpm::devices {
namespace {

constexpr double kLengthTolerance = 0.1;  // of a quaternion

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", value);
  return text;
}

}  // namespace

/// Why a pose is refused; null if it is accepted.
const char* DeviceGuard::problem_with(const DeviceReport& report) const {
  if (!is_finite(report.pose.position) || !sources::is_finite(report.pose.orientation)) return "pose is not finite";
  if (!(std::abs(sources::length_of(report.pose.orientation) - 1) <= kLengthTolerance))
    return "orientation is no rotation";
  if (!has_pose_) return nullptr;
  if (report.device_time > 0 && report.device_time < device_time_) return "time goes backwards";
  const double reach = settings_.most_speed * (report.arrival - arrival_) + settings_.slack;
  if (norm(report.pose.position - pose_.position) > reach) return "jumps farther than a hand moves";
  return nullptr;
}

bool DeviceGuard::take(const DeviceReport& report) {
  switch (report.news) {
    case DeviceNews::connected:
      device_time_ = 0;  // a new connection may have another clock
      return false;
    case DeviceNews::buttons:
      buttons_ = report.buttons;
      return false;
    case DeviceNews::turned_away:
      events_.push_back({.kind = recordings::EventKind::note, .text = "a second device came and was turned away"});
      return false;
    case DeviceNews::bad_message:
      ++counts_.unread;
      fault(report.text, report.arrival);
      return false;
    case DeviceNews::lost:
      fault(report.text, report.arrival);
      return false;
    case DeviceNews::pose:
      break;
  }
  ++counts_.samples;
  if (const char* problem = problem_with(report)) {
    fault(problem, report.arrival);
    ++counts_.refused;
    return false;
  }
  interval_ = has_pose_ ? std::max(0.0, report.arrival - arrival_) : 0;
  counts_.longest_gap = std::max(counts_.longest_gap, interval_);
  has_pose_ = true;
  pose_ = {report.pose.position, sources::normalised(report.pose.orientation)};
  arrival_ = report.arrival;
  device_time_ = std::max(device_time_, report.device_time);
  return true;
}

void DeviceGuard::look(double now) {
  if (!has_pose_) return;
  const double silence = now - arrival_;
  if (silence > settings_.stall_after) fault("nothing usable comes", now);
  if (silence > settings_.give_up_after && verdict_.empty())
    verdict_ = "the device was lost: nothing usable came for " + seconds(silence) + " (" + faults_.front() + ")";
  if (!faults_.empty() && arrival_ > last_fault_ && now - last_fault_ > kQuiet) {
    events_.push_back({.kind = recordings::EventKind::device_back,
                       .held = last_fault_ - spell_began_,
                       .refused_samples = counts_.refused - refused_before_spell_});
    faults_.clear();
  }
}

void DeviceGuard::fault(const char* text, double now) {
  last_fault_ = now;
  if (faults_.empty()) spell_began_ = now, refused_before_spell_ = counts_.refused;
  if (std::find(faults_.begin(), faults_.end(), text) != faults_.end()) return;
  faults_.push_back(text);
  events_.push_back({.kind = recordings::EventKind::device_lost, .reason = text});
}

std::vector<recordings::Event> DeviceGuard::take_events() { return std::exchange(events_, {}); }

}  // namespace ctpm::devices
