#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/model/inputs.h"
#include "studio/devices/device.h"
#include "studio/devices/hand_over.h"

namespace ctpm::server {

/// Where a page's message moves a hand.
struct HandMove {
  devices::Pose pose;
  std::uint32_t buttons = 0;
};
/// Those of one message; the second hand may be missing.
using HandMoves = std::array<std::optional<HandMove>, kMostHands>;

/// A hand that a page moves with mouse and keys, as a device: its poses pass the same guard and virtual coupling as
/// those of a device over OpenIGTLink, and are recorded alike.
class PageHand : public devices::Device {
 public:
  /// Takes a message of the page; from one thread. `sent_s` is the page's own time [s], > 0.
  void move(const HandMove& move, double sent_s);

  bool next(devices::DeviceReport& report) override { return reports_.pop(report); }

  /// The page gets forces with its frames.
  void send_force(Vec3) override {}

 private:
  devices::HandOver<devices::DeviceReport, 1024> reports_;
  double clock_offset_ = INFINITY;  ///< device_clock() less the page's time [s]
  std::uint32_t buttons_ = 0;
};

}  // namespace ctpm::server
