// Every measure of a session against an answer that is known without it: sessions that were never simulated,
// made of straight ways, triangles of force and chosen elements.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/cutting/cutting.h"
#include "core/model/box.h"
#include "studio/compare/advice.h"
#include "studio/compare/measure_table.h"
#include "studio/compare/measures.h"
#include "studio/compare/report.h"
#include "studio/compare/session_measures.h"
#include "tests/studio/compare/made_tracks.h"

namespace ctpm {
namespace {

TEST_F(Measures, TimePathAndPauseAreThoseOfTheWay) {
  const compare::Comparison comparison = compare::compare_sessions(press(), press(2.5), scene_);
  EXPECT_NEAR(trainee(comparison, "completion_time_s"), 4.5, 1e-9);
  EXPECT_NEAR(find(comparison, "completion_time_s").expert.value(), 2, 1e-9);
  EXPECT_NEAR(trainee(comparison, "path_length_mm"), 100, 1.2);  // less what no hand can do: turn at once
  EXPECT_NEAR(trainee(comparison, "idle_time_s"), 2.5, 0.02);    // at the 100 Hz of hands
  EXPECT_EQ(find(comparison, "idle_time_s").expert.value(), 0);
  ASSERT_EQ(comparison.moments.size(), 1u);
  EXPECT_EQ(comparison.moments[0].kind, compare::MomentKind::pause);
  EXPECT_NEAR(comparison.moments[0].from_s, 1, 0.02);
  EXPECT_NEAR(comparison.moments[0].severity, 1.5 * 2.5 / 2.6, 0.02);  // 2.5 s where 1 s is allowed
}

TEST_F(Measures, ATriangleOfForceHasItsAreaAndItsHeight) {
  compare::SessionTrack track = press();
  for (std::size_t i = 0; i < 2000; ++i) track.force[i] = 4 * (1 - std::abs(double(i) - 1000) / 1000);  // [N]
  const compare::Comparison comparison = compare::compare_sessions(press(), track, scene_, {.force_limit = 2});
  EXPECT_EQ(trainee(comparison, "peak_force_n"), 4);
  EXPECT_NEAR(trainee(comparison, "mean_force_n"), 2, 0.03);  // the hand is slow where it turns, at the peak
  EXPECT_NEAR(trainee(comparison, "time_above_force_limit_s"), 1, 0.002);
  EXPECT_NEAR(trainee(comparison, "impulse_above_force_limit_n_s"), 1, 0.002);  // half of 1 s times 2 N
  ASSERT_EQ(comparison.moments.size(), 1u);
  EXPECT_EQ(comparison.moments[0].kind, compare::MomentKind::force);
  EXPECT_NEAR(comparison.moments[0].worst_s, 1, 1e-9);
  EXPECT_NEAR(comparison.moments[0].severity, 1 / 1.1, 0.01);  // twice the limit at most, for 1 s
}

TEST_F(Measures, TheForceLimitIsTheOneGivenOrTheScenesOrTheExpertsPeak) {
  compare::SessionTrack expert = press();
  expert.force[1000] = 3;
  EXPECT_NEAR(compare::compare_sessions(expert, press(), scene_).force_limit.value(), 3.03, 1e-12);
  EXPECT_EQ(compare::compare_sessions(expert, press(), scene_, {.damage_force = 2}).force_limit, 2);
  EXPECT_EQ(compare::compare_sessions(expert, press(), scene_, {.force_limit = 1, .damage_force = 2}).force_limit, 1);
  const compare::Comparison none = compare::compare_sessions(press(), expert, scene_);
  EXPECT_FALSE(none.force_limit);
  EXPECT_FALSE(find(none, "time_above_force_limit_s").trainee);
  EXPECT_FALSE(find(none, "time_above_force_limit_s").note.empty());
}

TEST_F(Measures, TimeBeyondTheDamageDepthIsThatOfTheTicks) {
  compare::SessionTrack track = press();
  for (std::size_t i = 500; i < 800; ++i) track.depth[i] = 0.011;
  track.depth[900] = 0.01;  // at the limit, not beyond
  const compare::Comparison comparison = compare::compare_sessions(press(), track, scene_);
  EXPECT_NEAR(trainee(comparison, "time_beyond_damage_depth_s"), 0.3, 1e-9);
  EXPECT_NEAR(trainee(comparison, "largest_depth_mm"), 11, 1e-9);
  ASSERT_EQ(comparison.moments.size(), 1u);
  EXPECT_EQ(comparison.moments[0].kind, compare::MomentKind::depth);
  EXPECT_NEAR(comparison.moments[0].severity, 0.1 * 0.299 / 0.399, 1e-9);
  recordings::SessionStart without = scene_;
  without.model.organs[0].damage_depth = 0;
  EXPECT_FALSE(find(compare::compare_sessions(press(), track, without), "time_beyond_damage_depth_s").trainee);
}

TEST_F(Measures, OverlapOfCutsIsTheDiceCoefficientOfTheirElements) {
  compare::SessionTrack expert = press(), trainee_track = press();
  const auto sever = [](compare::SessionTrack& track, std::size_t first, std::size_t last, std::int64_t tick) {
    for (std::size_t i = first; i < last; ++i) track.severed_at[i] = tick;
    track.severed[std::size_t(tick)] += std::int32_t(last - first);
  };
  sever(expert, 0, 20, 900), sever(trainee_track, 15, 25, 700), sever(trainee_track, 25, 30, 1500);
  expert.cuts = {{900, 901}}, trainee_track.cuts = {{700, 701}, {1500, 1501}};
  const compare::Comparison comparison = compare::compare_sessions(expert, trainee_track, scene_);
  EXPECT_EQ(trainee(comparison, "elements_severed"), 15);
  EXPECT_EQ(trainee(comparison, "elements_severed_by_both"), 5);
  EXPECT_EQ(trainee(comparison, "elements_severed_by_expert_only"), 15);
  EXPECT_EQ(trainee(comparison, "elements_severed_by_trainee_only"), 10);
  EXPECT_NEAR(trainee(comparison, "cut_overlap"), 2.0 * 5 / (20 + 15), 1e-12);
  // The tip, at 50 mm/s, is at 54.95 mm when the expert cuts, and at 64.95 and 75.05 mm when the trainee
  // does.
  EXPECT_NEAR(trainee(comparison, "cut_path_hausdorff_mm"), 20.1, 1e-9);
  EXPECT_NEAR(trainee(comparison, "cut_path_mean_distance_mm"), (10.0 + 10.0 + 20.1) / 3, 1e-9);
  ASSERT_EQ(comparison.moments.size(), 2u);
  EXPECT_EQ(comparison.moments[0].kind, compare::MomentKind::stray_cut);
  EXPECT_EQ(comparison.moments[0].value, 5);
  EXPECT_NEAR(comparison.moments[0].severity, 5.0 / 20, 1e-12);
}

TEST_F(Measures, CutsAreMeasuredOnTheSweptSurfaceToAHundredthOfAMillimetre) {
  // The surface z = 0.1 m, with tissue below; the edge sweeps a plane askew to it, 7 mm deep and 30 mm long.
  recordings::SessionStart scene = scene_;
  scene.model.surfaces.assign(scene.model.organs.size(), Surface{});
  scene.model.surfaces[0].vertex = {{-0.1, -0.1, 0.1}, {0.3, -0.1, 0.1}, {-0.1, 0.3, 0.1}, {-0.1, -0.1, -0.3}};
  scene.model.surfaces[0].triangle = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  State state = rest_state(scene.model);
  const auto front = [&](double along) {
    cutting::Front front;
    for (std::size_t n = 0; n < kEdgeNodes; ++n)
      front[n] = Vec3{0.02 + along, 0.021, 0.093} + 0.0008 * double(n) * Vec3{0.6, 0, 0.8};
    return front;
  };
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  for (int i = 0; i < 300; ++i) cutting::add_swept(state, front(1e-4 * i), front(1e-4 * (i + 1)), newly);
  EXPECT_LE(cutting::swept_rows(state), 40u) << "rows in line are one";
  session::CutMeasures measures(scene.model);
  measures.measure(state);
  ASSERT_TRUE(measures.size());
  EXPECT_NEAR(measures.size()->depth, 0.007, 1e-5);
  EXPECT_NEAR(measures.size()->length, 0.03, 1e-5);
  EXPECT_NEAR(measures.size()->area, 0.03 * 0.007, 0.03 * 1e-4);
  // Of the point only the tip counts.
  const double tip = 0.093 + 0.0008 * 0.8 * double(cutting::kPointNodes);
  EXPECT_NEAR(measures.size()->along_blade, (0.1 - tip) / 0.8, 2e-5);
  measures.measure(rest_state(scene.model));
  EXPECT_FALSE(measures.size());
}

TEST_F(Measures, ACutThroughACavityIsDeepFromTheOuterSurface) {
  // A tetrahedron below z = 0.1 m with another one taken out of it, through which the edge goes.
  recordings::SessionStart scene = scene_;
  scene.model.surfaces.assign(scene.model.organs.size(), Surface{});
  scene.model.surfaces[0].vertex = {{-0.1, -0.1, 0.1},    {0.3, -0.1, 0.1},   {-0.1, 0.3, 0.1},   {-0.1, -0.1, -0.3},
                                    {-0.05, -0.05, 0.08}, {0.1, -0.05, 0.08}, {-0.05, 0.1, 0.08}, {-0.05, -0.05, 0}};
  scene.model.surfaces[0].triangle = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0},
                                      {4, 6, 5}, {4, 5, 7}, {5, 6, 7}, {6, 4, 7}};
  State state = rest_state(scene.model);
  const auto front = [](double along) {
    cutting::Front front;
    for (std::size_t n = 0; n < kEdgeNodes; ++n) front[n] = {along, 0, -0.05 + 0.005 * double(n)};
    return front;
  };
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  cutting::add_swept(state, front(0), front(5e-4), newly);
  session::CutMeasures measures(scene.model);
  measures.measure(state);
  EXPECT_NEAR(measures.size().value().along_blade, 0.12, 2e-5) << "the tip is at z = -0.02 m";
}

