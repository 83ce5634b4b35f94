// Recipes judge what they measured as they should: made-up results with known verdicts.

#include <gtest/gtest.h>

#include <cmath>

#include "studio/fidelity/recipes.h"

namespace ctpm::fidelity {
namespace {

using reports::ReportVerdict;

/// The verdict on the first figure whose name begins so.
ReportVerdict verdict_on(const Chapter& chapter, const std::string& name) {
  for (const Figure& figure : chapter.figures)
    if (figure.name.starts_with(name)) return figure.verdict();
  ADD_FAILURE() << "no figure " << name;
  return ReportVerdict::shown;
}

GripResult grip(double after_1_s, double after_10_s, double slipping) {
  GripResult result;
  result.radius = 4e-3, result.coefficient = 0.3;
  result.held = {{1, after_1_s}, {10, after_10_s}};
  result.slips = {{0.1, slipping}, {0.2, slipping}};
  return result;
}

TEST(GripVerdict, AsksThatItStaysAndThatItSlipsAtTheCone) {
  const Chapter good = chapter_of(grip(0.1, 0.1, 0.3)), creeps = chapter_of(grip(0.1, 0.02, 0.3)),
                sticks = chapter_of(grip(0.1, 0.1, 0.6));
  EXPECT_EQ(verdict_on(good, "friction after 10 s"), ReportVerdict::met);
  EXPECT_EQ(verdict_on(good, "mean friction"), ReportVerdict::met);
  EXPECT_EQ(verdict_on(creeps, "friction after 10 s"), ReportVerdict::missed);
  EXPECT_EQ(verdict_on(sticks, "largest friction"), ReportVerdict::missed);
}

TEST(RecoveryVerdict, AsksThatTissueComesBackAndThatNoCellIsInsideOut) {
  RecoveryResult result;
  result.rows.push_back({.radius = 4e-3,
                         .name = "pressed",
                         .reach = 25e-3,
                         .residual = 0.2e-3,
                         .cells = 75,
                         .worst_inside_out = 9,
                         .inside_out = 0,
                         .distance = {}});
  EXPECT_EQ(verdict_on(chapter_of(result), "distance from rest"), ReportVerdict::met);
  EXPECT_EQ(verdict_on(chapter_of(result), "cells inside out"), ReportVerdict::met);
  result.rows[0].residual = 18e-3, result.rows[0].inside_out = 3;
  EXPECT_EQ(verdict_on(chapter_of(result), "distance from rest"), ReportVerdict::missed);
  EXPECT_EQ(verdict_on(chapter_of(result), "cells inside out"), ReportVerdict::missed);
}

TEST(DragVerdict, AsksForASteadyForceAndContact) {
  DragResult result;
  result.friction = 0.3;
  DragResult::Row row{.radius = 4e-3,
                      .ball = 10e-3,
                      .depth = 6e-3,
                      .way = {0, 1e-3},
                      .normal = {1, 1},
                      .tangential = {0.3, 0.3},
                      .ripple = spread_of({1, 1}),
                      .most_friction = 0.3};
  result.rows = {row};
  EXPECT_EQ(verdict_on(chapter_of(result), "ripple"), ReportVerdict::met);
  EXPECT_EQ(verdict_on(chapter_of(result), "ticks without contact"), ReportVerdict::met);

  result.rows[0].ripple = spread_of({0.8, 1.2}), result.rows[0].lost_ticks = 1, result.rows[0].most_friction = 0.5;
  for (const char* name : {"ripple", "ticks without contact"})
    EXPECT_EQ(verdict_on(chapter_of(result), name), ReportVerdict::missed) << name;
}

TEST(FirstContactVerdict, IsMissedWhereAPlaceFeelsNothing) {
  FirstContactResult result;
  result.rows = {{4e-3, 10e-3, {0.02e-3, -0.04e-3}}};
  EXPECT_EQ(verdict_on(chapter_of(result), "first force"), ReportVerdict::met);
  result.rows[0].depths = {0.02e-3, std::nan("")};
  const Chapter chapter = chapter_of(result);
  EXPECT_EQ(verdict_on(chapter, "first force"), ReportVerdict::missed);
  EXPECT_EQ(chapter.figures[0].note, "no force at 1 of 2 places");
}

TEST(ScatterVerdict, IsMissedWhereATurnFeelsNothing) {
  OrientationResult result;
  result.rows = {{.radius = 4e-3, .depth = 4e-3, .forces = {1.0, 1.02}}};
  EXPECT_EQ(verdict_on(chapter_of(result), "scatter over turns"), ReportVerdict::met);
  EXPECT_EQ(verdict_on(chapter_of(result), "most over least"), ReportVerdict::met);
  result.rows[0].forces = {1.0, 0.0};
  EXPECT_EQ(verdict_on(chapter_of(result), "scatter over turns"), ReportVerdict::missed);
  EXPECT_EQ(verdict_on(chapter_of(result), "most over least"), ReportVerdict::missed);
}

}  // namespace
}  // namespace ctpm::fidelity
