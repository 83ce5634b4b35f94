// When cuts open.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/contact/cut_surfaces.h"
#include "core/contact/open_cuts.h"
#include "core/cutbody/cut_patches.h"
#include "core/cutting/swept_surface.h"
#include "core/stepping/step.h"
#include "core/surface/near_surface.h"
#include "tests/core/cut_blocks.h"

namespace ctpm {
namespace {

std::int32_t rows_of(const State& state) { return std::int32_t(cutting::swept_rows(state)); }

cutting::Front front_at(double x, double y) { return testing::straight_front({x, y, 0.006}, {x, y, 0.06}); }

class OpenCuts : public ::testing::Test {
 protected:
  OpenCuts() {
    cut_along(0.0013);
    whole_ = {rows_of(state_), state_.axial_severed};
  }

  /// Across the block along y; it is not open yet.
  void cut_along(double x) {
    const TouchedCuts open = state_.open_cuts;
    testing::cut_along(
        model_, [&](double t) { return front_at(x, -0.06 + 0.12 * t); }, state_);
    state_.open_cuts = open;
  }

  void put_blade_in_last_row() {
    const std::size_t last = state_.swept.size() - kEdgeNodes;
    for (std::size_t n = 0; n < kEdgeNodes; ++n) state_.blade_trail.set(n, state_.swept[last + n]);
  }

  /// In the organ, or away from all.
  void put_edge_in(std::int32_t organ) { state_.edge_organ.assign(kEdgeNodes, organ); }

  void go_on(std::int64_t ticks, bool holds_blade) {
    for (const std::int64_t end = state_.tick + ticks; state_.tick < end; ++state_.tick)
      contact::follow_open_cuts(model_, holds_blade, state_);
  }

