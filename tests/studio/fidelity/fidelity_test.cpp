// Recipes on small cases, the report's files, and bad input.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "importers/mesh.h"
#include "studio/fidelity/fidelity.h"
#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using reports::ReportVerdict;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;
using testing::TemporaryFolder;

TEST(Figure, MeetsItsGoalOrMissesItOrIsOnlyShown) {
  fidelity::Figure figure{.recipe = "any", .measured = 1.04, .reference = 1.0, .goal = fidelity::Goal{0.95, 1.05}};
  EXPECT_EQ(figure.verdict(), ReportVerdict::met);
  EXPECT_NEAR(figure.error(), 0.04, 1e-12);
  figure.measured = 1.06;
  EXPECT_EQ(figure.verdict(), ReportVerdict::missed);
  figure.measured = std::nan("");
  EXPECT_EQ(figure.verdict(), ReportVerdict::missed) << "what could not be measured meets nothing";
  figure.goal.reset();
  EXPECT_EQ(figure.verdict(), ReportVerdict::shown);
  EXPECT_EQ(fidelity::Goal({}, 0.3).text("mm"), "at most 0.3 mm");
  EXPECT_EQ(fidelity::Goal(0.95, 1.05).text("1"), "0.95 to 1.05");
  EXPECT_EQ(fidelity::Goal(1.5, {}).text("1"), "at least 1.5");
}

TEST(Tension, AFinerBarIsNearerToTheSolid) {
  const double radii[] = {4e-3, 2e-3};
  const Result<fidelity::TensionResult> result = fidelity::measure_tension(radii);
  ASSERT_TRUE(bool(result)) << to_string(result.errors()[0]);
  const auto off = [&](std::size_t i) { return std::abs(result->rows[i].modulus_ratio - 1); };
  EXPECT_LT(off(1), 0.01);
  EXPECT_LT(off(1), 0.2);
  for (const fidelity::TensionResult::Row& row : result->rows) EXPECT_NEAR(row.poisson, 0.25, 0.1);
}

TEST(Relaxation, AFastRampRelaxesAndEndsAtTheFinalForce) {
  const double radii[] = {4e-3}, ramps[] = {0.05};
  const Result<fidelity::RelaxationResult> result = fidelity::measure_relaxation(radii, ramps);
  ASSERT_TRUE(bool(result)) << to_string(result.errors()[0]);
  for (const double ratio : result->rows[0].ratios) EXPECT_GT(ratio, 1.1);
  EXPECT_NEAR(result->rows[0].force.y.back(), 1, 1e-3);
}

TEST(FirstContact, IsFoundAtEveryPlace) {
  const double radii[] = {4e-3};
  const Result<fidelity::FirstContactResult> result = fidelity::measure_first_contact(radii, 2);
  ASSERT_TRUE(bool(result)) << to_string(result.errors()[0]);
  EXPECT_EQ(result->rows.size(), 2u);
  for (const fidelity::FirstContactResult::Row& row : result->rows) {
    EXPECT_EQ(row.depths.size(), 4u);
    for (const double depth : row.depths) EXPECT_LT(std::abs(depth), 6e-3) << "half a spacing";
  }
}

TEST(FreeMotion, AFreeBodyFallsAsFastAsAnyOther) {
  const Result<fidelity::FreeMotionResult> result = fidelity::measure_free_motion(4e-3);
  ASSERT_TRUE(bool(result)) << to_string(result.errors()[0]);
  EXPECT_NEAR(result->fall, 1, 0.01);
  EXPECT_LE(result->angular_momentum, 1 + 1e-6);
}

TEST(Recipes, HaveKeysOfTheirOwn) {
  std::vector<std::string> keys;
  for (const fidelity::RecipeInfo& recipe : fidelity::fidelity_recipes()) keys.emplace_back(recipe.key);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
  EXPECT_GE(keys.size(), 12u);
}

