#pragma once

#include "scenes/scene_spec.h"
#include "studio/rig/closed_forms.h"

namespace ctpm::rig {

/// The contact site of the closed forms with an organ's material, in the paper's units.
Site site_of(const scenes::OrganSpec& organ);

}  // namespace ctpm::rig
