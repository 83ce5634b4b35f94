// The checked-in schemas and documentation are what the tables of fields give. After a change of a table:
//   CTPM_REFRESH=1 ctpm_scenes_tests --gtest_filter='CheckedIn*'
// writes them anew; look at the difference and commit it.

#include "scenes/schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "scenes/course.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"
#include "scenes/sweep.h"
#include "tests/scenes/schema_check.h"
#include "tests/scenes/shipped.h"

namespace ctpm {
namespace {

std::string folder() { return std::string(CTPM_SOURCE_DIR) + "/scenes/"; }

std::string content_of(const std::string& name) { return content_of_file(folder() + name); }

void expect_checked_in(const std::string& name, const std::string& text) {
  if (std::getenv("CTPM_REFRESH") != nullptr) std::ofstream(folder() + name, std::ios::binary) << text;
  EXPECT_TRUE(content_of(name) == text)
      << "scenes/" << name << " is not what the tables give; run this test with CTPM_REFRESH=1 and commit the file";
}

/// The file with the tables between its markers replaced.
std::string with_tables(const std::string& name, const std::string& tables) {
  const std::string text = content_of(name), begin = "<!-- generated: begin -->\n", end = "<!-- generated: end -->\n";
  const auto from = text.find(begin), to = text.find(end);
  if (from == std::string::npos || to == std::string::npos) return "the markers are missing";
  return text.substr(0, from + begin.size()) + "\n" + tables + "\n" + text.substr(to);
}

TEST(CheckedIn, TheSchemasAreThoseOfTheTables) {
  expect_checked_in("scene.schema.json", scenes::scene_schema());
  expect_checked_in("script.schema.json", scenes::script_schema());
  expect_checked_in("course.schema.json", scenes::course_schema());
  expect_checked_in("sweep.schema.json", scenes::sweep_schema());
}

TEST(CheckedIn, TheTablesOfTheDocumentationAreThoseOfTheReader) {
  expect_checked_in("FORMAT.md", with_tables("FORMAT.md", scenes::scene_reference()));
  expect_checked_in("SCRIPT.md", with_tables("SCRIPT.md", scenes::script_reference()));
  expect_checked_in("COURSE.md", with_tables("COURSE.md", scenes::course_reference()));
  expect_checked_in("SWEEP.md", with_tables("SWEEP.md", scenes::sweep_reference()));
}

/// The first JSON block of a Markdown file.
std::string example_in(const std::string& name) {
  const std::string text = content_of(name), mark = "```json\n";
  const auto from = text.find(mark) + mark.size();
  return text.substr(from, text.find("```", from) - from);
}

TEST(Documentation, ItsExamplesAreReadAndFitTheSchemas) {
  const Result<scenes::SceneText> scene = scenes::read_scene(example_in("FORMAT.md"), "FORMAT.md");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  const Result<scenes::Script> script = scenes::read_script(example_in("SCRIPT.md"), "SCRIPT.md", {"ball"});
  ASSERT_TRUE(script) << to_string(script.errors().front());
  const Result<scenes::SweepText> sweep = scenes::read_sweep(example_in("SWEEP.md"), "SWEEP.md");
  ASSERT_TRUE(sweep) << to_string(sweep.errors().front());
  EXPECT_EQ(SchemaCheck(scenes::sweep_schema()).problem_of(example_in("SWEEP.md")), "");
  EXPECT_EQ(SchemaCheck(scenes::scene_schema()).problem_of(example_in("FORMAT.md")), "");
  EXPECT_EQ(SchemaCheck(scenes::script_schema()).problem_of(example_in("SCRIPT.md")), "");
  const Result<scenes::CourseSpec> course = scenes::read_course(
      example_in("COURSE.md"), "COURSE.md", {"completion_time_s", "peak_force_n", "cut_path_mean_distance_mm"});
  ASSERT_TRUE(course) << to_string(course.errors().front());
  EXPECT_EQ(SchemaCheck(scenes::course_schema()).problem_of(example_in("COURSE.md")), "");
}

TEST(SceneSchema, AcceptsTheShippedScenesAndEverythingThatIsWritten) {
  const SchemaCheck schema(scenes::scene_schema());
  for (const std::string& path : shipped_scenes()) {
    EXPECT_EQ(schema.problem_of(content_of_file(path)), "") << path;
    const Result<scenes::SceneText> scene = scenes::load_scene(path);
    ASSERT_TRUE(scene) << path;
    EXPECT_EQ(schema.problem_of(scenes::write_scene(scene->spec)), "") << path;
  }
}

std::string organ_with(const std::string& keys) {
  return R"({"format": "ctpm-scene", "version": 1, "name": "s", "organs": [{"name": "a", "mesh": "a.obj", )" + keys +
         "}]}";
}

TEST(SceneSchema, RefusesWhatTheReaderRefuses) {
  const SchemaCheck schema(scenes::scene_schema());
  const std::string liver = R"("material": {"preset": "liver"})";
  ASSERT_EQ(schema.problem_of(organ_with(liver)), "");
  for (const std::string keys :
       {R"("mesh": "a.obj")", R"("material": {"preset": "pancreas"})", R"("material": [])",
        R"("material": {"spring_kpa_per_mm": 0})", R"("material": {"preset": "liver"}, "modle": "ctpm")",
        R"("material": {"preset": "liver"}, "model": "cptm")",
        R"("material": {"preset": "liver"}, "fill": {"radius_mm": 101})",
        R"("material": {"preset": "liver"}, "fill": {"radius_mm": "4"})",
        R"("material": {"preset": "liver"}, "softening": 1)",
        R"("material": {"preset": "liver"}, "surface_color": [0, 0])",
        R"("material": {"preset": "liver"}, "surface_color": [0, 0, 1.5])",
        R"("material": {"preset": "liver"}, "anchors": [{}])",
        R"("material": {"preset": "liver"}, "anchors": {"lowest_mm": 1})",
        R"("material": {"preset": "liver"}, "anchors": [{"sphere": {"centre_mm": [0, 0, 0], "radius_mm": 0}}])"}) {
    EXPECT_NE(schema.problem_of(organ_with(keys)), "") << keys;
    EXPECT_FALSE(scenes::read_scene(organ_with(keys), "s.json")) << keys;
  }
  EXPECT_NE(schema.problem_of(R"({"format": "ctpm-scene", "version": 2, "name": "s", "organs": []})"), "");
}

TEST(ScriptSchema, RefusesWhatTheReaderRefuses) {
  const SchemaCheck schema(scenes::script_schema());
  const auto script = [](const std::string& step) {
    return R"({"format": "ctpm-script", "version": 1, "steps": [)" + step + "]}";
  };
  ASSERT_EQ(schema.problem_of(script(R"({"wait_s": 1})")), "");
  EXPECT_EQ(schema.problem_of(script(R"({"put_away": true, "hand": 2})")), "");
  for (const std::string step :
       {R"({})", R"({"hand": 1})", R"({"put_away": true, "hand": 3})", R"({"put_away": true, "hand": 0})",
        R"({"wait_s": 1, "put_away": true})", R"({"wait_s": -1})", R"({"put_away": 1})", R"({"sleep": 1})",
        R"({"take": {"tool": "ball"}})", R"({"take": {"tool": "ball", "at_mm": [0, 0, 0], "speed": 1}})"}) {
    EXPECT_NE(schema.problem_of(script(step)), "") << step;
    EXPECT_FALSE(scenes::read_script(script(step), "s.json", {"ball"})) << step;
  }
}

}  // namespace
}  // namespace ctpm