TEST_F(Measures, APathBesideTheExpertsIsThatFarAwayWhateverItsPace) {
  compare::SessionTrack beside = new_track();
  go(beside, {0.02, 0, 0.1}, {0.02, 0, 0.05}, 1.3);
  go(beside, {0.02, 0, 0.05}, {0.02, 0, 0.1}, 0.9);
  const compare::Comparison comparison = compare::compare_sessions(press(), finished(beside, scene_.model), scene_);
  EXPECT_NEAR(trainee(comparison, "aligned_deviation_mean_mm"), 20, 0.05);
  EXPECT_NEAR(trainee(comparison, "aligned_deviation_largest_mm"), 20, 0.1);
  ASSERT_EQ(comparison.moments.size(), 1u);
  EXPECT_EQ(comparison.moments[0].kind, compare::MomentKind::deviation);
  EXPECT_EQ(comparison.moments[0].from_s, 0);
  EXPECT_NEAR(comparison.moments[0].to_s, 2.2, 0.05);
}

TEST_F(Measures, WhatHarmsTheTissueComesFirstUnlessItIsNextToNothing) {
  compare::SessionTrack track = press(2.5);
  for (std::size_t i = 100; i < 600; ++i) track.force[i] = 1.5;  // while the pause is 2.5 times as long as allowed
  track.force.back() = 0.1;                                      // until the end it works
  const auto worst = [&] { return compare::compare_sessions(press(), track, scene_, {.force_limit = 1}).moments; };
  ASSERT_EQ(worst().size(), 2u);
  EXPECT_EQ(worst()[0].kind, compare::MomentKind::force);
  EXPECT_NEAR(worst()[0].severity, 0.5 * 0.499 / 0.599, 1e-9);
  // One tick of 5 % more force than allowed is nothing beside a tool that is 34.7 mm off its way.
  std::fill(track.force.begin(), track.force.end() - 1, 0.0);
  track.force[100] = 1.05;
  for (std::size_t i = 300; i < track.tick_count(); ++i) track.tip[i].x += 0.0347;
  ASSERT_GE(worst().size(), 3u);
  EXPECT_EQ(worst().front().kind, compare::MomentKind::deviation);
  EXPECT_EQ(worst().back().kind, compare::MomentKind::force);
}

