#pragma once

#include "core/model/model.h"
#include "scenes/scene_spec.h"

namespace ctpm::server {

/// What a hand bears that the page leads, before it gives way; see devices::CouplingSettings. A mouse does not push
/// back.
struct HandLimits {
  double force_n = 20;
  double depth_m = 0;  ///< of the tool in tissue; 0: none
};

/// Twice what the scene counts as damage, so that a trainee can go too far, and sees it. Where the scene does not say,
/// 15 N, and half of how thick its organs are: nobody is led through one.
HandLimits limits_of_hand(const scenes::SceneSpec& scene, const Model& model);

}  // namespace ctpm::server
