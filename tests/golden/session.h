#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/stepping/step.h"
#include "recordings/state_hash.h"
#include "tests/core/blocks.h"

namespace ctpm::testing {

/// A ball presses for 200 ticks, then a scalpel cuts through the block.
inline Inputs golden_inputs(int tick) {
  Inputs inputs;
  if (tick < 200) {
    inputs.tool = 0;
    inputs.position = {0.001, -0.002, 0.048 + 0.012 - 0.00008 * tick};
  } else {
    inputs.tool = 1;
    inputs.position = {0.0007, -0.05 + 0.0005 * (tick - 200), 0.020};
  }
  return inputs;
}

/// Results of a golden session.
struct GoldenRun {
  std::array<std::uint64_t, 4> hash{};  ///< of State after each quarter
  std::int32_t severed = 0, contacts = 0;
  bool is_good = true;  ///< every tick's status is ok or not_converged
};

/// Simulates `ticks` ticks, sampled evenly from the golden session, of a block of ni x nj x nk spheres.
inline GoldenRun run_golden(int ni, int nj, int nk, int ticks, network::Structure structure,
                            std::optional<Integrator> integrator, const stepping::StepperOptions& options = {}) {
  Model model = make_block_model(ni, nj, nk, structure);
  model.gravity = {0, 0, -9.81};
  model.tools = {ball(0.006), scalpel(0.06)};
  model.solver = {};
  stepping::resolve_integrator(model, integrator);
  State state = rest_state(model);
  stepping::Stepper stepper(model, options);
  GoldenRun run;
  for (int tick = 0; tick < ticks; ++tick) {
    const stepping::StepReport report = stepper.step(state, golden_inputs(tick * 400 / ticks));
    run.is_good = run.is_good && report.status <= stepping::StepStatus::not_converged;
    run.severed += report.severed, run.contacts += report.contacts;
    if ((tick + 1) % (ticks / 4) == 0) run.hash[std::size_t(tick / (ticks / 4))] = recordings::state_hash(state);
  }
  return run;
}

}  // namespace ctpm::testing
