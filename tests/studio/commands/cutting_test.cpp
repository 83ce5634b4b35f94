// A session with a scalpel, from outside: the force on the hand and the pieces that come loose.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "core/cutbody/cut_grid.h"
#include "core/cutting/cutting.h"
#include "recordings/session_reader.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using testing::run_ctpm;
using testing::TemporaryFolder;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr const char* kScene = R"({
  "format": "ctpm-scene", "version": 1, "name": "bar", "gravity_m_per_s2": [0, 0, 0], "settle_s": 0,
  "organs": [{ "name": "bar", "rig": { "block": [6, 3, 3] }, "material": { "preset": "liver" },
               "anchors": [{ "box": { "min_mm": [-40, -40, -1], "max_mm": [-10, 40, 40] } },
                           { "box": { "min_mm": [10, -40, -1], "max_mm": [40, 40, 40] } }] }],
  "tools": [{ "name": "scalpel", "kind": "scalpel", "blade_length_mm": 60 }] })";
constexpr const char* kScript = R"({
  "format": "ctpm-script", "version": 1, "steps": [
    { "take": { "tool": "scalpel", "at_mm": [0.2, -60, -15] } },
    { "cut": { "path_mm": [[0.2, 60, -15]], "speed_mm_per_s": 100 } },
    { "put_away": true }, { "wait_s": 0.2 }] })";

TEST(CuttingSession, ASlowStrokeIsOneCutHoweverRarelyItSevers) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bar.json") << kScene;
  std::ofstream(folder.path() / "script.json") << R"({
    "format": "ctpm-script", "version": 1, "steps": [
      { "take": { "tool": "scalpel", "at_mm": [0.2, -30, -15] } },
      { "cut": { "path_mm": [[0.2, 30, -15]], "speed_mm_per_s": 15 } }, { "put_away": true }] })";
  const auto recorded =
      run_ctpm({"record", "bar.json", "--script", "script.json", "-o", "cut.ctpm", "--fast"}, folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  // Only a ball and a pin have a depth.
  EXPECT_FALSE(holds(recorded.out, "mm deep")) << recorded.out;
  const auto info = run_ctpm({"info", "cut.ctpm"}, folder.path());
  EXPECT_FALSE(holds(info.out, "mm deep")) << info.out;
  const std::size_t first = info.out.find("begins to sever");
  ASSERT_NE(first, std::string::npos) << info.out;
  EXPECT_EQ(info.out.find("begins to sever", first + 1), std::string::npos) << info.out;
  auto reader = recordings::SessionReader::open((folder.path() / "cut.ctpm").string());
  ASSERT_TRUE(reader);
  const auto records = reader->ticks(0, reader->tick_count());
  ASSERT_TRUE(records);
  std::vector<std::int64_t> severing;
  for (std::size_t tick = 0; tick < records->size(); ++tick)
    if ((*records)[tick].severed > 0) severing.push_back(std::int64_t(tick));
  std::int64_t longest = 0;
  for (std::size_t i = 1; i < severing.size(); ++i) longest = std::max(longest, severing[i] - severing[i - 1]);
  EXPECT_GT(longest, 300) << "else it would be no test";
  EXPECT_EQ(run_ctpm({"verify", "cut.ctpm"}, folder.path()).code, 0);
}

TEST(CuttingSession, TellsTheForceAndThePieceThatComesLoose) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bar.json") << kScene;
  std::ofstream(folder.path() / "script.json") << kScript;
  const auto recorded =
      run_ctpm({"record", "bar.json", "--script", "script.json", "-o", "cut.ctpm", "--fast"}, folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const auto verified = run_ctpm({"verify", "cut.ctpm"}, folder.path());
  EXPECT_EQ(verified.code, 0) << verified.out;
  const auto info = run_ctpm({"info", "cut.ctpm"}, folder.path());
  EXPECT_TRUE(holds(info.out, ", 1 piece came loose")) << info.out;
  EXPECT_TRUE(holds(info.out, "piece came loose: pieces that came loose: 1")) << info.out;
  const auto json = run_ctpm({"info", "cut.ctpm", "--json"}, folder.path());
  EXPECT_TRUE(holds(json.out, "\"pieces_came_loose\": 1")) << json.out;

  // The video says so too, whether or not the moment itself is shown.
  for (const char* from : {"0", "1.1"}) {
    const auto exported = run_ctpm(
        {"export", "cut.ctpm", "-o", "cut.avi", "--size", "320x180", "--fps", "5", "--from-s", from, "--overwrite"},
        folder.path());
    ASSERT_EQ(exported.code, 0) << exported.err;
    EXPECT_TRUE(holds(testing::slurp(folder.path() / "cut.avi.json"), "\"pieces_came_loose\": 1")) << from;
  }
  const auto before = run_ctpm(
      {"export", "cut.ctpm", "-o", "before.avi", "--size", "320x180", "--fps", "5", "--to-s", "0.4"}, folder.path());
  ASSERT_EQ(before.code, 0) << before.err;
  EXPECT_TRUE(holds(testing::slurp(folder.path() / "before.avi.json"), "\"pieces_came_loose\": 0"));

  // The force of the CSV: none before, newtons while it cuts, none after.
  const auto replayed = run_ctpm({"replay", "cut.ctpm", "--csv", "cut.csv"}, folder.path());
  ASSERT_EQ(replayed.code, 0) << replayed.err;
  std::istringstream csv(testing::slurp(folder.path() / "cut.csv"));
  std::vector<double> force;
  std::size_t column = 0;
  for (std::string line; std::getline(csv, line);) {
    std::istringstream cells(line);
    std::size_t c = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++c) {
      if (cell == "force_n") column = c;
      if (c == column && column > 0 && cell != "force_n") force.push_back(std::stod(cell));
    }
  }
  ASSERT_GT(force.size(), 1000u);
  EXPECT_EQ(force.front(), 0);
  EXPECT_EQ(force.back(), 0);
  const double most = *std::max_element(force.begin(), force.end());
  EXPECT_GT(most, 1);  // 164 J/m^2 times 36 mm is 6 N
  EXPECT_LT(most, 40);
}

