#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studio/devices/device.h"
#include "studio/sources/input_source.h"

namespace ctpm::devices {

struct GuardSettings {
  double most_speed = 1;     ///< of a hand [m/s]; farther than it reaches since the last good sample is a jump
  double slack = 1e-3;       ///< noise that is no jump [m]
  double stall_after = 0.1;  ///< without a good sample for so long, a device stalls [s]
  double give_up_after = 5;  ///< and after so long it is lost for good [s]
};

/// Decides which samples of a device are believed. While none is, the last good pose is held. A fault is noted once
/// when it begins and once when the device was good again for a while, however often it comes and goes in between.
class DeviceGuard {
 public:
  explicit DeviceGuard(const GuardSettings& settings) : settings_(settings) {}

  /// Takes the next report. True if it is a good pose.
  bool take(const DeviceReport& report);

  /// Looks at the time `now`, by device_clock() [s].
  void look(double now);

  bool has_pose() const { return has_pose_; }
  const Pose& pose() const { return pose_; }          ///< the last good one, in the device's frame; unit orientation
  double pose_arrival() const { return arrival_; }    ///< when it came [s]
  double pose_interval() const { return interval_; }  ///< from the good one before to it [s]; 0 for the first
  std::uint32_t buttons() const { return buttons_; }
  bool is_held() const { return !faults_.empty(); }  ///< a fault goes on, or is just over

  /// Why the device is given up; empty as long as it is not.
  const std::string& verdict() const { return verdict_; }

  std::vector<recordings::Event> take_events();

  struct Counts {
    std::int64_t samples = 0;  ///< poses that came
    std::int64_t refused = 0;  ///< of them, not believed
    std::int64_t unread = 0;   ///< messages that could not be read
    double longest_gap = 0;    ///< between two good samples [s]
  };
  const Counts& counts() const { return counts_; }

 private:
  static constexpr double kQuiet = 0.1;  ///< good for so long, a device is back [s]

  const char* problem_with(const DeviceReport& report) const;
  void fault(const char* text, double now);

  GuardSettings settings_;
  bool has_pose_ = false;
  Pose pose_;
  double arrival_ = 0, interval_ = 0, device_time_ = 0;
  std::uint32_t buttons_ = 0;
  std::vector<const char*> faults_;  ///< of the spell that goes on, each once
  double spell_began_ = 0, last_fault_ = 0;
  std::int64_t refused_before_spell_ = 0;
  std::string verdict_;
  std::vector<recordings::Event> events_;
  Counts counts_;
};

}  // namespace ctpm::devices
