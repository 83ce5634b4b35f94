#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/contact/open_cuts.h"
#include "core/stepping/step.h"
#include "recordings/state_hash.h"
#include "tests/core/skinned_block.h"

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

/// A scalpel cuts through the block for 200 ticks, then a ball presses into the cut.
inline Inputs touched_cut_inputs(int tick) {
  Inputs inputs = golden_inputs(tick < 200 ? 200 + tick : 0);
  if (tick >= 200) inputs.position = {0.0012, 0.001, 0.048 + 0.012 - 0.00008 * (tick - 200)};
  return inputs;
}

/// A scalpel cuts a slice one sphere thick off the block for 200 ticks, then a ball presses on the slice.
inline Inputs touched_slice_inputs(int tick) {
  Inputs inputs = touched_cut_inputs(tick);
  inputs.position.x = tick < 200 ? 0.0247 : 0.0292;
  if (tick < 200) inputs.position.z = -0.010;
  return inputs;
}

/// As touched_slice_inputs(), but the scalpel leaves a bridge. Tissue that sags keeps some elements in it: it holds,
/// and the slice hangs on it when the ball comes.
inline Inputs touched_tear_inputs(int tick) {
  Inputs inputs = touched_slice_inputs(tick);
  if (tick > 100 && tick < 110) inputs.tool = -1;
  if (tick >= 200) inputs.position.z -= 0.014;
  return inputs;
}

/// As touched_slice_inputs(), but the scalpel leaves a bridge in which no element runs. The slice tears off there, and
/// the ball presses on the tear.
inline Inputs touched_bridge_inputs(int tick) {
  Inputs inputs = touched_slice_inputs(tick);
  if (tick > 104 && tick < 109) inputs.tool = -1;
  if (tick >= 200) inputs.position.x = 0.0255, inputs.position.y = 0.003;
  return inputs;
}

/// A scalpel cuts the block along the middles of spheres for 200 ticks, then a ball presses into the cut.
inline Inputs touched_plane_inputs(int tick) {
  Inputs inputs = touched_cut_inputs(tick);
  if (tick < 200) inputs.position = {-0.05 + 0.0005 * tick, 0, 0.020};
  return inputs;
}

/// A scalpel takes an edge of the block off for 200 ticks, which lies between two of its nodes, then a ball presses.
inline Inputs touched_edge_inputs(int tick) {
  Inputs inputs = touched_cut_inputs(tick);
  if (tick >= 200) return inputs;
  inputs.position = {-0.05756, -0.05 + 0.0005 * tick, 0.01844};
  inputs.world_from_tool = {0.92387953251128674, 0, 0.38268343236508977, 0};  // 45 degrees about y
  return inputs;
}

/// A ball presses, and from tick 100 on a scalpel in the other hand cuts beside it.
inline Inputs two_hands_inputs(int tick) {
  Inputs inputs = golden_inputs(std::min(tick, 150));
  inputs.position.x = 0.012;
  if (tick >= 100) inputs.second = golden_inputs(200 + tick - 100);
  return inputs;
}

/// As golden_inputs(), but the scalpel cuts with its edge ahead, so that its flanks are in the cut.
inline Inputs wedge_inputs(int tick) {
  Inputs inputs = golden_inputs(tick);
  if (tick >= 200) inputs.world_from_tool = {0.70710678118654757, 0, 0, 0.70710678118654757};  // 90 degrees about z
  return inputs;
}

/// A scalpel cuts twice along y and twice along x, so that a column of spheres between the cuts hangs on little.
inline Inputs crumbs_inputs(int tick) {
  constexpr double kFirst = 0.0007, kSecond = 0.0113;
  const double along = -0.05 + 0.001 * (tick % 100), across = tick / 100 % 2 == 0 ? kFirst : kSecond;
  Inputs inputs;
  inputs.tool = 1, inputs.position = {along, across, 0.008};
  if (tick >= 200) return inputs;
  inputs.position = {across, along, 0.008};
  inputs.world_from_tool = {0.70710678118654757, 0, 0, 0.70710678118654757};  // 90 degrees about z
  return inputs;
}

