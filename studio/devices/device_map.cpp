#include "studio/devices/device_map.h"

#include "studio/sources/rotation.h"

namespace ctpm::devices {

Pose DeviceMap::to_scene(const Pose& device) const {
  const Quat instrument_from_tool = sources::shortest_turn({0, 0, -1}, tip);
  return {offset + rotate(scene_from_device, scale * device.position),
          sources::normalised(
              sources::product(scene_from_device, sources::product(device.orientation, instrument_from_tool)))};
}

Vec3 DeviceMap::to_device(Vec3 force) const { return rotate(sources::inverse(scene_from_device), force); }

std::int32_t DeviceMap::tool_for(std::uint32_t buttons) const {
  for (const ButtonTool& entry : button_tools)
    if (buttons >> entry.button & 1u) return entry.tool;
  return tool;
}

}  // namespace ctpm::devices
