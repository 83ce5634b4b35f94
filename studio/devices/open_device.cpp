#include "studio/devices/open_device.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "core/model/errors.h"
#include "core/stepping/step.h"
#include "studio/devices/igtl_link.h"
#include "studio/output/option_name.h"
#include "studio/sources/rotation.h"

namespace ctpm::devices {
namespace {

/// A whole number in [low, high] that is all of `text`.
std::optional<int> whole_number(std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || value < low || value > high) return std::nullopt;
  return value;
}

struct Address {
  std::string host;
  int port;
};

/// HOST:PORT, with an IPv6 address in brackets.
std::optional<Address> address_of(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  std::string host = text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  const auto port = whole_number(std::string_view(text).substr(colon + 1), 1, 65535);
  if (!port) return std::nullopt;
  return Address{host, *port};
}

Result<std::int32_t> tool_index(const std::string& field, const std::string& name, const Model& model) {
  std::string known;
  for (std::size_t i = 0; i < model.tools.size(); ++i) {
    if (model.tools[i].name == name) return std::int32_t(i);
    known += (known.empty() ? "" : ", ") + model.tools[i].name;
  }
  return Error{output::option_name(field), "the scene has no tool '" + name + "'",
               known.empty() ? "the scene has no tools" : "its tools: " + known};
}

Vec3 vector_of(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

/// Name of a field in errors; the second hand has its own of some.
std::string field_of(const DeviceRequest& request, const std::string& field) {
  return (request.hand == 0 ? "device." : "second.") + field;
}

Result<DeviceMap> map_of(const DeviceRequest& request, const Model& model) {
  DeviceMap map;
  Errors errors;
  const auto find = [&](const std::string& field, const std::string& name) {
    const Result<std::int32_t> index = tool_index(field, name, model);
    if (index) return *index;
    errors.push_back(index.errors().front());
    return std::int32_t(-1);
  };
  map.scale = request.scale;
  if (!request.offset_mm.empty()) map.offset = 1e-3 * vector_of(request.offset_mm);
  if (const auto& q = request.rotation; !q.empty())
    map.scene_from_device = sources::normalised({q[0], q[1], q[2], q[3]});
  if (!request.tip.empty()) map.tip = vector_of(request.tip) / norm(vector_of(request.tip));
  if (!request.tool.empty())
    map.tool = find(field_of(request, "tool"), request.tool);
  else if (model.tools.size() <= request.hand)
    errors.push_back({output::option_name(field_of(request, "tool")),
                      request.hand == 0 ? "the scene has no tools" : "the scene has no second tool", ""});
  else
    map.tool = std::int32_t(request.hand);
  for (const std::string& entry : request.buttons) {
    const std::size_t equals = entry.find('=');
    const std::string tool = entry.substr(equals + 1);
    map.button_tools.push_back(
        {*whole_number(entry.substr(0, equals), 0, 31), tool.empty() ? -1 : find(field_of(request, "buttons"), tool)});
  }
  if (!errors.empty()) return errors;
  return map;
}

/// Poses beyond ten times the size of the scene are no hand's.
void limit_reach(DeviceSettings& settings, const Model& model) {
  constexpr double kTimes = 10, kLeast = 1;  // [1], [m]
  if (model.rest_position.x.empty()) return;
  Vec3 low = model.rest_position[0], high = low;
  for (std::size_t i = 1; i < model.sphere_count(); ++i) {
    const Vec3 p = model.rest_position[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const DeviceMap& map = settings.map;
  const Vec3 centre = 0.5 * (low + high);
  settings.guard.centre = (1 / map.scale) * rotate(sources::inverse(map.scene_from_device), centre - map.offset);
  settings.guard.farthest = kTimes * std::max(kLeast, norm(high - low)) / map.scale;
}

/// The device's map into the scene as session metadata.
std::string describe(const DeviceRequest& request, const DeviceMap& map) {
  char text[512];
  const Quat q = map.scene_from_device;
  std::snprintf(text, sizeof text,
                "scale %.9g, offset_mm %.9g %.9g %.9g, rotation %.9g %.9g %.9g %.9g, tip %.9g %.9g %.9g, "
                "most_force_n %.9g, stiffness_n_per_m %.9g, gives_way_n %.9g, gives_way_mm %.9g",
                map.scale, map.offset.x * 1e3, map.offset.y * 1e3, map.offset.z * 1e3, q.w, q.x, q.y, q.z, map.tip.x,
                map.tip.y, map.tip.z, request.most_force_n, request.stiffness_n_per_m, request.gives_way_n,
                request.gives_way_mm);
  return text;
}

}  // namespace

bool asks_for_device(const DeviceRequest& request) {
  return !request.address.empty() || request.listen_port.has_value();
}

Errors check_device(const DeviceRequest& request) {
  Errors errors;
  const auto need = [&](bool holds, const std::string& field, const std::string& message) {
    if (!holds) errors.push_back({output::option_name(field), message, ""});
  };
  const auto own = [&](const char* field) { return field_of(request, field); };
  const auto are_finite = [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::abs(x) <= 1e6; });
  };
  const auto is_within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!request.address.empty())
    need(address_of(request.address).has_value(), own("address"), "got '" + request.address + "', must be HOST:PORT");
  if (request.listen_port)
    need(is_within(*request.listen_port, 0, 65535), own("listen_port"), "must be a port in [0, 65535]");
  for (const std::string& entry : request.buttons) {
    const std::size_t equals = entry.find('=');
    need(equals != std::string::npos && whole_number(entry.substr(0, equals), 0, 31), own("buttons"),
         "got '" + entry + "', must be BUTTON=TOOL with a button in [0, 31]");
  }
  const Result<AddressList> allowed = AddressList::read(request.allowed);
  if (!allowed)
    for (const Error& error : allowed.errors()) need(false, "device.allowed", error.message);
  const bool is_own =
      request.interface == "localhost" || request.interface == "::1" || request.interface.starts_with("127.");
  need(!request.listen_port || is_own || !request.allowed.empty(), "device.allowed",
       "name the addresses that may connect, because others than this machine's own are listened on");
  need(is_within(request.scale, 1e-3, 1e3), "device.scale", "must be in [0.001, 1000]");
  need(are_finite(request.offset_mm), own("offset_mm"), "must be in [-1e6, 1e6]");
  need(are_finite(request.rotation) &&
           (request.rotation.empty() || sources::length_of({request.rotation[0], request.rotation[1],
                                                            request.rotation[2], request.rotation[3]}) > 1e-3),
       own("rotation"), "must be a quaternion w x y z of any length but zero");
  need(are_finite(request.tip) && (request.tip.empty() || norm(vector_of(request.tip)) > 1e-3), own("tip"),
       "must be a direction of any length but zero");
  need(is_within(request.most_speed_mm_per_s, 1, 1e5), "device.most_speed_mm_per_s", "must be in [1, 100000]");
  need(is_within(request.timeout_s, 0.2, 1e5), "device.timeout_s", "must be in [0.2, 100000]");
  need(is_within(request.most_force_n, 0.001, 1000), "device.most_force_n", "must be in [0.001, 1000]");
  need(is_within(request.stiffness_n_per_m, 1, 1e5), "device.stiffness_n_per_m", "must be in [1, 100000]");
  return errors;
}