/// A hand along an ellipse, with a tremor and a force that swells twice: tests/references/hand_motion.py.
compare::SessionTrack made_hand(double slower = 1, double tremor_m = 2e-4) {
  compare::SessionTrack track = new_track();
  constexpr double pi = std::numbers::pi;
  const int ticks = int(3000 * slower);
  for (int i = 0; i < ticks; ++i) {
    const double u = double(i) / ticks, s = u * u * u * (10 - 15 * u + 6 * u * u);
    const double shake = tremor_m * std::sin(2 * pi * 7 * i * 1e-3);
    track.tool.push_back(0), track.depth.push_back(0), track.severed.push_back(0);
    track.tip.push_back({0.03 * std::cos(2 * s), 0.05 * std::sin(2 * s) + shake, 0.02 * s});
    track.force.push_back(std::max(0.0, 3 * std::pow(std::sin(2 * pi * u), 2) - 0.5));
  }
  return track;
}

TEST_F(Measures, AreThoseOfAnIndependentScript) {
  const compare::SessionTrack hand = finished(made_hand(), scene_.model);
  const compare::Comparison comparison = compare::compare_sessions(hand, hand, scene_, {.force_limit = 1.5});
  // As tests/references/hand_motion.py prints them.
  for (const auto& [key, value] : {std::pair{"path_length_mm", 82.4353674220},
                                   {"spectral_arc_length", -1.9440074352},
                                   {"log_dimensionless_jerk", -14.6411835723},
                                   {"peak_force_n", 2.5},
                                   {"mean_force_n", 1.5154128572},
                                   {"time_above_force_limit_s", 1.174},
                                   {"impulse_above_force_limit_n_s", 0.7627340121}})
    EXPECT_NEAR(trainee(comparison, key), value, 1e-8) << key;
}

