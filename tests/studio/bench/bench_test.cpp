// Errors, percentiles and fronts are what they should be, and the command shows them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "importers/mesh.h"
#include "studio/bench/bench.h"
#include "studio/bench/press.h"
#include "studio/fidelity/meshes.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;
using testing::TemporaryFolder;

/// Writes a scene of a ball that another presses: `organ` are the keys of its material, filling and layers. Its path.
std::string write_ball_scene(const TemporaryFolder& folder, const std::string& organ) {
  const importers::RawMesh ball = fidelity::ball_mesh(30e-3, 6e-3);
  std::ofstream(folder.path() / "ball.obj") << importers::to_obj(ball.vertex, ball.triangle);
  const std::filesystem::path path = folder.path() / "ball.json";
  std::ofstream(path) << R"({"format": "ctpm-scene", "version": 1, "name": "ball",
    "organs": [{"name": "ball", "mesh": "ball.obj", "anchors": [{"lowest_mm": 12}], )"
                      << organ << R"(}],
    "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8}]})";
  return path.string();
}

TEST(Bench, TheFrontHoldsWhatNothingElseBeatsInBoth) {
  const std::vector<double> cost{3, 1, 2, 4, 1}, error{0.1, 0.5, 0.6, 0.2, 0.4};
  // Fastest first: the more accurate of the two that cost 1, then what costs more and errs less.
  EXPECT_EQ(bench::pareto_front(cost, error), (std::vector<std::size_t>{4, 0}));
  EXPECT_TRUE(bench::pareto_front({}, {}).empty());
}

TEST(Bench, WhatFeelsNothingIsNeverOnTheFront) {
  EXPECT_EQ(bench::pareto_front({1, 2}, {INFINITY, 0.1}), (std::vector<std::size_t>{1}));
  bench::BenchRun run;
  run.force = {{}, {}};
  EXPECT_FALSE(bench::feels(run));
  run.force.push_back({0, 0, 1e-9});
  EXPECT_TRUE(bench::feels(run));
}

TEST(Bench, ErrorsThatGrowWithRefinementAreFound) {
  EXPECT_EQ(bench::first_growth({0.3, 0.12, 1.27, 0.9}), 2u);
  EXPECT_FALSE(bench::first_growth({0.4, 0.2, 0.21, 0.1}));
  EXPECT_FALSE(bench::first_growth({0.01, 0.002, 0.004}, 0.002)) << "the reference does not tell these apart";
  EXPECT_FALSE(bench::first_growth({}));
}

TEST(Bench, OneDiagramComparesWhatEachChoiceOfAnOrganCosts) {
  std::vector<bench::BenchStudy> studies(2);
  studies[0].costs = {{"liver", "time, sdirk2", "1 substep", 0.4, 0.01, true},
                      {"liver", "time, sdirk2", "2", 0.8, 0.003}};
  studies[1].costs = {{"liver", "space", "r = 4 mm", 0.4, 0.12, true}, {"kidney", "space", "r = 2 mm", 1, 0.2}};
  const std::vector<bench::BenchStudy> compared = bench::compare_costs(studies);
  ASSERT_EQ(compared.size(), 2u);
  const reports::Plot& plot = compared[0].section.plots.at(0);
  ASSERT_EQ(plot.series.size(), 3u);
  EXPECT_EQ(plot.series[1].y, std::vector<double>{12});
  EXPECT_EQ(plot.series[2].x, (std::vector<double>{0.4, 0.4})) << "the scene's own choices";
  EXPECT_NE(compared[0].sentences[0].find("12 % by space (r = 4 mm), 1 % by time"), std::string::npos)
      << compared[0].sentences[0];
  EXPECT_TRUE(bench::compare_costs({}).empty());
}

TEST(Bench, WhatDoesNotConvergeIsNamedInPlaceOfAnError) {
  std::vector<bench::BenchStudy> studies(2);
  studies[0].costs = {{"liver", "time, sdirk2", "1 substep", 0.4, 0.01, true}};
  studies[1].left_out = {{"liver", "space", "the error in force grows"}, {"kidney", "space", "of another organ"}};
  const std::string sentence = bench::compare_costs(studies).at(0).sentences.at(0);
  EXPECT_EQ(sentence,
            "liver: as the scene is, its force is off by 1 % by time, sdirk2 (1 substep); by space it cannot be told: "
            "the error in force grows.");
}

/// A run of one sphere that goes along x, `off` [m] away from where it should be.
bench::BenchRun straight_run(double off) {
  bench::BenchRun run;
  for (int t = 1; t <= 10; ++t) {
    Vec3Array p;
    p.push_back({0.01 * t + off, 0, 0});
    run.position.push_back(p), run.force.push_back({0, 0, 2 + 100 * off});
  }
  return run;
}

TEST(Bench, ErrorsAreRelativeToHowFarItMovesAndHowHardItPushes) {
  Vec3Array rest;
  rest.push_back({});
  double squares = 0;
  for (int t = 1; t <= 10; ++t) squares += 1e-4 * t * t;
  const bench::BenchRun reference = straight_run(0), off = straight_run(1e-3);
  EXPECT_EQ(bench::position_error(reference, reference, rest), 0);
  EXPECT_NEAR(bench::position_error(off, reference, rest), std::sqrt(10 * 1e-6 / squares), 1e-12);
  EXPECT_NEAR(bench::force_error(off, reference), 0.1 / 2, 1e-12);
}

TEST(Bench, AnErrorInPositionCountsSpheresByTheirWeights) {
  bench::BenchRun reference, off;
  Vec3Array start, moved, wrong;
  for (int i = 0; i < 2; ++i) start.push_back({0.1 * i, 0, 0}), moved.push_back({0.1 * i, 0, 1});
  wrong = moved;
  wrong.set(1, {0.1, 0, 3});
  reference.position = {moved}, off.position = {wrong};
  EXPECT_NEAR(bench::position_error(off, reference, start), std::sqrt(4.0 / 2), 1e-12);
  EXPECT_NEAR(bench::position_error(off, reference, start, {3, 1}), std::sqrt(4.0 / 4), 1e-12);
  EXPECT_EQ(bench::position_error(off, reference, start, {1, 0}), 0) << "a sphere without mass";
}

TEST(Bench, APrestrainedOrganIsPressedFromWhereItHasComeToRest) {
  const TemporaryFolder folder;
  const std::string path = write_ball_scene(folder, R"("material": {"preset": "liver", "prestrain": 0.1},
    "fill": {"radius_mm": 4, "gap_mm": 4})");
  const auto scene = loading::load_whole_scene(path);
  ASSERT_TRUE(scene);
  const auto pressed = bench::press_organ(*scene, scene->built.model);
  ASSERT_TRUE(pressed);
  const Surface& surface = scene->organs[0].surface;
  double begins = 0, ends = 0;
  for (std::size_t v = 0; v < surface.vertex.size(); ++v) {
    begins = std::max(begins, norm(pressed->run.position.front()[v] - surface.vertex[v]));
    ends = std::max(ends, norm(pressed->run.position.back()[v] - surface.vertex[v]));
  }
  EXPECT_LT(begins, 0.2e-3) << "in the first tick the ball comes down by 0.06 mm";
  EXPECT_GT(ends, 1.5e-3) << "of 6 mm; the surface's own dent is not in it";
  EXPECT_GT(norm(pressed->run.force.at(10)), 0) << "it begins at the surface, which has drawn together by 6 mm";
}

TEST(BenchCommand, ShowsErrorAgainstRunTimeOfAScene) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "small.json") << R"({
    "format": "ctpm-scene", "version": 1, "name": "small",
    "organs": [{ "name": "block", "rig": { "block": [3, 3, 3] }, "model": "ctpm",
                 "fill": { "radius_mm": 4, "gap_mm": 4 }, "material": { "preset": "liver" },
                 "anchors": [{ "lowest_mm": 0 }] }],
    "tools": [{ "name": "ball", "kind": "ball", "radius_mm": 10 }] })";
  const ProgramOutcome outcome = run_ctpm({"bench", "small.json", "-o", "out", "--quick"}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("on this machine"), std::string::npos) << outcome.out;
  const std::string csv = slurp(folder.path() / "out/results.csv");
  EXPECT_NE(csv.find("backward-euler,4"), std::string::npos) << csv;
  EXPECT_NE(csv.find("sdirk2,2"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",front"), std::string::npos) << csv;
  EXPECT_NE(csv.find("fallback_ticks"), std::string::npos) << csv;
  const std::string page = slurp(folder.path() / "out/report.html");
  EXPECT_NE(page.find("Pareto front"), std::string::npos);
  EXPECT_NE(page.find("their orders in the step"), std::string::npos);
  EXPECT_NE(slurp(folder.path() / "out/results.json").find("ctpm-bench-results"), std::string::npos);
}