Result<OpenedDevice> open_device(const DeviceRequest& request) {
  IgtlSettings settings;
  settings.device_name = request.name;
  OpenedDevice opened;
  if (request.listen_port) {
    settings.listens = true, settings.host = request.interface, settings.port = *request.listen_port;
    if (const Result<AddressList> allowed = AddressList::read(request.allowed)) settings.allowed = *allowed;
  } else if (const auto address = address_of(request.address)) {
    settings.host = address->host, settings.port = address->port;
  } else {
    return opened;
  }
  Result<std::unique_ptr<IgtlLink>> link = IgtlLink::open(settings);
  if (!link) return link.errors();
  opened.place = (settings.listens ? "waiting for a device on " : "connected; waiting for a pose from ") +
                 settings.host + ":" + std::to_string((*link)->port());
  opened.device = std::move(*link);
  return opened;
}

Result<FollowedDevice> follow_device(const DeviceRequest& request, std::unique_ptr<Device> device, const Model& model) {
  const Result<DeviceMap> map = map_of(request, model);
  if (!map) return map.errors();
  DeviceSettings settings;
  settings.map = *map;
  settings.guard.most_speed = 1e-3 * request.most_speed_mm_per_s;
  settings.guard.give_up_after = request.timeout_s;
  limit_reach(settings, model);
  settings.coupling.stiffness = request.stiffness_n_per_m;
  settings.coupling.most_force = request.gives_way_n, settings.coupling.most_depth = 1e-3 * request.gives_way_mm;
  settings.most_force = request.most_force_n;
  settings.may_mean_metres = asks_for_device(request);
  FollowedDevice followed;
  followed.source = std::make_unique<DeviceSource>(std::move(device), settings, model.tick);
  followed.metadata = {{"source", request.listen_port ? "igtl-listen" : "igtl"}, {"device", describe(request, *map)}};
  return followed;
}

DeviceRequest as_second_hand(DeviceRequest request, const DeviceRequest& first) {
  request.hand = 1;
  request.interface = first.interface, request.allowed = first.allowed, request.scale = first.scale;
  request.most_speed_mm_per_s = first.most_speed_mm_per_s, request.timeout_s = first.timeout_s;
  request.most_force_n = first.most_force_n, request.stiffness_n_per_m = first.stiffness_n_per_m;
  request.gives_way_n = first.gives_way_n, request.gives_way_mm = first.gives_way_mm;
  return request;
}

Errors check_second_hand(std::int32_t hands) {
  if (hands >= 2) return {};
  return {{output::option_name("second.address"), "the scene has one hand", "write \"hands\": 2 in the scene"}};
}

Result<FollowedPair> follow_devices(const DeviceRequest& first, std::unique_ptr<Device> first_device,
                                    const DeviceRequest& second, std::unique_ptr<Device> second_device,
                                    const Model& model) {
  Errors errors = check_second_hand(model.hands);
  Result<FollowedDevice> a = follow_device(first, std::move(first_device), model);
  Result<FollowedDevice> b = follow_device(second, std::move(second_device), model);
  for (const auto* followed : {&a, &b}) append(errors, *followed);
  if (!errors.empty()) return errors;
  const bool may_change = !first.buttons.empty() || !second.buttons.empty();
  const std::string conflict(stepping::hands_conflict(model, map_of(first, model)->tool, map_of(second, model)->tool));
  if (!conflict.empty() && !may_change)
    return Error{output::option_name("second.tool"), conflict, "give the second hand another tool"};
  FollowedPair pair;
  pair.source = std::make_unique<DevicePair>(std::move(a->source), std::move(b->source), model);
  pair.metadata = std::move(a->metadata);
  for (const auto& [key, value] : b->metadata) pair.metadata["second_" + key] = value;
  return pair;
}

}  // namespace ctpm::devices
