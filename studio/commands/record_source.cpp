#include "studio/commands/record_source.h"

#include <utility>

#include "core/model/errors.h"
#include "studio/commands/console.h"
#include "studio/sources/open_file.h"

namespace ctpm::commands {
namespace {

constexpr const char* kDeviceGroup = "Devices (studio/devices/README.md)";

/// Those that the second hand has of its own; it shares the others with the first.
void add_second_device_options(CLI::App& app, devices::DeviceRequest& device) {
  const auto add = [&](const char* name, auto& value, const char* what) {
    return app.add_option(name, value, what)->group(kDeviceGroup);
  };
  add("--igtl-second", device.address, "A second server, for the second hand of a scene with two");
  add("--igtl-second-listen", device.listen_port, "Waits on this port for the client of the second hand instead");
  add("--igtl-second-name", device.name, "As --igtl-name, for the second hand");
  add("--device-second-tool", device.tool, "Tool in the second hand; the scene's second if not given");
  add("--device-second-button", device.buttons, "As --device-button, for the second hand");
  add("--device-second-offset-mm", device.offset_mm, "As --device-offset-mm, for the second hand")->expected(3);
  add("--device-second-rotation", device.rotation, "As --device-rotation, for the second hand")->expected(4);
  add("--device-second-tip", device.tip, "As --device-tip, for the second hand")->expected(3);
}

void add_device_options(CLI::App& app, devices::DeviceRequest& device) {
  const auto add = [&](const char* name, auto& value, const char* what) {
    return app.add_option(name, value, what)->group(kDeviceGroup);
  };
  add("--igtl", device.address, "Takes what the hand does from an OpenIGTLink server, HOST:PORT");
  add("--igtl-listen", device.listen_port, "Waits on this port for an OpenIGTLink client; 0: any that is free");
  add("--igtl-bind", device.interface,
      "Address of this machine to listen on; others than this machine's own let in "
      "whoever can reach it")
      ->capture_default_str();
  add("--igtl-allow", device.allowed,
      "Address that may connect, alone or as 192.168.1.0/24; needed beyond this machine");
  add("--igtl-name", device.name, "Takes poses of the device of this name alone");
  add("--device-tool", device.tool, "Tool in the hand; the scene's first if not given");
  add("--device-button", device.buttons, "BUTTON=TOOL: while the button is pressed, this tool is; none after =");
  add("--device-scale", device.scale, "Millimetres in the scene for one of the hand")->capture_default_str();
  add("--device-offset-mm", device.offset_mm, "Where the device's origin lies in the scene: x y z")->expected(3);
  add("--device-rotation", device.rotation, "How the device's frame is turned in the scene: w x y z")->expected(4);
  add("--device-tip", device.tip, "Direction from handle to tip in the instrument's frame: x y z; 0 0 -1 if not given")
      ->expected(3);
  add("--device-force-n", device.most_force_n, "Largest force that is sent back")->capture_default_str();
  add("--device-stiffness-n-per-m", device.stiffness_n_per_m, "Of the spring between hand and tool")
      ->capture_default_str();
  add("--device-speed-mm-per-s", device.most_speed_mm_per_s, "A hand that moves faster is taken for a jump")
      ->capture_default_str();
  add("--device-timeout-s", device.timeout_s, "Ends the session when nothing usable came for so long")
      ->capture_default_str();
}

}  // namespace

void add_source(CLI::App& app, SourceRequest& request) {
  app.add_option("--script", request.script,
                 "What the hand does (.json); without any source, a press and a cut at the organ's top");
  app.add_option("--motion", request.motion,
                 "What a hand did (.csv): time_s, tool_x_mm, tool_y_mm, tool_z_mm, and tool_qw to tool_qz, "
                 "buttons, tool; at any rate");
  add_device_options(app, request.device);
  add_second_device_options(app, request.second);
}

std::vector<std::string> given_device_flags(const CLI::App& app) {
  std::vector<std::string> given;
  for (const CLI::Option* option : app.get_options())
    if (option->get_group() == kDeviceGroup && option->count() > 0) given.push_back(option->get_name());
  return given;
}

Result<OpenedDevices> open_devices(const SourceRequest& request) {
  OpenedDevices opened;
  Errors errors;
  for (std::size_t hand = 0; hand < kMostHands; ++hand) {
    Result<devices::OpenedDevice> device = devices::open_device(hand == 0 ? request.device : second_of(request));
    if (device)
      opened[hand] = std::move(*device);
    else
      append(errors, device);
  }
  if (!errors.empty()) return errors;
  return opened;
}

devices::DeviceRequest second_of(const SourceRequest& request) {
  return devices::as_second_hand(request.second, request.device);
}

int count_of(const SourceRequest& request) {
  return int(!request.script.empty()) + int(!request.motion.empty()) + int(!request.device.address.empty()) +
         int(request.device.listen_port.has_value());
}

Result<ReadySource> open_source(const SourceRequest& request, OpenedDevices devices, const Model& model,
                                const scenes::SceneSpec& scene, const std::optional<scenes::Script>& otherwise) {
  if (devices[1].device) {
    Result<devices::FollowedPair> pair = devices::follow_devices(
        request.device, std::move(devices[0].device), second_of(request), std::move(devices[1].device), model);
    if (!pair) return pair.errors();
    devices::DevicePair& source = *pair->source;
    return ReadySource{
        std::move(pair->source),
        {{&source.of_hand(0), devices[0].place}, {&source.of_hand(1), "second hand: " + devices[1].place}},
        std::move(pair->metadata)};
  }
  if (devices[0].device) {
    Result<devices::FollowedDevice> followed =
        devices::follow_device(request.device, std::move(devices[0].device), model);
    if (!followed) return followed.errors();
    devices::DeviceSource* source = followed->source.get();
    return ReadySource{std::move(followed->source), {{source, devices[0].place}}, std::move(followed->metadata)};
  }
  if (otherwise) print_remark("no source is given: pressing and cutting at the top of the first organ");
  Result<sources::OpenedSource> opened =
      otherwise                ? sources::play_script(*otherwise, model)
      : request.script.empty() ? sources::open_motion(request.motion, model)
                               : sources::read_script_source(request.script_text, request.script, model, scene);
  if (!opened) return opened.errors();
  for (const std::string& remark : opened->remarks) print_remark(remark);
  return ReadySource{std::move(opened->source), {}, std::move(opened->metadata)};
}

}  // namespace ctpm::commands