TEST_F(Measures, SmoothnessHardlyChangesWhenTheSameMotionIsSlower) {
  // Standing still at the start, a stroke, and standing still at its end, at full and at half speed.
  const auto stroke = [&](double slower) {
    compare::SessionTrack track = new_track();
    const compare::SessionTrack way = made_hand(slower, 0);
    go(track, way.tip.front(), way.tip.front(), 0.8 * slower);
    for (std::size_t i = 0; i < way.tick_count(); ++i) {
      track.tool.push_back(0), track.tip.push_back(way.tip[i]);
      track.force.push_back(0), track.depth.push_back(0), track.severed.push_back(0);
    }
    go(track, way.tip.back(), way.tip.back(), 0.8 * slower);
    return finished(track, scene_.model);
  };
  const compare::Comparison comparison = compare::compare_sessions(stroke(1), stroke(2), scene_);
  for (const auto& [key, most] : {std::pair{"spectral_arc_length", 0.03}, {"log_dimensionless_jerk", 0.1}})
    EXPECT_NEAR(trainee(comparison, key), find(comparison, key).expert.value(), most) << key;
}

TEST_F(Measures, TheSameHandWithRoundingIsTheSame) {
  compare::SessionTrack rounded = made_hand();
  for (std::size_t i = 0; i < rounded.tick_count(); ++i) {
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
      rounded.tip[i].*axis = 1e-5 * std::round(1e5 * rounded.tip[i].*axis);
    rounded.force[i] *= i % 2 ? 1.001 : 0.999;  // beyond the expert's peak by as much as a device rounds
  }
  const compare::Comparison comparison =
      compare::compare_sessions(finished(made_hand(), scene_.model), finished(rounded, scene_.model), scene_);
  for (const compare::MeasuredValue& value : comparison.values)
    if (value.expert) {
      EXPECT_EQ(compare::standing_of(value), "same") << value.measure->key;
    }
  EXPECT_TRUE(comparison.moments.empty());
}

