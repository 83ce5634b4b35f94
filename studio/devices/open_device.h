#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "studio/devices/device_source.h"

namespace ctpm {

/// A device as a user describes it: texts are checked when it is opened.
struct DeviceRequest {
  std::string address;                           ///< HOST:PORT to connect to
  std::optional<int> listen_port;                ///< or a port to listen on; 0: any that is free
  std::string interface = "127.0.0.1";           ///< to listen on
  std::string name;                              ///< of the device whose poses are taken; empty: all
  std::string tool;                              ///< without a button; empty: the scene's first
  std::vector<std::string> buttons;              ///< each BUTTON=TOOL; without a tool: none is in the hand
  double scale = 1;                              ///< scene millimetres for a millimetre of the hand
  std::vector<double> offset_mm, rotation, tip;  ///< three, four (w x y z) and three numbers; or none
  double most_speed_mm_per_s = 1000, timeout_s = 5;
  double most_force_n = 3, stiffness_n_per_m = 1000;
};

/// True if an address or a port is given.
bool asks_for_device(const DeviceRequest& request);

/// What is wrong with the description of the device by itself; without a device, nothing.
Errors check_device(const DeviceRequest& request);

/// A device that is connected, or for which is waited, before anybody knows the scene. Errors: nobody is there, the
/// port is in use.
struct OpenedDevice {
  std::unique_ptr<Device> device;  ///< none if none is asked for
  std::string place;               ///< "connected to ..." or "waiting on ..."
};
Result<OpenedDevice> open_device(const DeviceRequest& request);

/// A device as the source of a session.
struct FollowedDevice {
  std::unique_ptr<DeviceSource> source;
  std::map<std::string, std::string> metadata;  ///< what the session stores about the device
};
/// Follows `device` in the scene of `model`. Errors: tools that the scene does not have.
Result<FollowedDevice> follow_device(const DeviceRequest& request, std::unique_ptr<Device> device, const Model& model);

}  // namespace ctpm