  const Model model_ = testing::block_to_cut(8, 8, 4, 0.004);
  const std::int64_t after_ = std::llround(contact::kOpensAfter / model_.tick);
  State state_ = rest_state(model_);
  TouchedCuts whole_;
};

TEST_F(OpenCuts, ACutOpensSomeTimeAfterTheBladeHasLeftIt) {
  put_blade_in_last_row(), put_edge_in(0);
  go_on(3 * after_, true);
  EXPECT_EQ(state_.opening_cuts_at, 0) << "the blade is in it";
  const std::int64_t left = state_.tick;
  go_on(1, false);
  EXPECT_EQ(state_.opening_cuts, whole_);
  EXPECT_EQ(state_.opening_cuts_at, left + after_);
  go_on(after_ - 1, false);
  EXPECT_EQ(state_.open_cuts.rows, 0);
  go_on(1, false);
  EXPECT_EQ(state_.open_cuts, whole_);
  EXPECT_EQ(state_.opening_cuts_at, 0);
}

TEST_F(OpenCuts, ABladeThatIsHeldFarAwayHasLeftThem) {
  // As after a jump: the front stays where it was.
  put_blade_in_last_row(), put_edge_in(-1);
  go_on(after_ + 1, true);
  EXPECT_EQ(state_.open_cuts, whole_);
}

TEST_F(OpenCuts, AStateThatKnowsNoFrontHasNoBladeInThem) {
  state_.blade_trail.resize(0);
  go_on(after_ + 1, true);
  EXPECT_EQ(state_.open_cuts, whole_);
}

TEST_F(OpenCuts, ARefusedTickNeitherOpensThemNorBeginsTo) {
  Model model = model_;
  testing::use_integrator(model, Integrator::backward_euler);
  for (const bool opens : {false, true}) {
    State state = state_;
    if (opens) state.opening_cuts = whole_, state.opening_cuts_at = 1, state.tick = 1;
    for (double& v : state.velocity.y) v = 1e12;
    state.velocity.y[40] = 1e300;
    const State before = state;
    EXPECT_EQ(stepping::Stepper(model).step(state, {}).status, stepping::StepStatus::diverged);
    EXPECT_EQ(state.open_cuts, before.open_cuts) << opens;
    EXPECT_EQ(state.opening_cuts, before.opening_cuts) << opens;
    EXPECT_EQ(state.opening_cuts_at, before.opening_cuts_at) << opens;
  }
}

TEST_F(OpenCuts, PatchesKnowWhatIsSeveredAlsoWhereTheRowsAreTheSame) {
  State of_rows = state_, of_all = state_;
  of_rows.axial_severed.clear();
  of_all.axial_severed.assign(of_all.axial_severed.size(), 1);
  const auto pieces = [](const cutbody::CutPatches& patches) { return patches.piece_of_sphere(); };
  cutbody::CutPatches followed(model_, 0), anew(model_, 0);
  followed.follow(std::make_shared<const State>(of_rows));
  const auto before = pieces(followed);
  for (const State* state : {&of_all, &of_rows, &of_all}) followed.follow(std::make_shared<const State>(*state));
  anew.follow(std::make_shared<const State>(of_all));
  EXPECT_NE(before, pieces(anew));
  EXPECT_EQ(pieces(followed), pieces(anew));
}

/// What of a State is touched: of each patch its block, its piece and its size.
std::vector<std::array<std::int64_t, 3>> touched_patches(const Model& model, contact::CutSurfaces& cuts, State state) {
  surface::NearSurface own(model, 0, 1);
  const Box everywhere(Vec3{-1, -1, -1}, Vec3{1, 1, 1});
  cuts.begin_tick(state, false), cuts.begin(state.position), own.begin(state.position);
  (void)cuts.wait_near(everywhere, state, own);
  std::vector<std::array<std::int64_t, 3>> seen;
  cuts.near(everywhere, [&](const cutbody::CutPatch& patch) {
    seen.push_back({patch.block, patch.piece, std::int64_t(patch.body.surface.vertex_count())});
  });
  return seen;
}

TEST_F(OpenCuts, AreTouchedAsTheStateSaysHoweverItJumps) {
  std::vector<State> states{rest_state(model_)};
  for (const double next : {0.0113, 0.0}) {
    go_on(after_ / 2, false), states.push_back(state_);
    go_on(after_ / 2 + 1, false), states.push_back(state_);
    if (next > 0) cut_along(next);
  }
  contact::CutSurfaces jumps(model_);
  for (const std::size_t to : {4, 0, 1, 2, 3, 4, 2, 4, 3, 0, 2, 1, 4}) {
    contact::CutSurfaces anew(model_);
    const auto seen = touched_patches(model_, jumps, states[to]);
    EXPECT_EQ(seen, touched_patches(model_, anew, states[to])) << to;
    EXPECT_EQ(seen.empty(), states[to].open_cuts.rows == 0) << to;
  }
}

TEST_F(OpenCuts, WhatIsCutMeanwhileDoesNotKeepThemClosed) {
  go_on(after_ / 2, false);
  cut_along(0.0113);
  go_on(after_ / 2 + 1, false);
  EXPECT_EQ(state_.open_cuts, whole_);
  EXPECT_EQ(state_.opening_cuts, (TouchedCuts{rows_of(state_), state_.axial_severed}));
  EXPECT_EQ(state_.opening_cuts_at, 2 * after_);
}

TEST_F(OpenCuts, ABladeThatGoesOnNeitherClosesNorMovesThem) {
  go_on(after_ + 1, false);
  put_blade_in_last_row(), put_edge_in(0);
  const Vec3Array before = state_.swept;
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  // In line with the last row, which would be moved.
  cutting::add_swept(state_, front_at(0.0013, 0.06), front_at(0.0013, 0.0601), newly);
  ASSERT_GT(state_.swept.size(), before.size());
  for (std::size_t n = 0; n < before.size(); ++n) ASSERT_EQ(state_.swept[n], before[n]) << n;
  put_blade_in_last_row();
  go_on(after_, true);
  EXPECT_EQ(state_.open_cuts, whole_);
  EXPECT_EQ(state_.opening_cuts_at, 0) << "the blade is in what is new";
  go_on(1, false);
  EXPECT_EQ(state_.opening_cuts.rows, rows_of(state_));
}

}  // namespace
}  // namespace ctpm