TEST(CuttingSession, SkinUnderTensionGapesWhereItIsCut) {
  const std::string shipped = std::string(CTPM_SOURCE_DIR) + "/scenes/";
  const TemporaryFolder folder;
  const auto recorded = run_ctpm({"record", shipped + "skin-incision.json", "--script",
                                  shipped + "scripts/skin-incision-cut.json", "-o", "cut.ctpm", "--fast"},
                                 folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  auto reader = recordings::SessionReader::open((folder.path() / "cut.ctpm").string());
  ASSERT_TRUE(reader);
  const auto before = reader->keyframe_at_or_before(0), after = reader->keyframe_at_or_before(1'000'000);
  ASSERT_TRUE(before && after);
  // The spheres of the skin beside the cut's middle.
  const Model& model = reader->start().model;
  const auto lip = [&](double y) {
    std::size_t nearest = 0;
    const auto off = [&](std::size_t i) { return norm(model.rest_position[i] - Vec3{0, y, 0.022}); };
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      if (off(i) < off(nearest)) nearest = i;
    return nearest;
  };
  const auto apart = [&](const State& state) { return state.position[lip(7e-3)].y - state.position[lip(-7e-3)].y; };
  EXPECT_GT(apart(after->state), apart(before->state) + 6e-3);
  EXPECT_LT(apart(after->state), apart(before->state) + 12e-3) << "the fat below still holds it";
}

/// The shipped incision: under its tense capsule tissue slides sideways along the blade, and the cut lies within a
/// third of a millimetre of a row of spheres.
TEST(CuttingSession, SeversWhatTheBladeSweptAndLeavesNoSphereWithoutTissue) {
  const std::string scenes = std::string(CTPM_SOURCE_DIR) + "/scenes/";
  const TemporaryFolder folder;
  const auto recorded = run_ctpm({"record", scenes + "incision.json", "--script", scenes + "scripts/incision-cut.json",
                                  "-o", "cut.ctpm", "--fast", "--duration-s", "4.5"},
                                 folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  auto reader = recordings::SessionReader::open((folder.path() / "cut.ctpm").string());
  ASSERT_TRUE(reader);
  const auto keyframe = reader->keyframe_at_or_before(1'000'000);
  ASSERT_TRUE(keyframe);
  const Model& model = reader->start().model;
  const State& state = keyframe->state;

  // Elements are crossed where the swept surface is.
  const cutting::RestMap map(model);
  const cutting::TissueDepth depth(model, map);
  const cutting::SweptBoxes boxes = cutting::boxes_of_rows(state);
  const cutting::RestElements elements(model, depth);
  const double spacing = model.organs[0].spacing;
  std::vector<int> before(model.sphere_count(), 0), after(model.sphere_count(), 0);
  int severed = 0;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const auto a = std::size_t(model.axial.a[e]), b = std::size_t(model.axial.b[e]);
    ++before[a], ++before[b];
    if (!state.axial_severed[e]) {
      ++after[a], ++after[b];
      continue;
    }
    const Vec3 p = elements.place(a), q = elements.place(b);
    const Vec3 crossing = p + cutting::crossing_of(state.axial_crossing[e]) * (q - p);
    const double far = cutting::kCrossingUnit * norm(q - p) + 1e-4;
    EXPECT_TRUE(cutting::nearest_swept(state, boxes, 0, crossing, far)) << e;
    ++severed;
  }
  EXPECT_GT(severed, 100);
  for (std::size_t i = 0; i < model.sphere_count(); ++i) EXPECT_GE(4 * after[i], before[i]) << "sphere " << i;

  // What is drawn follows spheres of its own side, also those that lie outside the organ.
  cutbody::CutGrid grid(model, 0);
  (void)grid.update(state);
  int looked_at = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const std::int32_t home = grid.node_of_sphere(std::int32_t(i));
    const Vec3 p = model.rest_position[i];
    const auto swept = cutting::nearest_swept(state, boxes, 0, p, 0.4 * spacing);
    if (home < 0 || depth.at(0, p) > 0 || !swept || std::abs(p.y - swept->y) < 1e-4) continue;
    EXPECT_EQ(p.y > swept->y, grid.rest(home).y > swept->y) << "sphere " << i;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 3);
}

}  // namespace
}  // namespace ctpm
