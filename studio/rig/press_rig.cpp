#include "studio/rig/press_rig.h"

#include <algorithm>

namespace ctpm::rig {

Inputs pressed_to(double depth_mm) {
  Inputs inputs;
  inputs.tool = 0;
  inputs.position = {0, 0, -depth_mm * 1e-3};
  return inputs;
}

Error diverged(const std::string& scene, const stepping::StepReport& report) {
  return {scene, "the run diverged at sphere " + std::to_string(report.worst_sphere), ""};
}

Result<std::vector<double>> press_rig(const Model& model, const std::string& name,
                                      const std::vector<PrintedRow>& rows) {
  constexpr double kSpeed = 10, kHold = 12;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  std::vector<double> force;
  double depth = 0;
  for (const PrintedRow& row : rows) {
    stepping::StepReport report;
    for (double held = 0; held < kHold; held += depth < row.depth ? 0 : model.tick) {
      depth = std::min(row.depth, depth + kSpeed * model.tick);
      report = stepper.step(state, pressed_to(depth));
      if (report.status != stepping::StepStatus::ok) return diverged(name, report);
    }
    force.push_back(report.tool_force.z);
  }
  return force;
}

}  // namespace ctpm::rig