/// A scalpel cuts along y and then aside, for 100 ticks to the left and for 100 to the right: see make_strip_model().
/// Later a ball is in the way of what rises.
inline Inputs strip_inputs(int tick) {
  Inputs inputs;
  if (tick >= 300) inputs.tool = 0, inputs.position = {-0.014, 0.068, 0.07};
  if (tick >= 200) return inputs;
  const double side = tick < 100 ? -1 : 1, along = -0.09 + 0.002 * (tick % 100);
  inputs.tool = 1;
  inputs.position = {side * 0.0009 + 0.0002 + side * 0.9 * std::max(0.0, along - 0.036), std::min(along, 0.036), -0.01};
  return inputs;
}

/// Results of a golden session.
struct GoldenRun {
  std::array<std::uint64_t, 4> hash{};  ///< of State after each quarter
  std::int32_t severed = 0, contacts = 0;
  bool is_good = true;  ///< every tick's status is ok or not_converged
};

/// Two blocks with all features that the golden sessions lack: tissue that resists a blade, under prestrain, whose cut
/// faces meet; a load; a pin, which holds the last quarter.
inline Model make_full_model(int ni, int nj, int nk) {
  network::Material material = liver_material();
  material.fracture_toughness = 150, material.blade_friction = 400, material.prestrain = 0.02;
  Model model = make_block_model(ni, nj, nk, network::Structure::ctpm, material);
  FilledOrgan beside = make_block(3, 3, 3, 0.012);
  for (Vec3& centre : beside.centre) centre.x += 0.2;
  network::OrganSettings settings;
  settings.name = "beside", settings.structure = network::Structure::tpm, settings.material = material;
  CTPM_CHECK(bool(network::add_organ(model, beside, settings)), "a test's own block is valid");
  model.lip_k = model.axial.k[0];
  const auto last = std::int32_t(model.sphere_count()) - 1;
  model.loads.sphere = {last}, model.loads.start = {0.02}, model.loads.ramp = {0.05};
  model.loads.force.push_back({0.05, 0, -0.1});
  model.tools = {ball(0.006), scalpel(0.06), {"pin", ToolKind::pin, 0, 0, last - 4}};
  return model;
}

/// A block that resists a blade, of spheres so light that the blade's force would throw them past it.
inline Model make_light_model(int ni, int nj, int nk) {
  network::Material material = liver_material();
  material.fracture_toughness = 150, material.blade_friction = 400;
  Model model = make_block_model(ni, nj, nk, network::Structure::ctpm, material);
  for (double& mass : model.mass) mass *= 1e-3;
  model.tools = {ball(0.006), scalpel(0.06)};
  return model;
}

/// A block of CTPM that resists inversion with `resistance`; soft enough for leapfrog if `is_soft`.
inline Model make_resisting_model(int ni, int nj, int nk, bool is_soft, double resistance = 10) {
  network::Material material = liver_material();
  if (is_soft) material.viscosity = 5e3, material.stiffness_scale = 0.29;
  Model model = make_block_model(ni, nj, nk, network::Structure::ctpm, material, 0.012, resistance);
  model.tools = {ball(0.006), scalpel(0.06)};
  return model;
}

/// A block with a surface, which the ball touches and grips; soft enough for leapfrog if `is_soft`.
inline Model make_skinned_model(int ni, int nj, int nk, bool is_soft, std::int32_t hands = 1, double edge = 0.003) {
  network::Material material = liver_material();
  if (is_soft) material.viscosity = 5e3, material.stiffness_scale = 0.29;
  Model model = make_skinned_block(ni, nj, nk, network::Structure::ctpm, edge, material, network::Tiling::two_spheres);
  model.tools = {ball(0.006), scalpel(0.06)}, model.hands = hands;
  return model;
}

