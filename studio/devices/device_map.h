#pragma once

#include <cstdint>
#include <vector>

#include "studio/devices/device.h"

namespace ctpm::devices {

/// A tool that is held while a button is pressed.
struct ButtonTool {
  int button = 0;          ///< in [0, 31]
  std::int32_t tool = -1;  ///< index into Model::tools; -1: no tool
};

/// The map from the device's frame to the scene, and the tool that its instrument holds.
struct DeviceMap {
  double scale = 1;                      ///< scene length over hand length [1], > 0
  Quat scene_from_device;                ///< unit length
  Vec3 offset;                           ///< the device's origin in the scene [m]
  Vec3 tip{0, 0, -1};                    ///< from handle to tip in the instrument's own frame; unit length
  std::int32_t tool = -1;                ///< without a button; -1: none
  std::vector<ButtonTool> button_tools;  ///< the first with a pressed button is used

  /// The tool frame in the scene; its -z points in the direction of the instrument's tip.
  Pose to_scene(const Pose& device) const;

  /// A scene force in the device's frame [N], rotated but not scaled: the hand feels the tool's force.
  Vec3 to_device(Vec3 force) const;

  std::int32_t tool_for(std::uint32_t buttons) const;
};

}  // namespace ctpm::devices
