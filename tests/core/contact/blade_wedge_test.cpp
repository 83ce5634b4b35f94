// The wedge that a blade is.

#include "core/contact/blade_wedge.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/elements/forces.h"
#include "tests/core/blade_blocks.h"

namespace ctpm {
namespace {

using testing::kFriction;
using testing::kinetic_energy;
using testing::kToughness;
using testing::momentum;
using testing::resisting;

constexpr double kThickness = 0.4e-3;

/// A blade at `tip` that cuts towards y, its edge upright.
Inputs knife_at(Vec3 tip) {
  Inputs inputs;
  inputs.tool = 0, inputs.position = tip;
  inputs.world_from_tool = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  return inputs;
}

/// A block of ni x nj x nk spheres, held at its sides across the cut and below, with a blade.
Model clamped_block(int ni, int nj, int nk, double spacing, double thickness, double toughness = 20,
                    double friction = 0) {
  Model model = testing::make_block_model(ni, nj, nk, network::Structure::ctpm, resisting(toughness, friction), spacing,
                                          /*inversion_resistance=*/10);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.cell.i[i] == 0 || model.cell.i[i] == ni - 1) model.held_axes[i] = kAnchored;
  model.tools = {testing::scalpel(0.06)};
  model.tools[0].blade_thickness = thickness;
  return model;
}

/// Mean of how far apart the two layers of spheres beside the plane x = 0 are, beyond a spacing [m], of spheres that
/// are between `from` and `to` along y and above `low` at rest.
double gape(const Model& model, const State& state, double spacing, double from, double to, double low) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 p = model.rest_position[i];
    if (std::abs(std::abs(p.x) - 0.5 * spacing) > 1e-9 || p.y < from || p.y > to || p.z < low) continue;
    sum += std::copysign(1.0, p.x) * (state.position.x[i] - p.x), ++count;
  }
  return 2 * sum / count;
}

TEST(BladeWedge, IsAsThickAsItsBevelThenAsTheBlade) {
  Tool blade = testing::scalpel(0.05);
  blade.blade_thickness = kThickness;
  const double bevel = contact::kBevel * kThickness;
  EXPECT_EQ(contact::local_thickness(blade, -1e-3), 0);
  EXPECT_EQ(contact::local_thickness(blade, 0), 0);
  EXPECT_NEAR(contact::local_thickness(blade, 0.5 * bevel), 0.5 * kThickness, 1e-15);
  EXPECT_NEAR(contact::local_thickness(blade, bevel), kThickness, 1e-15);
  EXPECT_EQ(contact::local_thickness(blade, 5e-3), kThickness);
}

/// A strip with spheres 3 mm apart, 36 mm wide and 15 mm high, cut through to its middle by a blade that stands still
/// there.
struct CutStrip {
  static constexpr double kSpacing = 0.003, kEdge = 0.0045;
  Model model;
  State state;

  explicit CutStrip(double thickness) : model(clamped_block(12, 20, 6, kSpacing, thickness)) {
    stepping::Stepper stepper(model);
    state = rest_state(model);
    double y = -0.04;
    for (; y < kEdge; y += 1e-4) (void)stepper.step(state, knife_at({0, y, -0.01}));
    for (int i = 0; i < 300; ++i) (void)stepper.step(state, knife_at({0, kEdge, -0.01}));
  }

  /// The gape beside the flanks, beyond a spacing from the edge.
  double beside() const { return gape(model, state, kSpacing, kEdge - 0.006, kEdge - kSpacing, 0.005); }
};

TEST(BladeWedge, AStripGapesByTheBladesThicknessBesideItsFlanks) {
  const CutStrip strip(kThickness);
  EXPECT_GT(strip.beside(), 0.7 * kThickness);
  EXPECT_LT(strip.beside(), 1.2 * kThickness);
  EXPECT_LT(gape(strip.model, strip.state, CutStrip::kSpacing, strip.kEdge + 0.003, 0.03, 0.005), 0.2 * kThickness)
      << "ahead of the edge";
}

TEST(BladeWedge, ABladeHalfAsThickOpensHalfAsWide) {
  const CutStrip whole(kThickness), half(kThickness / 2);
  EXPECT_NEAR(half.beside(), 0.5 * whole.beside(), 0.03 * whole.beside());
}

