#pragma once

#include <cstdint>

#include "core/model/vec3.h"

namespace ctpm::devices {

/// Where a hand's instrument is and how it is turned.
struct Pose {
  Vec3 position;     ///< [m]
  Quat orientation;  ///< of unit length once it was checked

  friend bool operator==(const Pose&, const Pose&) = default;
};

enum class DeviceNews : std::int32_t {
  pose,         ///< `pose` was measured
  buttons,      ///< `buttons` are pressed now
  connected,    ///< somebody is there
  lost,         ///< nobody is there any more; `text` says why
  turned_away,  ///< somebody else came as well and was turned away
  bad_message,  ///< what came could not be read; `text` says why
};

/// One thing that a device told or that happened to it.
struct DeviceReport {
  DeviceNews news = DeviceNews::pose;
  double arrival = 0;         ///< when it came, by device_clock() [s]
  double device_time = 0;     ///< when it was measured, by the device's own clock [s]; 0: it does not say
  Pose pose;                  ///< in the device's frame, as it was told: perhaps not even finite
  std::uint32_t buttons = 0;  ///< bit set
  const char* text = "";      ///< lives for ever
};

/// Seconds of a clock that never jumps; any origin.
double device_clock();

/// A device that is being read by a thread of its own. Both calls belong to the tick's thread and never wait.
class Device {
 public:
  virtual ~Device() = default;

  /// The next report in the order they came; false if there is none.
  virtual bool next(DeviceReport& report) = 0;

  /// Hands `force` [N], in the device's frame, to the one who holds the instrument.
  virtual void send_force(Vec3 force) = 0;
};

}  // namespace ctpm::devices