TEST(BenchCommand, SpendsAMillisecondOnTimeSpaceStructureAndPhase) {
  const TemporaryFolder folder;
  write_ball_scene(folder, R"("material": {"preset": "liver"},
    "fill": {"radius_mm": 4, "gap_mm": 4})");
  const ProgramOutcome outcome = run_ctpm({"bench", "ball.json", "-o", "out", "--quick"}, folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("ball: as the scene is, its force is off by"), std::string::npos) << outcome.out;
  const std::string csv = slurp(folder.path() / "out/results.csv");
  // The scene's own radius is among those compared, and no reference is.
  for (const char* row : {"space,ball,ctpm,,,,4,", "lattice phase,ball,ctpm,,,,4,", "organ structure,ball,tpm,,,,4,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row << "\n" << csv;
  EXPECT_EQ(csv.find("space,ball,ctpm,,,,2,"), std::string::npos) << csv;
  EXPECT_NE(slurp(folder.path() / "out/report.html").find("Where a millisecond buys most"), std::string::npos);
}

TEST(Bench, ErrorsOfWhatSleepsStandBesideWhatItSaves) {
  const TemporaryFolder folder;
  const importers::RawMesh ball = fidelity::ball_mesh(30e-3, 6e-3);
  std::ofstream(folder.path() / "ball.obj") << importers::to_obj(ball.vertex, ball.triangle);
  const auto scene = [&](const std::string& name, const std::string& more) {
    const std::filesystem::path path = folder.path() / (name + ".json");
    std::ofstream(path) << R"({"format": "ctpm-scene", "version": 1, "gravity_m_per_s2": [0, 0, 0], "name": ")" + name +
                               R"(", "organs": [
      {"name": "pressed", "mesh": "ball.obj", "anchors": [{"lowest_mm": 12}], "material": {"preset": "liver"}})" +
                               more + R"(], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8}]})";
    return path.string();
  };
  const std::string one = scene("one", ""), two = scene("two", R"(, {"name": "beside", "mesh": "ball.obj",
      "at_mm": [100, 0, 0], "anchors": [{"lowest_mm": 12}], "material": {"preset": "liver"}})");
  bench::BenchOptions options;
  options.scenes = {one, two};
  const auto studies = bench::run_bench_sleep(options, [](std::int64_t, std::int64_t) {});
  ASSERT_TRUE(studies);
  ASSERT_EQ(studies->size(), 1u) << "one organ is pressed as a whole";
  const reports::Table& table = studies->front().section.tables.front();
  const auto at = [&](std::size_t row, const char* key) {
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      if (table.columns[c].key == key) return std::get<double>(table.rows[row][c]);
    return std::nan("");
  };
  ASSERT_EQ(table.rows.size(), 5u);
  EXPECT_EQ(at(0, "asleep"), 0);
  for (std::size_t row = 1; row < 5; ++row) {
    EXPECT_NEAR(at(row, "asleep"), 0.5, 0.1) << row;
    EXPECT_LT(at(row, "force_error"), 1e-3) << row;
    EXPECT_LT(at(row, "farthest_mm"), 0.05) << row;
  }
  EXPECT_NE(studies->front().sentences.front().find("of the spheres sleep"), std::string::npos);
}

