// How deep cuts of a blade are along it, in boxes where the answer is known: the height of the top above the blade's
// tip, or of the whole box in a cut through it, divided by the cosine of the blade's tilt.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/stepping/step.h"
#include "studio/session/cut_measures.h"
#include "tests/core/blade_blocks.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kTop = 0.048;      // of a box that stands on z = 0 [m]
constexpr double kAbove = 0.060;    // where a blade is out of it [m]
constexpr double kWithin = 0.5e-3;  // [m]
constexpr double kDegree = std::numbers::pi / 180;

/// A box of 96 mm by 48 mm by 48 mm.
FilledOrgan box(double spacing, double bottom = 0) {
  FilledOrgan organ = testing::make_block(1 + int(0.096 / spacing + 0.5), 1 + int(kTop / spacing + 0.5),
                                          1 + int(kTop / spacing + 0.5), spacing);
  for (Vec3& centre : organ.centre) centre.z += bottom;
  testing::add_faces(organ, 0.006);
  return organ;
}

/// What a box is made of: rigid tissue that does not hold the blade, so that it is in the tissue at rest where it is in
/// the world; or a soft one on a table that resists.
enum class Tissue { rigid, soft };

/// A blade that cuts boxes.
class Cutting {
 public:
  Cutting(const std::vector<FilledOrgan>& organs, double blade_length, Tissue tissue = Tissue::rigid)
      : model_(model_of(organs, blade_length, tissue)) {}

  /// Takes the blade with its tip at a place, its handle tilted by an angle from z towards x.
  void take(Vec3 tip, double tilt) {
    hand_.tool = 0, hand_.position = tip;
    hand_.world_from_tool = {std::cos(0.5 * tilt), 0, std::sin(0.5 * tilt), 0};
    step();
  }
  void go(Vec3 to) {
    constexpr double kPerTick = 0.1e-3;
    const Vec3 from = hand_.position;
    const double ticks = std::ceil(norm(to - from) / kPerTick);
    for (double i = 1; i <= ticks; ++i) hand_.position = from + i / ticks * (to - from), step();
  }
  void put_away() { hand_.tool = -1, step(); }

  /// A stroke along x whose tip is at a height, from above the box and back again.
  void stroke(double height, double tilt = 0) {
    const double lean = (kAbove - height) * std::tan(tilt);
    take({-0.02 + lean, kAside, kAbove}, tilt);
    for (const Vec3 to : {Vec3{-0.02, kAside, height}, {0.012, kAside, height}, {0.012 + lean, kAside, kAbove}}) go(to);
    put_away();
  }

  double along_blade() const {
    session::CutMeasures whole(model_);
    whole.measure(state_);
    EXPECT_EQ(whole.size().value().along_blade, measures_.size().value().along_blade) << "measured tick by tick";
    return whole.size()->along_blade;
  }
  double nearest() const { return measures_.size().value().depth; }
  double edge_depth() const { return measures_.edge_depth(state_); }

  static constexpr double kAside = 0.0013;  // of the middle, beside all spheres [m]

 private:
  static Model model_of(const std::vector<FilledOrgan>& organs, double blade_length, Tissue tissue) {
    network::OrganSettings settings;
    settings.name = "box", settings.structure = network::Structure::ctpm;
    settings.material = tissue == Tissue::soft ? testing::resisting(testing::kToughness, testing::kFriction)
                                               : testing::liver_material();
    Model model;
    for (const FilledOrgan& organ : organs) {
      EXPECT_TRUE(network::add_organ(model, organ, settings));
      settings.name += " below";
    }
    model.tools = {testing::scalpel(blade_length)};
    stepping::resolve_integrator(model);
    model.held_axes.assign(model.sphere_count(), 0);
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      if (tissue == Tissue::rigid || model.rest_position[i].z < 1e-6) model.held_axes[i] = kAnchored;
    return model;
  }
  void step() {
    EXPECT_FALSE(stepping::is_refused(stepper_.step(state_, hand_).status));
    measures_.measure(state_);
  }

  const Model model_;
  State state_ = rest_state(model_);
  stepping::Stepper stepper_{model_};
  session::CutMeasures measures_{model_};
  Inputs hand_;
};

/// Of boxes with lattices of their own; a blade of 70 mm leaves them above.
class CutDepth : public ::testing::TestWithParam<double> {
 protected:
  Cutting cutting(double blade_length = 0.070) const { return Cutting({box(GetParam())}, blade_length); }
};