TEST_F(Measures, AStrokeThatIsReversedOrMirroredIsSaid) {
  const auto stroke = [&](Vec3 from, Vec3 corner, Vec3 to) {
    compare::SessionTrack track = new_track();
    go(track, from, corner, 1), go(track, corner, to, 1);
    std::ranges::fill(track.force, 1.0);
    return finished(track, scene_.model);
  };
  const Vec3 a{0.08, 0.02, 0}, b{0.02, 0.03, 0}, c{0.02, 0.09, 0};
  Box box(scene_.model.rest_position[0]);
  for (std::size_t i = 0; i < scene_.model.sphere_count(); ++i) box.add(scene_.model.rest_position[i]);
  const Vec3 middle = 0.5 * (box.low + box.high);
  const auto mirrored = [&](Vec3 p, double Vec3::*axis) {
    p.*axis = 2 * middle.*axis - p.*axis;
    return p;
  };
  const compare::SessionTrack expert = stroke(a, b, c);
  const auto way_of = [&](const compare::SessionTrack& track) {
    return compare::compare_sessions(expert, track, scene_).way;
  };
  EXPECT_EQ(way_of(expert), compare::Way::same);
  EXPECT_EQ(way_of(stroke(a + Vec3{0.02, 0, 0}, b + Vec3{0.02, 0, 0}, c + Vec3{0.02, 0, 0})), compare::Way::same);
  EXPECT_EQ(way_of(stroke(c, b, a)), compare::Way::backwards);
  for (const auto& [axis, way] : {std::pair{&Vec3::x, compare::Way::mirrored_x}, {&Vec3::y, compare::Way::mirrored_y}})
    EXPECT_EQ(way_of(stroke(mirrored(a, axis), mirrored(b, axis), mirrored(c, axis))), way);
}

TEST_F(Measures, ToolsThatAreChangedOrPutAwayAddNoWay) {
  compare::SessionTrack track = press();
  const double once = 50;                                                              // [mm], each way
  for (std::size_t i = 1000; i < 2000; ++i) track.tool[i] = 1, track.tip[i].x += 0.3;  // taken 0.3 m away
  track.strokes = {{0, 1000}, {1000, 2000}};
  track.force[999] = track.force[1000] = 1;
  const compare::Comparison comparison = compare::compare_sessions(press(), track, scene_, {.force_limit = 2});
  EXPECT_NEAR(trainee(comparison, "path_length_mm"), 2 * once, 0.2);
  EXPECT_NEAR(trainee(comparison, "mean_force_n"), 1, 1e-9) << "over the last way of the first tool alone";
}

TEST_F(Measures, PausesAreNotNamedWhereAHandLacksRealTime) {
  compare::SessionTrack track = press(2.5);
  track.is_timed = false;
  EXPECT_TRUE(compare::compare_sessions(press(), track, scene_).moments.empty());
}

TEST_F(Measures, RestingInTheTissueDoesNotLowerTheMeanForce) {
  const auto pressed = [&](double hold_s) {
    compare::SessionTrack track = press(hold_s);
    for (std::size_t i = 0; i < track.tick_count(); ++i)
      track.force[i] = i < 500 || i + 500 > track.tick_count() ? 0 : i < 1000 || i + 1000 > track.tick_count() ? 4 : 1;
    return track;
  };
  const compare::Comparison comparison = compare::compare_sessions(pressed(0), pressed(3), scene_);
  EXPECT_NEAR(trainee(comparison, "mean_force_n"), 4, 0.05) << "over time it would be 1.75";
  EXPECT_EQ(compare::standing_of(find(comparison, "mean_force_n")), "same");
}

TEST_F(Measures, AdviceNamesTheWorstFirstWithItsNumbers) {
  compare::SessionTrack track = press(2.5);
  for (std::size_t i = 100; i < 600; ++i) track.force[i] = 4;
  track.force.back() = 0.1;  // until the end it works
  const recordings::SessionStart& scene = scene_;
  const auto advice = [&](const compare::SessionTrack& trainee_track, double limit) {
    const compare::Comparison comparison =
        compare::compare_sessions(press(), trainee_track, scene, {.force_limit = limit});
    const compare::SessionTrack expert = press();
    return compare::advice_of({expert, trainee_track, scene, comparison});
  };
  const std::vector<std::string> both = advice(track, 2);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0], "Press more gently: 4 N at 0.10 s, above the limit of 2 N for 0.499 s in all.");
  EXPECT_EQ(both[1].find("Go on without stopping: 2.49 s"), 0u) << both[1];
  EXPECT_EQ(advice(press(), 2), std::vector<std::string>{"Nothing goes beyond a limit."});
  EXPECT_EQ(advice(press(0.8), 2).at(1).find("Most is to be gained in idle time: 0.79 s"), 0u)
      << advice(press(0.8), 2).at(1);
}

