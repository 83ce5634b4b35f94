#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "studio/devices/device.h"
#include "studio/sources/input_source.h"

namespace ctpm::devices {

struct GuardSettings {
  Vec3 centre;                 ///< of the scene, in the device's frame [m]
  double farthest = INFINITY;  ///< poses farther from there are never accepted [m]
  double most_speed = 1;       ///< of a hand [m/s]; a sample farther from the last good one is a jump
  double slack = 1e-3;         ///< added to the allowed distance, for noise [m]
  double stall_after = 0.1;    ///< a device stalls after this time without a good sample [s]
  double give_up_after = 5;    ///< a device is given up after this time without a good sample [s]
};

/// Accepts or refuses the samples of a device. The first pose is accepted when a second one agrees with it. While none
/// is accepted, the last good pose is held. Refused poses that agree with each other for kForgiven are believed in the
/// end: then the pose that was held was the wrong one. Each kind of fault gives one event when it begins, up to
/// kMostEvents. One more event follows when the device has been good for 0.1 s, however often the faults come and go in
/// between.
class DeviceGuard {
 public:
  explicit DeviceGuard(const GuardSettings& settings) : settings_(settings) {}

  /// Takes the next report. True if it is a good pose.
  bool take(const DeviceReport& report);

  /// A device cannot stall before the time `now`: what came until then waited for the session to begin.
  void watch_from(double now) { watched_from_ = now; }

  /// Checks for stalls and recovery at the time `now`, by device_clock() [s].
  void look(double now);

  bool has_pose() const { return has_pose_; }
  const Pose& pose() const { return pose_; }          ///< last good pose, in the device's frame; unit orientation
  double pose_arrival() const { return arrival_; }    ///< its time of arrival [s]
  double pose_interval() const { return interval_; }  ///< since the good pose before it [s]; 0 for the first
  std::uint32_t buttons() const { return buttons_; }
  /// Whether the good pose lies where no hand could have moved from the one before; true once for each such pose.
  bool take_leap() { return std::exchange(leapt_, false); }
  bool is_held() const { return !faults_.empty(); }  ///< a fault persists, or ended less than 0.1 s ago

  /// Why the device was given up; empty if it was not.
  const std::string& verdict() const { return verdict_; }

  std::vector<recordings::Event> take_events();

  struct Counts {
    std::int64_t samples = 0;      ///< poses received
    std::int64_t refused = 0;      ///< of these, poses that were not accepted
    std::int64_t unread = 0;       ///< messages that could not be read
    std::int64_t turned_away = 0;  ///< connections that were refused
    double longest_gap = 0;        ///< between two good samples [s]
  };
  const Counts& counts() const { return counts_; }

  /// Why the last refused sample was refused, or the connection ended; empty if nothing was.
  const char* last_fault() const { return last_fault_text_; }

  /// A device whose poses are skipped, because another one is asked for; empty: none came.
  const std::string& other_name() const { return other_name_; }

 private:
  static constexpr double kQuiet = 0.1;      ///< a device is back after this time without a fault [s]
  static constexpr double kForgiven = 0.25;  ///< [s]
  static constexpr int kForgivenSamples = 3;
  static constexpr double kMostPause = 0.5;  ///< between samples that agree [s]
  static constexpr double kMostLead = 5;     ///< of a device's clock over ours since the last good sample [s]
  static constexpr int kMostEvents = 1000;   ///< of a session; later faults are only counted
  static constexpr double kNotes = 10;       ///< between two notes of refused connections [s]

  /// Poses that agree with each other, the last of them here, but with no good one.
  struct Track {
    DeviceReport last;
    double since = 0;  ///< [s]
    int count = 0;
  };

  const char* problem_with(const DeviceReport& report) const;
  bool agree(const DeviceReport& before, const DeviceReport& report) const;
  bool follow_track(const DeviceReport& report);
  void accept(const DeviceReport& report);
  void add(recordings::Event event);
  void fault(const char* text, double now);

  GuardSettings settings_;
  bool has_pose_ = false;
  Pose pose_;
  double arrival_ = 0, interval_ = 0, device_time_ = 0, watched_from_ = -INFINITY;
  std::uint32_t buttons_ = 0;
  bool leapt_ = false;
  Track track_;
  const char* last_fault_text_ = "";
  std::string other_name_;
  double last_note_ = -INFINITY;
  int event_count_ = 0;
  std::vector<const char*> faults_;   ///< of the current spell of faults, each once
  double last_fault_ = 0, held_ = 0;  ///< held_: from faults of the spell to the next good poses, in all [s]
  std::optional<double> held_since_;  ///< the first fault after the last good pose
  std::int64_t refused_before_spell_ = 0;
  std::string verdict_;
  std::vector<recordings::Event> events_;
  Counts counts_;
};

}  // namespace ctpm::devices
