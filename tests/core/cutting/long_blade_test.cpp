// The nodes of a long blade are farther apart than a thin sheet of tissue is thick: it is cut all the same.

#include <gtest/gtest.h>

#include <cmath>

#include "core/cutting/pieces.h"
#include "core/stepping/step.h"
#include "tests/core/blade_blocks.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

/// What a stroke along y leaves of a sheet 12 mm thick.
struct Sheet {
  int pieces = 0;
  double work = 0, area = 0;  ///< [J], [m^2]

  Sheet(double blade, double tip, double toughness) {
    network::Material material = testing::resisting(toughness);
    Model model = testing::make_skinned_block(6, 5, 2, network::Structure::ctpm, 0.003, material);
    model.held_axes.assign(model.sphere_count(), kAnchored);
    model.tools = {testing::scalpel(blade)};
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    constexpr double kPerTick = 0.1e-3, kBegin = -0.04;
    Inputs inputs;
    inputs.tool = 0, inputs.world_from_tool = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    for (int i = 0; i <= 800; ++i) {
      inputs.position = {0.0013, kBegin + i * kPerTick, tip};
      const stepping::StepReport report = stepper.step(state, inputs);
      if (i > 0) work -= kPerTick * report.tool_force.y;
    }
    cutting::Pieces found(model);
    pieces = found.find(state);
    area = testing::swept_area(state, {-0.1, -0.024, 0}, {0.1, 0.024, 0.012});
  }
};

constexpr double kNodes = kEdgeNodes - 1 - cutting::kPointNodes;

TEST(LongBlade, CutsASheetBetweenTwoOfItsNodes) {
  constexpr double kBlade = 0.6, kApart = kBlade / kNodes;
  for (const double place : {0.0, 0.25, 0.5, 0.75})
    EXPECT_EQ(Sheet(kBlade, -(5 + place) * kApart, 0).pieces, 2) << place << " of the way between two nodes";
}

TEST(LongBlade, FeelsASheetBetweenTwoOfItsNodes) {
  constexpr double kBlade = 0.6, kApart = kBlade / kNodes, kTough = 200;
  static_assert(kApart > 0.02);
  const Sheet shorter(0.05, -0.01, kTough), between(kBlade, -5 * kApart - 0.5 * (kApart - 0.012), kTough);
  EXPECT_GT(shorter.work, kTough * 0.048 * 0.012);
  EXPECT_NEAR(between.work, shorter.work, 0.1 * shorter.work);
  EXPECT_NEAR(between.area, 0.048 * 0.012, 0.05 * 0.048 * 0.012);
}

}  // namespace
}  // namespace ctpm