TEST(FidelityCommand, WritesAReportOfTheRecipesThatAreAskedFor) {
  const TemporaryFolder folder;
  const ProgramOutcome outcome =
      run_ctpm({"fidelity", "-o", "out", "--quick", "--only", "tension,free-motion"}, folder.path());
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << outcome.err;
  const std::string csv = slurp(folder.path() / "out/results.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n') - (csv[csv.find('\n') - 1] == '\r')),
            "recipe,figure,radius_mm,measured,unit,reference,source,error_percent,goal_least,goal_most,verdict,note");
  EXPECT_NE(csv.find("tension,E / E0,4,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("free-motion,angular momentum"), std::string::npos) << csv;
  const std::string json = slurp(folder.path() / "out/results.json");
  for (const char* key : {"\"format\": \"ctpm-fidelity-results\"", "\"is_quick\": true", "\"goals_met\"",
                          "\"goals_missed\"", "\"figures\"", "\"recipes\"", "\"key\": \"tension\"", "\"plots\""})
    EXPECT_NE(json.find(key), std::string::npos) << key;
  const std::string page = slurp(folder.path() / "out/report.html");
  EXPECT_NE(page.find("Tension of a bar"), std::string::npos);
  EXPECT_NE(page.find("Short form"), std::string::npos);
  EXPECT_LT(page.find("Must hold: "), page.find("Of what the goals allow"));
  EXPECT_LT(page.find("Of what the goals allow"), page.find("<table"));
  EXPECT_EQ(outcome.code == 0, page.find("<li>Missed: ") == std::string::npos) << "what is missed is named";
  EXPECT_EQ(outcome.code == 0, json.find("\"goals_missed\": 0") != std::string::npos);
}

TEST(FidelityCommand, NamesEveryRecipeThatDoesNotExistOrNeedsAScene) {
  const TemporaryFolder folder;
  const ProgramOutcome outcome =
      run_ctpm({"fidelity", "-o", "deep/out/", "--only", "nothing,tension,scene-turns,neither"}, folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "deep")) << "what is refused leaves no folder";
  for (const char* part : {"--only", "no recipe nothing", "no recipe neither", "scene-turns needs a scene"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
}

/// A scene of a small block under a ball of 6 mm.
void write_scene(const std::filesystem::path& folder, const std::string& tool) {
  const importers::RawMesh box = fidelity::box_mesh({-0.03, -0.03, 0}, {0.03, 0.03, 0.04}, 4e-3);
  std::ofstream(folder / "block.obj") << importers::to_obj(box.vertex, box.triangle);
  std::ofstream(folder / "block.json") << R"({"format": "ctpm-scene", "version": 1, "name": "block",
  "organs": [{"name": "block", "mesh": "block.obj", "material": {"preset": "liver"},
              "fill": {"radius_mm": 4, "gap_mm": 4}, "anchors": [{"lowest_mm": 7}]}],
  "tools": [)" << tool << "]}";
}

TEST(FidelityCommand, MeasuresTheOrganOfAScene) {
  const TemporaryFolder folder;
  write_scene(folder.path(), R"({"name": "finger", "kind": "ball", "radius_mm": 6})");
  const ProgramOutcome outcome = run_ctpm({"fidelity", "block.json", "-o", "out", "--quick"}, folder.path());
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << outcome.err;
  const std::string csv = slurp(folder.path() / "out/results.csv");
  EXPECT_NE(csv.find("scene-turns,scatter over turns"), std::string::npos) << csv;
  EXPECT_NE(csv.find("scene-places,scatter over places"), std::string::npos) << csv;
  EXPECT_NE(csv.find("scene-places,\"first force"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("tension"), std::string::npos) << "a scene runs its own recipes only";
  EXPECT_NE(slurp(folder.path() / "out/report.html").find("finger of 6 mm"), std::string::npos);
}

TEST(FidelityCommand, SaysWhereASceneHasNothingToPressWith) {
  const TemporaryFolder folder;
  write_scene(folder.path(), R"({"name": "blade", "kind": "scalpel", "blade_length_mm": 30})");
  const ProgramOutcome outcome = run_ctpm({"fidelity", "block.json", "-o", "out", "--quick"}, folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("block.json:4:"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("/tools: there is no ball"), std::string::npos) << outcome.err;
}

TEST(FidelityCommand, SaysThatARigCannotBeTurned) {
  const TemporaryFolder folder;
  const ProgramOutcome outcome =
      run_ctpm({"fidelity", CTPM_SOURCE_DIR "/scenes/paper/block-liver.json", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("rig"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace ctpm