/// A block in which strip_inputs() cut a strip a seventh of a spacing thick, which no sphere is in. All that is beside
/// it is held; the end that it hangs on rises when both cuts are open, and so it comes under an obstacle that is far
/// from that.
inline Model make_strip_model() {
  constexpr double kBothOpen = 0.1 + 2 * contact::kOpensAfter;  // [s]
  Model model = make_skinned_model(4, 14, 3, false);
  model.obstacles = {{"above", ObstacleKind::box, {0, -0.04, 0.05}, {1, 0, 0, 0}, {0.01, 0.04, 0.01}}};
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    model.held_axes[i] = model.rest_position[i].y < 0.036 ? kAnchored : 0;
    if (model.held_axes[i] == kAnchored) continue;
    for (const auto& [lift, start] : {std::pair{9.81, 0.0}, {30.0, kBothOpen}}) {
      model.loads.sphere.push_back(std::int32_t(i)), model.loads.start.push_back(start);
      model.loads.force.push_back(model.mass[i] * Vec3{0, 0, lift}), model.loads.ramp.push_back(0);
    }
  }
  return model;
}

/// Sets what auto took when the first rows were made: leapfrog, or backward Euler where that needs many substeps.
inline void use_first_choice(Model& model) {
  const double needed = std::ceil(model.tick / (0.9 * stepping::stable_step_bound(model)));
  const bool is_explicit = needed <= 4;
  model.solver.integrator = is_explicit ? Integrator::leapfrog : Integrator::backward_euler;
  model.solver.substeps = is_explicit ? std::int32_t(needed) : 1;
}

/// Whether a session that is in a tick of `ticks` waits until its cuts have opened: when a ball is taken, and at the
/// end of a session of two hands.
inline bool awaits_cuts(const Model& model, const State& state, const Inputs& inputs, int tick, int ticks) {
  if (state.opening_cuts_at == 0) return false;
  return (inputs.tool == 0 && state.last_inputs.tool != 0) || (model.hands > 1 && tick >= ticks * 19 / 20);
}

/// Simulates `ticks` ticks, sampled evenly from the 400 of a golden session, of a Model with a ball, a scalpel and
/// perhaps a pin, and those in which it waits. Without an integrator: see use_first_choice().
inline GoldenRun run_golden(Model model, int ticks, std::optional<Integrator> integrator,
                            const stepping::StepperOptions& options = {}, Inputs (*inputs_at)(int) = golden_inputs) {
  model.gravity = {0, 0, -9.81};
  model.solver = {};
  if (!integrator) use_first_choice(model);
  if (integrator) stepping::resolve_integrator(model, integrator);
  State state = rest_state(model);
  stepping::Stepper stepper(model, options);
  GoldenRun run;
  for (int tick = 0; tick < ticks; ++tick) {
    Inputs inputs = inputs_at(tick * 400 / ticks);
    if (model.has_tool(ToolKind::pin) && tick >= ticks * 3 / 4) {
      const Vec3 held = model.rest_position[std::size_t(model.tools[2].sphere)];
      inputs.tool = 2, inputs.position = held + Vec3{0, 0, 1e-5 * (tick - ticks * 3 / 4)};
    }
    if (awaits_cuts(model, state, inputs, tick, ticks))
      while (state.opening_cuts_at > 0)
        run.is_good = stepper.step(state, inputs).status <= stepping::StepStatus::not_converged && run.is_good;
    const stepping::StepReport report = stepper.step(state, inputs);
    run.is_good = run.is_good && report.status <= stepping::StepStatus::not_converged;
    run.severed += report.severed, run.contacts += report.contacts;
    if ((tick + 1) % (ticks / 4) == 0) run.hash[std::size_t(tick / (ticks / 4))] = recordings::state_hash(state);
  }
  return run;
}

/// The same of a block of ni x nj x nk spheres.
inline GoldenRun run_golden(int ni, int nj, int nk, int ticks, network::Structure structure,
                            std::optional<Integrator> integrator, const stepping::StepperOptions& options = {}) {
  Model model = make_block_model(ni, nj, nk, structure);
  model.tools = {ball(0.006), scalpel(0.06)};
  return run_golden(std::move(model), ticks, integrator, options);
}

}  // namespace ctpm::testing
