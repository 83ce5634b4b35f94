#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "studio/devices/device_source.h"
#include "studio/session/input_source.h"

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

/// Which source a user asks for: at most one of the script, the motion and the device is set.
struct SourceRequest {
  std::string script;  ///< file of a script
  std::string motion;  ///< file of a motion
  DeviceRequest device;
};

/// The names of the sources, for messages.
inline constexpr const char* source_names = "--script, --motion, --igtl, --igtl-listen";

/// A source that is ready, and what a session remembers of it.
struct OpenedSource {
  std::unique_ptr<InputSource> source;
  DeviceSource* device = nullptr;  ///< the source, if it is a device
  std::map<std::string, std::string> metadata;
};

/// How many sources are asked for.
int count_of(const SourceRequest& request);

bool asks_for_device(const SourceRequest& request);

/// What is wrong with the description of the device by itself; without a device, nothing.
Errors check_device(const DeviceRequest& request);

/// A device that is connected, or for which is waited, before anybody knows the scene. Errors: nobody is there, the
/// port is in use.
struct OpenedDevice {
  std::unique_ptr<Device> device;  ///< none if none is asked for
  std::string place;               ///< "connected to ..." or "waiting on ..."
};
Result<OpenedDevice> open_device(const DeviceRequest& request);

/// Opens the one source that is asked for; `device` is what open_device() gave. Errors: its file cannot be read or is
/// wrong, with places; tools that the scene does not have.
Result<OpenedSource> open_source(const SourceRequest& request, OpenedDevice device, const Model& model);

}  // namespace ctpm