TEST(BladeWedge, BothSidesGiveWayAlikeAndTheFacesCloseBehind) {
  CutStrip strip(kThickness);
  stepping::Stepper stepper(strip.model);
  Vec3 sides;
  for (std::size_t i = 0; i < strip.model.sphere_count(); ++i)
    sides += strip.state.position[i] - strip.model.rest_position[i];
  EXPECT_NEAR(sides.x / double(strip.model.sphere_count()), 0, 0.01 * kThickness) << "no side gives way more";
  for (double y = CutStrip::kEdge; y < 0.06; y += 1e-4) (void)stepper.step(strip.state, knife_at({0, y, -0.01}));
  for (int i = 0; i < 300; ++i) (void)stepper.step(strip.state, knife_at({0, 0.06, -0.01}));
  EXPECT_NEAR(gape(strip.model, strip.state, CutStrip::kSpacing, -0.02, 0.02, 0.005), 0, 0.03 * kThickness);
}

TEST(BladeWedge, TheTissueFeelsWhatTheHandFeels) {
  for (const Integrator integrator : {Integrator::backward_euler, Integrator::leapfrog}) {
    Model model = testing::free_block(6, 5, 4, resisting(kToughness, kFriction));
    model.tools[0].blade_thickness = 2e-3, model.solver.integrator = integrator;
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    Vec3 before;
    for (int i = 0; i < 600; ++i) {
      const stepping::StepReport report = stepper.step(state, knife_at({0.0002, -0.05 + 1e-4 * i, -0.05}));
      const Vec3 now = momentum(model, state), gained = now - before;
      ASSERT_NEAR(norm(gained + model.tick * report.tool_force), 0, 1e-9 + 1e-5 * norm(gained)) << i;
      before = now;
    }
  }
}

TEST(BladeWedge, TissueNeverGainsMoreEnergyThanTheHandGives) {
  for (const double per_tick : {3e-5, 3e-4, 2e-3}) {
    Model model = clamped_block(6, 6, 4, 0.012, 1e-3);
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    double given = 0, most = 0;
    for (double y = -0.05; y < 0.06; y += per_tick) {
      const stepping::StepReport report = stepper.step(state, knife_at({0.0013, y, 0.008}));
      given -= per_tick * report.tool_force.y;
      const double energy = elements::elastic_energy(model, state) + kinetic_energy(model, state);
      ASSERT_LE(energy, given + 1e-9) << "at " << y << " with " << per_tick;
      most = std::max(most, energy);
    }
    EXPECT_GT(most, 1e-5);
    for (int i = 0; i < 400; ++i) (void)stepper.step(state, knife_at({0.0013, 0.06, 0.008}));
    EXPECT_LT(elements::elastic_energy(model, state), 0.02 * most) << "the tissue is at rest again";
  }
}

TEST(BladeWedge, TheHandPaysForTheCutAndWhatTheWedgeLoses) {
  for (const double spacing : {0.012, 0.006}) {
    const int f = int(std::lround(0.012 / spacing));
    const Model model = clamped_block(6 * f, 6 * f, 3 * f, spacing, 1e-3);
    stepping::Stepper stepper(model);
    State state = rest_state(model), before = state;
    double given = 0, lost = 0;
    for (double y = -0.05; y < 0.06; y += 3e-5) {
      before = state;
      given -= 3e-5 * stepper.step(state, knife_at({0.0013, y, -0.008})).tool_force.y;
      lost += elements::viscous_work(model, before, state) + elements::severed_energy(model, before, state);
    }
    const double cut = 20 * testing::swept_area(state, {-1, -1, -1}, {1, 1, 1});
    EXPECT_GT(lost, 0.1 * cut);
    EXPECT_NEAR(given, cut + lost, 0.05 * given) << spacing;
  }
}

constexpr int kStillInside = 1800;  ///< ticks after which the blade below comes to the far side

/// Force against the way [N] of each tick of a blade that goes into a block, rests in it, goes on and leaves. `phase`:
/// part of a tick's way by which it is ahead.
std::vector<double> force_in_and_out(double thickness, double phase) {
  const Model model = clamped_block(6, 6, 4, 0.012, thickness);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  std::vector<double> force;
  for (int i = 0; i < 2400; ++i) {
    const double y = -0.05 + 5e-5 * (phase + (i < 1000 ? i : std::max(1000, i - 200)));
    force.push_back(-stepper.step(state, knife_at({0.0013, y, 0.008})).tool_force.y);
  }
  return force;
}

