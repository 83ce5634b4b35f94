#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "scenes/script.h"
#include "studio/devices/open_device.h"
#include "studio/sources/input_source.h"

namespace ctpm::commands {

/// The requested source: at most one of script, motion and device is set.
struct SourceRequest {
  std::string script;       ///< file of a script
  std::string script_text;  ///< of that file, read once: it may be a pipe
  std::string motion;       ///< file of a motion
  devices::DeviceRequest device;
  devices::DeviceRequest second;  ///< of the second hand; only beside `device`
};

/// The flags of the sources, for messages.
inline constexpr const char* source_flags = "--script, --motion, --igtl, --igtl-listen";

/// Adds the flags of all sources.
void add_source(CLI::App& app, SourceRequest& request);

/// The flags of devices that were given, in the order in which they are added.
std::vector<std::string> given_device_flags(const CLI::App& app);

/// Number of requested sources.
int count_of(const SourceRequest& request);

/// The device of each hand; none where none is requested.
using OpenedDevices = std::array<devices::OpenedDevice, kMostHands>;
/// Connects or listens for all requested devices. Errors: those of open_device().
Result<OpenedDevices> open_devices(const SourceRequest& request);

/// The whole description of the second hand's device.
devices::DeviceRequest second_of(const SourceRequest& request);

/// A device that a source follows, and where it is.
struct FollowedPlace {
  devices::DeviceSource* device;
  std::string place;
};

/// A source that is ready for a session.
struct ReadySource {
  std::unique_ptr<sources::InputSource> source;
  std::vector<FollowedPlace> devices;           ///< of the source, by hand; empty if it follows none
  std::map<std::string, std::string> metadata;  ///< what the session stores about its source
};

/// Opens the requested source, or plays `otherwise` if there is none. `devices` is the result of open_devices(). Prints
/// remarks. Errors: those of the source's file, with places; tools that the scene does not have.
Result<ReadySource> open_source(const SourceRequest& request, OpenedDevices devices, const Model& model,
                                const scenes::SceneSpec& scene, const std::optional<scenes::Script>& otherwise);

}  // namespace ctpm::commands