TEST(BenchCommand, LeavesOutSpheresThatAreTooCoarseForALayer) {
  const TemporaryFolder folder;
  write_ball_scene(folder, R"("material": {"preset": "liver"},
    "layers": [{"to_depth_mm": 20, "material": {"preset": "kidney"}}],
    "fill": {"radius_mm": 3, "gap_mm": 3})");
  const ProgramOutcome outcome = run_ctpm({"bench", "ball.json", "-o", "out", "--quick"}, folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string page = slurp(folder.path() / "out/report.html"), csv = slurp(folder.path() / "out/results.csv");
  const std::string said = "mm are too coarse for this scene and left out: ";
  std::vector<std::string> sentences;
  for (auto at = page.find(said); at != std::string::npos; at = page.find(said, at + 1)) {
    const auto begin = page.rfind("Spheres of r = ", at);
    sentences.push_back(page.substr(begin, page.find("</p>", at) - begin));
  }
  ASSERT_EQ(sentences.size(), 2u) << "in both studies";
  EXPECT_EQ(sentences[0], sentences[1]);
  EXPECT_NE(sentences[0].find(said + "/organs/0/layers/0/to_depth_mm: got 20 mm, which is deeper than the organ"),
            std::string::npos)
      << sentences[0];
  EXPECT_NE(csv.find("space,ball,ctpm,,,,3,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("lattice phase,ball,ctpm,,,,3,"), std::string::npos) << csv;
}

TEST(BenchCommand, ComparesTheSamePlacesWhereFinerFillingsDivideTheSurface) {
  const TemporaryFolder folder;
  const std::string skin = std::string(CTPM_SOURCE_DIR) + "/scenes/skin.json";
  const ProgramOutcome outcome = run_ctpm({"bench", skin, "-o", "out", "--quick"}, folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(slurp(folder.path() / "out/report.html").find("nan"), std::string::npos);
  std::istringstream csv(slurp(folder.path() / "out/results.csv"));
  const auto fields = [&](const std::string& line) {
    std::vector<std::string> found;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) found.push_back(field);
    return found;
  };
  std::string line;
  std::getline(csv, line);
  const std::vector<std::string> names = fields(line);
  const auto at = std::size_t(std::find(names.begin(), names.end(), "position_error") - names.begin());
  ASSERT_LT(at, names.size()) << line;
  int compared = 0;
  while (std::getline(csv, line))
    if (line.rfind("space,", 0) == 0) {
      const double error = std::stod(fields(line)[at]);
      EXPECT_TRUE(error > 0 && error < 1) << line << ": of places that are not the same, the error has no bound";
      ++compared;
    }
  EXPECT_EQ(compared, 3);
}

TEST(BenchCommand, ASceneWithoutABallIsRefusedWithItsName) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bare.json") << R"({
    "format": "ctpm-scene", "version": 1, "name": "bare",
    "organs": [{ "name": "block", "rig": { "block": [3, 3, 3] }, "material": { "preset": "liver" },
                 "anchors": [{ "lowest_mm": 0 }] }] })";
  const ProgramOutcome outcome = run_ctpm({"bench", "bare.json", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("bare.json"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("ball"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out")) << "what is refused leaves no folder";
}

}  // namespace
}  // namespace ctpm
