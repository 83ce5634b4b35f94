#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/devices/device.h"
#include "studio/devices/device_guard.h"
#include "studio/devices/device_map.h"
#include "studio/devices/unit_watch.h"
#include "studio/devices/virtual_coupling.h"
#include "studio/devices/wait_times.h"
#include "studio/sources/input_source.h"

namespace ctpm::devices {

struct DeviceSettings {
  DeviceMap map;
  GuardSettings guard;
  CouplingSettings coupling;
  double most_force = 3;         ///< largest force sent to the device [N], > 0
  bool may_mean_metres = false;  ///< it sends numbers without a unit, which its maker may take for metres
};

/// A device as the source of a session. Its samples are checked, mapped into the scene and interpolated over the ticks
/// between them. The tool follows through a virtual coupling, whose force is sent back to the device.
class DeviceSource : public sources::InputSource {
 public:
  using Clock = std::function<double()>;

  /// `tick` [s]. `clock` must be the clock of the reports' arrival times.
  DeviceSource(std::unique_ptr<Device> device, const DeviceSettings& settings, double tick, Clock clock = device_clock);

  /// Waits for the first good pose. `tell` hears why samples are refused meanwhile, and every 5 s that nothing comes.
  /// False if `should_stop` returned true before.
  bool wait_for_first_pose(const std::function<bool()>& should_stop,
                           const std::function<void(const std::string&)>& tell = {});

  std::optional<Inputs> next(std::int64_t tick, const stepping::StepReport& last) override;
  double input_age() const override { return age_; }
  std::vector<recordings::Event> take_events() override;
  std::vector<recordings::NamedValue> statistics() const override;
  std::string fault() const override { return guard_.verdict(); }

 private:
  bool take_reports(double now);
  void aim(double now);
  void send_force(bool has_new_pose);

  std::unique_ptr<Device> device_;
  DeviceSettings settings_;
  double tick_;  ///< [s]
  Clock clock_;
  DeviceGuard guard_;
  UnitWatch unit_;
  VirtualCoupling coupling_;
  PassiveForce passive_;
  std::int32_t tool_ = -1;
  std::optional<Pose> hand_;     ///< interpolated pose in the scene
  Pose from_, to_;               ///< ends of the interpolation
  std::int64_t ticks_left_ = 0;  ///< of the interpolation
  std::int64_t ticks_whole_ = 1;
  bool saw_fault_ = false;  ///< a report of this tick was refused
  double age_ = 0;
  bool has_ticked_ = false;
  WaitTimes waits_, ways_;  ///< of good poses since the first tick: until their tick; DeviceReport::on_way
  std::int64_t forces_ = 0;
};

}  // namespace ctpm::devices
