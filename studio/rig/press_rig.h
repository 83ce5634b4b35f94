#pragma once

#include <string>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/result.h"
#include "core/stepping/step.h"
#include "studio/rig/printed_table.h"

namespace ctpm::rig {

/// Inputs with which the rig's pin holds C `depth_mm` [mm] below its rest position.
Inputs pressed_to(double depth_mm);

/// The error of a run of `scene` that diverged.
Error diverged(const std::string& scene, const stepping::StepReport& report);

/// Static force at each depth of a rig whose pin holds C [N]. The pin moves at 10 mm/s from depth to depth and waits at
/// each until the spheres beside C, which only numerical damping slows, stop swinging. Error: a step that failed.
Result<std::vector<double>> press_rig(const Model& model, const std::string& name, const std::vector<PrintedRow>& rows);

}  // namespace ctpm::rig
