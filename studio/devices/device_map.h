#pragma once

#include <cstdint>
#include <vector>

#include "studio/devices/device.h"

namespace ctpm::devices {

/// A tool that is in the hand while a button is pressed.
struct ButtonTool {
  int button = 0;          ///< in [0, 31]
  std::int32_t tool = -1;  ///< index into Model::tools; -1: no tool
};

/// How a device's frame lies in the scene, and which tool its instrument is.
struct DeviceMap {
  double scale = 1;                      ///< scene metres for a metre of the hand, > 0
  Quat scene_from_device;                ///< unit length
  Vec3 offset;                           ///< where the device's origin lies in the scene [m]
  Vec3 tip{0, 0, -1};                    ///< from handle to tip in the instrument's own frame; unit length
  std::int32_t tool = -1;                ///< without a button; -1: none
  std::vector<ButtonTool> button_tools;  ///< the first whose button is pressed counts

  /// The tool frame in the scene; its -z points where the instrument's tip does.
  Pose to_scene(const Pose& device) const;

  /// A force of the scene in the device's frame [N]. Not scaled: what is felt is the tool's force.
  Vec3 to_device(Vec3 force) const;

  std::int32_t tool_for(std::uint32_t buttons) const;
};

}  // namespace ctpm::devices