TEST(BladeWedge, TheForceDoesNotJumpForTheWidthWhereTheBladeEntersAndStopsWhereverTicksFall) {
  for (const double phase : {0.0, 0.2, 0.4, 0.6, 0.8}) {
    const std::vector<double> thick = force_in_and_out(kThickness, phase), thin = force_in_and_out(1e-9, phase);
    const auto most = *std::max_element(thick.begin(), thick.end());
    double added = 0, jump = 0;
    for (std::size_t i = 1; i < kStillInside; ++i) {
      const double more = thick[i] - thin[i];
      added = std::max(added, std::abs(more));
      jump = std::max(jump, std::abs(more - (thick[i - 1] - thin[i - 1])));
    }
    EXPECT_GT(added, 0.02 * most);
    EXPECT_LT(jump, 0.03 * most) << phase;
    EXPECT_EQ(thick.back(), 0);
  }
}

// The far face is flat and the edge parallel to it: what is left to cut ends within 0.2 mm of way, and the last of it
// gives way at once as the tissue springs back. How much force is lost in one tick is chance of where ticks fall, so
// the worst of ten phases counts, at each of five speeds.
TEST(BladeWedge, TheForceEndsAsSuddenlyWithoutTheWidthWhereTheWholeEdgeLeavesAtOnce) {
  double whole = 0;  // force before the far face [N]
  const auto largest_drops = [&whole](double thickness) {
    const Model model = clamped_block(6, 6, 4, 0.012, thickness);
    stepping::Stepper stepper(model);
    State inside = rest_state(model);
    for (double y = -0.05; y < 0.026; y += 5e-5) (void)stepper.step(inside, knife_at({0.0013, y, 0.008}));
    std::vector<double> drops;
    for (const double per_tick : {2e-4, 1e-4, 5e-5, 2e-5, 1e-5}) {
      double largest = 0;
      for (int phase = 0; phase < 10; ++phase) {
        State state = inside;
        double last = 0;
        for (double y = 0.026 + 0.1 * phase * per_tick; y < 0.0312; y += per_tick) {
          const double force = -stepper.step(state, knife_at({0.0013, y, 0.008})).tool_force.y;
          largest = std::max(largest, last - force), whole = std::max(whole, force), last = force;
        }
        EXPECT_EQ(last, 0) << "the blade has left";
      }
      drops.push_back(largest);
    }
    return drops;
  };
  const std::vector<double> thick = largest_drops(kThickness), thin = largest_drops(1e-9);
  for (std::size_t i = 0; i < thin.size(); ++i) EXPECT_LT(thick[i], thin[i] + 0.18 * whole) << "speed " << i;
  for (const std::size_t slow : {3, 4}) EXPECT_LT(thick[slow], thin[slow] + 0.02 * whole) << "speed " << slow;
}

TEST(BladeWedge, GivesTheSameBitsOnAnyThreadsAndFromAnyState) {
  const Model model = clamped_block(8, 8, 5, 0.006, 1e-3, 20, 500);
  const auto pose = [](int tick) { return knife_at({0.0004, -0.03 + 1e-4 * tick, 0.005}); };
  std::optional<State> kept;
  std::optional<State> first;
  for (const int threads : {1, 2, 3}) {
    stepping::StepperOptions options;
    options.threads = threads;
    stepping::Stepper stepper(model, options);
    State state = rest_state(model);
    for (int i = 0; i < 400; ++i) {
      if (i == 300 && !kept) kept = state;
      (void)stepper.step(state, pose(i));
    }
    if (!first) first = state;
    EXPECT_EQ(state.position, first->position) << threads;
  }
  EXPECT_GT(norm(kept->position[100] - model.rest_position[100]), 1e-6) << "the blade is in";
  stepping::Stepper stepper(model);
  for (int i = 300; i < 400; ++i) (void)stepper.step(*kept, pose(i));
  EXPECT_EQ(kept->position, first->position);
  EXPECT_EQ(kept->velocity, first->velocity);
}

TEST(BladeWedge, IsLeftOutWhereNoTissueResistsABlade) {
  const Model model = testing::block_with_blade(4, 4, 4, testing::liver_material());
  EXPECT_EQ(contact::BladeWedge(model).capacity(), 0u);
  EXPECT_EQ(contact::BladeWedge(model).entries(), 0u);
}

}  // namespace
}  // namespace ctpm
