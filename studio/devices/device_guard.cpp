#include "studio/devices/device_guard.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "studio/sources/rotation.h"

namespace ctpm::devices {
namespace {

constexpr double kLengthTolerance = 0.1;  // of a quaternion
constexpr const char *kBackwards = "time goes backwards", *kLeapsAhead = "time leaps ahead",
                     *kJump = "jumps farther than a hand moves";

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
  if (!(norm(report.pose.position - settings_.centre) <= settings_.farthest)) return "pose lies far outside the scene";
  if (!has_pose_) return nullptr;
  if (report.device_time > 0 && report.device_time < device_time_) return kBackwards;
  if (report.device_time > 0 && device_time_ > 0 &&
      report.device_time - device_time_ > report.arrival - arrival_ + kMostLead)
    return kLeapsAhead;
  const double reach = settings_.most_speed * (report.arrival - arrival_) + settings_.slack;
  if (norm(report.pose.position - pose_.position) > reach) return kJump;
  return nullptr;
}

/// Whether a hand can have moved from one sample to the next.
bool DeviceGuard::agree(const DeviceReport& before, const DeviceReport& report) const {
  const double passed = report.arrival - before.arrival;
  const bool is_later =
      report.device_time == 0 || before.device_time == 0 ||
      (report.device_time >= before.device_time && report.device_time - before.device_time <= passed + kMostLead);
  return passed <= kMostPause && is_later &&
         norm(report.pose.position - before.pose.position) <= settings_.most_speed * passed + settings_.slack;
}

/// Adds a pose to those that agree. True if there are enough of them to be believed.
bool DeviceGuard::follow_track(const DeviceReport& report) {
  if (track_.count > 0 && agree(track_.last, report))
    ++track_.count;
  else
    track_.count = 1, track_.since = report.arrival;
  track_.last = report;
  if (!has_pose_) return track_.count >= 2;
  return track_.count >= kForgivenSamples && report.arrival - track_.since >= kForgiven;
}

void DeviceGuard::accept(const DeviceReport& report) {
  interval_ = has_pose_ ? std::max(0.0, report.arrival - arrival_) : 0;
  counts_.longest_gap = std::max(counts_.longest_gap, interval_);
  has_pose_ = true;
  pose_ = {report.pose.position, sources::normalised(report.pose.orientation)};
  arrival_ = report.arrival;
  device_time_ = report.device_time > 0 ? report.device_time : device_time_;
  track_.count = 0;
  if (held_since_) held_ += std::max(0.0, report.arrival - *held_since_);
  held_since_.reset();
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
      ++counts_.turned_away;
      if (report.arrival - last_note_ >= kNotes) {
        last_note_ = report.arrival;
        add({.kind = recordings::EventKind::note, .text = report.text});
      }
      return false;
    case DeviceNews::other_name:
      other_name_ = report.name.data();
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
  const char* const problem = problem_with(report);
  if (!problem && has_pose_) return accept(report), true;
  const bool may_be_right = !problem || problem == kBackwards || problem == kLeapsAhead || problem == kJump;
  if (may_be_right && follow_track(report)) {
    leapt_ = problem == kJump;
    if (problem) device_time_ = 0;
    accept(report);
    return true;
  }
  if (problem) {
    fault(problem, report.arrival);
    ++counts_.refused;
  }
  return false;
}

void DeviceGuard::look(double now) {
  if (!has_pose_) return;
  const double silence = now - std::max(arrival_, watched_from_);
  if (silence > settings_.stall_after) fault("nothing usable comes", now);
  if (silence > settings_.give_up_after && verdict_.empty())
    verdict_ = "the device was lost: nothing usable came for " + seconds(silence) + " (" + faults_.front() + ")";
  if (!faults_.empty() && arrival_ > last_fault_ && now - last_fault_ > kQuiet) {
    add({.kind = recordings::EventKind::device_back,
         .held = held_,
         .refused_samples = counts_.refused - refused_before_spell_});
    faults_.clear();
  }
}

void DeviceGuard::fault(const char* text, double now) {
  last_fault_ = now, last_fault_text_ = text;
  if (faults_.empty()) held_ = 0, refused_before_spell_ = counts_.refused;
  if (!held_since_) held_since_ = now;
  if (std::find(faults_.begin(), faults_.end(), text) != faults_.end()) return;
  faults_.push_back(text);
  add({.kind = recordings::EventKind::device_lost, .reason = text});
}

/// A device that fails again and again fills no session.
void DeviceGuard::add(recordings::Event event) {
  if (++event_count_ > kMostEvents) return;
  if (event_count_ == kMostEvents)
    event = {.kind = recordings::EventKind::note, .text = "further faults of the device are only counted"};
  events_.push_back(std::move(event));
}

std::vector<recordings::Event> DeviceGuard::take_events() { return std::exchange(events_, {}); }

}  // namespace ctpm::devices
