#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "studio/devices/device_pair.h"
#include "studio/devices/device_source.h"

namespace ctpm::devices {

/// A device as a user describes it. check_device() checks it.
struct DeviceRequest {
  std::string address;                           ///< HOST:PORT to connect to; empty: none
  std::optional<int> listen_port;                ///< port to listen on instead; 0: any free port
  std::string interface = "127.0.0.1";           ///< address to listen on
  std::vector<std::string> allowed;              ///< addresses that may connect, as AddressList reads them; empty: all
  std::string name;                              ///< takes only poses of this name; empty: all poses
  std::string tool;                              ///< tool without a button; empty: the scene's first, or second
  std::vector<std::string> buttons;              ///< each BUTTON=TOOL; BUTTON= alone: no tool
  double scale = 1;                              ///< scene length over hand length [1], in [0.001, 1000]
  std::vector<double> offset_mm, rotation, tip;  ///< 3, 4 (w x y z) and 3 numbers, or none
  double most_speed_mm_per_s = 1000, timeout_s = 5;
  double most_force_n = 3, stiffness_n_per_m = 1000;
  double gives_way_n = 20, gives_way_mm = 0;  ///< see CouplingSettings: most_force, most_depth
  std::size_t hand = 0;                       ///< in Inputs
};

/// The description of a device for the second hand: `request`, with what both hands share taken from `first`: where to
/// listen and who may connect, scale, speed, timeout, force and stiffness.
DeviceRequest as_second_hand(DeviceRequest request, const DeviceRequest& first);

/// What is wrong with a device for the second hand of a scene whose hands are so many; nothing if there are two.
Errors check_second_hand(std::int32_t hands);

/// True if an address or a port is given.
bool asks_for_device(const DeviceRequest& request);

/// Checks a description by itself, before the scene is known. Errors name the fields as "device.FIELD", those of the
/// second hand that are its own as "second.FIELD".
Errors check_device(const DeviceRequest& request);

/// A device that is connected or awaited; the scene is not yet known.
struct OpenedDevice {
  std::unique_ptr<Device> device;  ///< null if none is requested
  std::string place;               ///< "connected to ..." or "waiting on ..."
};
/// Connects or listens. Errors: no server answers; the port is in use.
Result<OpenedDevice> open_device(const DeviceRequest& request);

/// A device as the source of a session.
struct FollowedDevice {
  std::unique_ptr<DeviceSource> source;
  std::map<std::string, std::string> metadata;  ///< what the session stores about the device
};
/// Makes `device` a source for the scene of `model`. Errors: tools that the scene does not have.
Result<FollowedDevice> follow_device(const DeviceRequest& request, std::unique_ptr<Device> device, const Model& model);

/// Two devices as the source of a session.
struct FollowedPair {
  std::unique_ptr<DevicePair> source;
  std::map<std::string, std::string> metadata;  ///< those of the second hand's device begin with "second_"
};
/// The same for both hands; `model` must outlive the source. Errors: also a scene with one hand, or tools that two
/// hands cannot hold at once.
Result<FollowedPair> follow_devices(const DeviceRequest& first, std::unique_ptr<Device> first_device,
                                    const DeviceRequest& second, std::unique_ptr<Device> second_device,
                                    const Model& model);

}  // namespace ctpm::devices