TEST_F(Measures, EachHasAUnitADirectionAMeaningAndASource) {
  compare::SessionTrack cutting = press();
  cutting.severed_at[0] = 10, cutting.severed[10] = 1, cutting.cuts = {{10, 11}};
  const compare::Comparison comparison = compare::compare_sessions(cutting, cutting, scene_);
  EXPECT_EQ(comparison.values.size(), 28u);
  for (const compare::MeasuredValue& value : comparison.values) {
    EXPECT_NE(std::string(value.measure->unit), "") << value.measure->key;
    EXPECT_NE(std::string(compare::to_word(value.measure->direction)), "") << value.measure->key;
    EXPECT_NE(std::string(value.measure->meaning), "") << value.measure->key;
    EXPECT_NE(std::string(value.measure->source), "") << value.measure->key;
    EXPECT_EQ(value.trainee.has_value(), value.note.empty()) << value.measure->key;
  }
}

TEST_F(Measures, OfTimeHaveNoValueWhereASessionLacksRealTime) {
  for (const bool is_timed : {true, false}) {
    compare::SessionTrack track = press();
    track.is_timed = is_timed, track.slip = 0.75;
    std::vector<compare::SessionValue> values = compare::measure_session(track, 3.0, 0);
    compare::refuse_times(values, track);
    int refused = 0;
    for (const compare::SessionValue& value : values) {
      const std::string key = value.measure->key, said = "the session lacks 0.750 s of real time";
      refused += value.note == said;
      if (key == "path_length_mm" || key == "peak_force_n") {
        EXPECT_TRUE(value.value) << key << " needs no clock";
      }
      for (const char* timed : {"completion_time_s", "idle_time_s", "spectral_arc_length", "log_dimensionless_jerk"})
        if (key == timed) {
          EXPECT_EQ(value.note == said, !is_timed) << key;
        }
    }
    EXPECT_EQ(refused > 3, !is_timed);
  }
}

TEST(SessionMeasures, WorkImpulseAndZonesAreThoseOfAForceThatIsKnown) {
  // A tool goes 100 mm in a second against 2 N, the second half of it against 4 N and through a zone; then it goes back
  // while the tissue pushes it.
  compare::SessionTrack track = new_track();
  go(track, {}, {0.1, 0, 0}, 1), go(track, {0.1, 0, 0}, {}, 1);
  track.zones = {"vessel"};
  for (std::size_t i = 0; i < 2000; ++i) {
    const bool is_back = i >= 1000, is_second = i >= 500 && !is_back;
    track.force[i] = is_second ? 4 : 2;
    track.work.push_back((is_back ? -1 : 1) * track.force[i] * 1e-4);
    track.organ.push_back(is_second ? 1 : 0), track.zone.push_back(is_second ? 0 : -1);
  }
  track.strokes = {{0, track.tick_count()}};
  const auto values = compare::measure_session(track, 3.0, 0);
  const auto value = [&](const compare::Measure& measure) {
    return *std::ranges::find(values, &measure, &compare::SessionValue::measure)->value;
  };
  EXPECT_NEAR(value(compare::kImpulse), 2 * 0.5 + 4 * 0.5 + 2 * 1, 1e-9);
  EXPECT_NEAR(value(compare::kWork), 1e3 * (2 * 0.05 + 4 * 0.05), 1e-9)
      << "what the tissue gives back is no work on it";
  EXPECT_NEAR(value(compare::kWorkAbove), 1e3 * 1 * 0.05, 1e-9);
  EXPECT_NEAR(value(compare::kZoneTime), 0.5, 1e-9);
  EXPECT_NEAR(value(compare::kZoneImpulse), 2, 1e-9);
  EXPECT_NEAR(value(compare::kZoneWork), 200, 1e-9);
  Model model;
  model.organs.resize(2), model.organs[0].name = "liver", model.organs[1].name = "kidney";
  const auto loads = compare::loads_of(track, model);
  ASSERT_TRUE(loads && loads->size() == 3);
  EXPECT_EQ((*loads)[1].name, "kidney");
  EXPECT_NEAR((*loads)[0].peak, 2, 0);
  EXPECT_NEAR((*loads)[1].peak, 4, 0);
  EXPECT_NEAR((*loads)[0].impulse, 3, 1e-9);
  EXPECT_NEAR((*loads)[1].impulse, 2, 1e-9);
  EXPECT_TRUE((*loads)[2].is_zone);
  track.organ.clear();
  EXPECT_FALSE(compare::loads_of(track, model)) << "nobody knows what was touched";
}

}  // namespace
}  // namespace ctpm
