#include "recordings/session.h"

namespace ctpm::recordings {

std::string physics_remark(std::int32_t recorded) {
  const std::string present = std::to_string(kPhysicsRevision);
  if (recorded == kPhysicsRevision) return "";
  if (recorded == 0)
    return "recorded before physics revisions were stored, this build computes " + present + "; replay may differ";
  return "recorded with physics revision " + std::to_string(recorded) + ", this build computes " + present +
         "; replay will differ";
}

TickRecord make_record(const Inputs& inputs, const stepping::StepReport& report, double tick_time_s,
                       std::uint64_t state_hash, double input_age_s, double slip_s) {
  TickRecord record;
  record.inputs = inputs;
  record.tool_force = report.tool_force;
  record.depth = report.depth;
  record.status = static_cast<std::int32_t>(report.status);
  record.iterations = report.iterations;
  record.contacts = report.contacts;
  record.severed = report.severed;
  record.tick_time = tick_time_s;
  record.input_age = input_age_s;
  record.slip = slip_s;
  record.state_hash = state_hash;
  record.second = report.second;
  return record;
}

}  // namespace ctpm::recordings
