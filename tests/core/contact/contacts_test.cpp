// The common interface of all contacts: removing contacts from a linear system restores it to the bit, and calls in the
// wrong order are refused.

#include "core/contact/contacts.h"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>

#include "core/stepping/step.h"
#include "tests/core/blade_blocks.h"

namespace ctpm {
namespace {

/// A block with closed cut faces; a ball presses beside the cut.
class CutAndPressed : public ::testing::Test {
 protected:
  CutAndPressed() {
    model_.tools = {testing::scalpel(0.2), testing::ball(0.02)};
    model_.lip_k = model_.axial.k[0], model_.contact_friction = 0.3;
    state_ = rest_state(model_);
    stepping::Stepper stepper(model_);
    for (int i = 0; i < 100; ++i) (void)stepper.step(state_, testing::blade_at({0.0002, -0.05 + 0.001 * i, -0.05}));
    testing::shake(state_, 1e-3, 0.1);
    model_.solver.integrator = Integrator::leapfrog;  // whose contacts can be both explicit and implicit
    tools_[0].tool = &model_.tools[1];
    tools_[0].from = tools_[0].to = {0, 0, 0.048};
    contacts_.emplace(model_, elements::kernels_for(elements::best_instruction_set()));
    force_.resize(3 * model_.sphere_count()), blocks_.resize(6 * model_.sphere_count());
    testing::Noise noise;
    for (double& f : force_) f = noise.next();
    for (double& b : blocks_) b = noise.next();
  }

  contact::ImplicitContacts detect() {
    return contacts_->detect(state_, tools_, {1e-3, 1e-3, 0, 1.0, {}}, contact::Linearisation::rest);
  }