TEST_P(CutDepth, OfAStrokeIsFromItsTipToTheTopAlongTheBlade) {
  for (const double depth : {0.004, 0.015, 0.030, 0.040, 0.046})
    for (const double tilt : {0.0, 25 * kDegree, -25 * kDegree}) {
      Cutting blade = cutting();
      blade.stroke(kTop - depth, tilt);
      EXPECT_NEAR(blade.along_blade(), depth / std::cos(tilt), kWithin) << depth << " " << tilt;
    }
}

TEST_P(CutDepth, OfACutThroughTheBoxIsItsThickness) {
  for (const double tilt : {0.0, 20 * kDegree}) {
    Cutting blade = cutting();
    blade.stroke(-0.009, tilt);
    EXPECT_NEAR(blade.along_blade(), kTop / std::cos(tilt), kWithin) << tilt;
  }
}

TEST_P(CutDepth, OfADeeperStrokeInAnEarlierCutIsFromTheTop) {
  for (const double depth : {0.0125, 0.024, 0.040})
    for (const double tilt : {0.0, 25 * kDegree}) {
      Cutting blade = cutting();
      blade.stroke(kTop - 0.010);
      EXPECT_NEAR(blade.along_blade(), 0.010, kWithin);
      blade.stroke(kTop - depth, tilt);
      EXPECT_NEAR(blade.along_blade(), depth / std::cos(tilt), kWithin) << depth << " " << tilt;
      blade.stroke(kTop - 0.005);
      EXPECT_NEAR(blade.along_blade(), depth / std::cos(tilt), kWithin) << "nothing that is less deep counts";
    }
}

TEST_P(CutDepth, OfAStabIsThatOfItsTip) {
  for (const double tilt : {0.0, 8 * kDegree, 20 * kDegree}) {
    Cutting blade = cutting();
    blade.stroke(kTop - 0.015);
    const Vec3 along{std::sin(tilt), 0, std::cos(tilt)}, entry{0.032, Cutting::kAside, kTop};
    blade.take(entry + 0.010 * along, tilt);
    blade.go(entry - 0.033 * along);
    EXPECT_NEAR(blade.edge_depth(), 0.033, kWithin) << tilt;
    EXPECT_NEAR(blade.along_blade(), 0.033, kWithin) << tilt;
    blade.go(entry + 0.010 * along);
    EXPECT_EQ(blade.edge_depth(), 0) << tilt;
    EXPECT_NEAR(blade.along_blade(), 0.033, kWithin) << tilt;
  }
}

TEST_P(CutDepth, GoesOnAboveABladeThatIsInTheBoxToItsHeel) {
  Cutting blade = cutting(0.020);
  blade.stroke(kTop - 0.035, 15 * kDegree);
  EXPECT_NEAR(blade.along_blade(), 0.035 / std::cos(15 * kDegree), kWithin);
}

TEST_P(CutDepth, OfSoftTissueThatResistsIsThatOfTheTipTooWhereTheFarSideIsNear) {
  Cutting blade({box(GetParam())}, 0.070, Tissue::soft);
  blade.stroke(kTop - 0.030);
  EXPECT_NEAR(blade.along_blade(), 0.030, kWithin);
  const double nearest = blade.nearest();
  blade.stroke(kTop - 0.040);
  EXPECT_NEAR(blade.along_blade(), 0.040, kWithin);
  EXPECT_NEAR(blade.nearest(), nearest, kWithin) << "the nearest surface does not tell them apart";
}

INSTANTIATE_TEST_SUITE_P(OfLattices, CutDepth, ::testing::Values(0.012));
INSTANTIATE_TEST_SUITE_P(SlowOfLattices, CutDepth, ::testing::Values(0.006));

TEST(CutDepthOfTwo, IsThatOfTheOrganThatWasCutDeeper) {
  Cutting blade({box(0.012), box(0.012, -0.050)}, 0.120);
  blade.stroke(-0.012);
  EXPECT_NEAR(blade.along_blade(), kTop, kWithin) << "through the upper one, 10 mm into the lower one";
  blade.stroke(-0.049);
  EXPECT_NEAR(blade.along_blade(), kTop, kWithin);
}

}  // namespace
}  // namespace ctpm
