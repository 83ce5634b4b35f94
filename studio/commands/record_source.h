#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/model/model.h"
#include "core/model/result.h"
#include "scenes/script.h"
#include "studio/devices/open_device.h"
#include "studio/sources/input_source.h"

namespace ctpm::commands {

/// The requested source: at most one of script, motion and device is set.
struct SourceRequest {
  std::string script;  ///< file of a script
  std::string motion;  ///< file of a motion
  devices::DeviceRequest device;
};

/// The flags of the sources, for messages.
inline constexpr const char* source_flags = "--script, --motion, --igtl, --igtl-listen";

/// Adds the flags of all sources.
void add_source(CLI::App& app, SourceRequest& request);

/// Number of requested sources.
int count_of(const SourceRequest& request);

/// A source that is ready for a session.
struct ReadySource {
  std::unique_ptr<sources::InputSource> source;
  devices::DeviceSource* device = nullptr;      ///< the source, if it is a device
  std::map<std::string, std::string> metadata;  ///< what the session stores about its source
};

/// Opens the requested source, or plays `otherwise` if there is none. `device` is the result of open_device(). Prints
/// remarks. Errors: those of the source's file, with places; tools that the scene does not have.
Result<ReadySource> open_source(const SourceRequest& request, devices::OpenedDevice device, const Model& model,
                                const std::optional<scenes::Script>& otherwise);

}  // namespace ctpm::commands