  Model model_ = testing::free_block(6, 4, 4, testing::resisting(0));
  State state_;
  contact::HeldTools tools_;
  std::optional<contact::Contacts> contacts_;
  elements::Coordinates force_;
  elements::DiagonalBlocks blocks_;
};

TEST_F(CutAndPressed, ContactsLeaveALinearSystemToTheBit) {
  const elements::Coordinates force = force_;
  const elements::DiagonalBlocks blocks = blocks_;
  contact::ImplicitContacts set = detect();
  EXPECT_GT(set.touched(0), 0);
  {
    const contact::LinearisedContacts linearised = set.linearise(force_, blocks_);
    EXPECT_NE(force_, force);
    EXPECT_NE(blocks_, blocks);
  }
  EXPECT_EQ(force_, force);
  EXPECT_EQ(blocks_, blocks);
}

TEST_F(CutAndPressed, DroppedContactsLeaveTheSystemToTheBitAndDoNotComeBack) {
  const elements::Coordinates force = force_;
  const elements::DiagonalBlocks blocks = blocks_;
  contact::ImplicitContacts set = detect();
  const std::int32_t touched = set.touched(0);
  // All spheres move away from the ball, faster than any contact can follow.
  elements::Coordinates away(force_.size());
  std::fill(away.begin() + std::ptrdiff_t(2 * model_.sphere_count()), away.end(), -100.0);
  {
    contact::LinearisedContacts linearised = set.linearise(force_, blocks_);
    EXPECT_TRUE(linearised.has_wrong(away));
    std::move(linearised).mend_wrong(away);
    EXPECT_EQ(force_, force) << "taken back before contacts are dropped";
  }
  EXPECT_EQ(blocks_, blocks);
  EXPECT_GT(touched, 0);
  EXPECT_EQ(set.touched(0), 0);
  EXPECT_FALSE(set.linearise(force_, blocks_).has_wrong(away));
}

TEST_F(CutAndPressed, TheCouplingIsSymmetricAndHasTheDiagonalThatWasAdded) {
  std::fill(blocks_.begin(), blocks_.end(), 0.0);
  contact::ImplicitContacts set = detect();
  const contact::LinearisedContacts linearised = set.linearise(force_, blocks_);
  const std::size_t n = force_.size();
  testing::Noise noise;
  elements::Coordinates u(n), v(n), of_u(n), of_v(n);
  for (double& x : u) x = noise.next();
  for (double& x : v) x = noise.next();
  linearised.apply(u.data(), of_u.data()), linearised.apply(v.data(), of_v.data());
  const double energy = std::inner_product(u.begin(), u.end(), of_u.begin(), 0.0);
  const double uv = std::inner_product(v.begin(), v.end(), of_u.begin(), 0.0);
  EXPECT_NEAR(uv, std::inner_product(u.begin(), u.end(), of_v.begin(), 0.0), 1e-12 * std::abs(energy));
  // The diagonal of the matrix is xx, yy and zz of the blocks.
  for (std::size_t i = 0; i < n; ++i) {
    elements::Coordinates one(n), column(n);
    one[i] = 1;
    linearised.apply(one.data(), column.data());
    const std::size_t axis = i / model_.sphere_count(), sphere = i % model_.sphere_count(), rows[3] = {0, 3, 5};
    EXPECT_NEAR(column[i], blocks_[rows[axis] * model_.sphere_count() + sphere], 1e-12 * std::abs(column[i])) << i;
  }
}

TEST_F(CutAndPressed, AnExplicitStepKeepsTheMomentumThatTheToolDoesNotTake) {
  const auto momentum = [&](const Vec3Array& velocity) {
    Vec3 sum;
    for (std::size_t i = 0; i < velocity.size(); ++i) sum += model_.mass[i] * velocity[i];
    return sum;
  };
  const double h = 1e-4;
  Vec3Array velocity = state_.velocity;
  contact::ExplicitContacts set = contacts_->detect_in_middle(state_, tools_, {h, h, 0.5 * h, 1.0, {}});
  set.push_apart(state_.velocity, velocity);
  EXPECT_GT(set.touched(0), 0);
  EXPECT_GT(norm(set.tool_force(0)), 0);
  const Vec3 gained = momentum(velocity) - momentum(state_.velocity);
  EXPECT_NEAR(norm(gained + h * set.tool_force(0)), 0, 1e-12 * norm(gained));
}

TEST_F(CutAndPressed, APinIsAContactThatFollowsTheHand) {
  const Tool holding{"pin", ToolKind::pin, 0, 0, 5};
  contact::HeldTools tools;
  contact::HeldTool& pin = tools[0];
  pin.tool = &holding;
  pin.from = model_.rest_position[5], pin.to = pin.from + Vec3{0, 0, 2e-3};
  const double h = 1e-3;
  const contact::ContactStep step{h, h, 0, 1.0, contact::Contacts::pins(tools, state_.position, 1.0, h)};
  EXPECT_NEAR(norm(state_.position[5] + h * step.pins[0].velocity - pin.to), 0, 1e-15);
  const contact::ImplicitContacts set = contacts_->detect(state_, tools, step, contact::Linearisation::rest);
  EXPECT_EQ(set.touched(0), 1);
  Vec3Array end = model_.rest_position;
  end.set(5, pin.to);
  EXPECT_NEAR(set.depth(0, end), 2e-3, 1e-15);
  EXPECT_FALSE(contact::any_held(contact::Contacts::pins(tools_, state_.position, 1.0, h))) << "a ball is no pin";
}

using CutAndPressedDeathTest = CutAndPressed;

TEST_F(CutAndPressedDeathTest, TwoSetsAtATimeAreABug) {
  EXPECT_DEATH(
      {
        const contact::ImplicitContacts first = detect();
        (void)detect();
      },
      "while those of another step are in use");
  { const contact::ImplicitContacts first = detect(); }
  EXPECT_GT(detect().touched(0), 0) << "the first has ended";
}

TEST_F(CutAndPressedDeathTest, TwoLinearisationsAtATimeAreABug) {
  EXPECT_DEATH(
      {
        contact::ImplicitContacts set = detect();
        const contact::LinearisedContacts first = set.linearise(force_, blocks_);
        (void)set.linearise(force_, blocks_);
      },
      "while they are in a linear system");
}

}  // namespace
}  // namespace ctpm
