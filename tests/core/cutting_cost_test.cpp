// Cutting costs nothing in scenes without a blade, and ticks never allocate.

#include <gtest/gtest.h>

#include "core/stepping/step.h"
#include "tests/core/blocks.h"
#include "tests/core/counting_allocator.h"

namespace ctpm {
namespace {

using testing::allocations;

long allocations_of_ticks(const Model& model, const std::vector<Inputs>& inputs) {
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  (void)stepper.step(state, inputs[0]);  // allocates the scratch memory of State's size
  const long before = allocations;
  for (const Inputs& each : inputs) (void)stepper.step(state, each);
  return allocations - before;
}

std::vector<Inputs> way_through(Vec3 from, Vec3 to) {
  std::vector<Inputs> inputs(100);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    inputs[i].tool = 0, inputs[i].position = from + double(i) / 99 * (to - from);
  return inputs;
}

TEST(CuttingCost, WithoutABladeNothingIsKeptForOne) {
  Model model = testing::make_block_model(5, 5, 4);
  model.tools = {testing::ball(0.006)};
  const State state = rest_state(model);
  EXPECT_TRUE(state.axial_severed.empty() && state.constraint_severed.empty() && state.angle_severed.empty() &&
              state.axial_crossing.empty() && state.blade_trail.x.empty());
  EXPECT_FALSE(model.cut_resistance.any()) << "the tissue has no toughness";
  const long before = allocations;
  { const stepping::Stepper stepper(model); }
  const long without = allocations - before;
  // The same network with a blade needs more memory, so the comparison can fail.
  model.tools = {testing::scalpel(0.1)};
  network::Material tough = testing::liver_material();
  tough.fracture_toughness = 100;
  Model blade = testing::make_block_model(5, 5, 4, network::Structure::ctpm, tough);
  blade.tools = model.tools;
  const long before_blade = allocations;
  { const stepping::Stepper stepper(blade); }
  EXPECT_GT(allocations - before_blade, without);
}

TEST(CuttingCost, TicksDoNotAllocateNotEvenWhileTheyCut) {
  network::Material tough = testing::liver_material();
  tough.fracture_toughness = 100, tough.blade_friction = 1000;
  Model model = testing::make_block_model(6, 5, 4, network::Structure::ctpm, tough);
  model.tools = {testing::scalpel(0.1)};
  model.lip_k = model.axial.k[0];
  EXPECT_EQ(allocations_of_ticks(model, way_through({0.0002, -0.05, -0.03}, {0.0002, 0.05, -0.03})), 0);
  model.tools = {testing::ball(0.006)}, model.cut_resistance = {}, model.lip_k = 0;
  EXPECT_EQ(allocations_of_ticks(model, way_through({0, 0, 0.05}, {0, 0, 0.03})), 0);
}

}  // namespace
}  // namespace ctpm
