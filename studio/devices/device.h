#pragma once

#include <array>
#include <cstdint>

#include "core/model/vec3.h"

namespace ctpm::devices {

/// Position and orientation of the instrument.
struct Pose {
  Vec3 position;     ///< [m]
  Quat orientation;  ///< unit length after DeviceGuard

  friend bool operator==(const Pose&, const Pose&) = default;
};

enum class DeviceNews : std::int32_t {
  pose,         ///< `pose` was measured
  buttons,      ///< `buttons` are pressed now
  connected,    ///< a device is connected
  lost,         ///< the connection ended; `text` says why
  turned_away,  ///< a second device tried to connect and was refused
  bad_message,  ///< a message could not be read; `text` says why
  other_name,   ///< a pose of another device than the one that is asked for came for the first time: of `name`
};

/// One message of a device, or one change of its connection.
struct DeviceReport {
  DeviceNews news = DeviceNews::pose;
  double arrival = 0;           ///< time of arrival, by device_clock(); had it been as quick as the quickest [s]
  double on_way = 0;            ///< how long it took longer than the quickest one until it was read [s]; 0: unknown
  double device_time = 0;       ///< time of measurement, by the device's own clock [s]; 0: unknown
  Pose pose;                    ///< in the device's frame, unchecked: may be non-finite
  std::uint32_t buttons = 0;    ///< bit set
  const char* text = "";        ///< static storage
  std::array<char, 21> name{};  ///< ends with a zero
};

/// Seconds of a monotonic clock of arbitrary origin.
double device_clock();

/// A device that a thread of its own reads. Call both functions from the thread of the ticks; they never wait.
class Device {
 public:
  virtual ~Device() = default;

  /// Takes the next report in order of arrival; false if there is none.
  virtual bool next(DeviceReport& report) = 0;

  /// Sends `force` [N], in the device's frame, to the hand.
  virtual void send_force(Vec3 force) = 0;
};

}  // namespace ctpm::devices
