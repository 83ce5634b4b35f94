#include "scenes/course.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "scenes/schema.h"
#include "tests/scenes/schema_check.h"

namespace ctpm {
namespace {

const std::vector<std::string> kMeasures{"peak_force_n", "completion_time_s"};

/// A course with these marks, which begin in line 2 at column 1.
std::string course_of(const std::string& marks, const std::string& more = "") {
  return R"({"format": "ctpm-course", "version": 1, "name": "c", "tasks": [{"name": "t", "scene": "s.json", "experts": "e", "marks": [)"
         "\n" +
         marks + "\n]}]" + more + "}";
}

std::string errors_of(const std::string& text) {
  const Result<scenes::CourseSpec> course = scenes::read_course(text, "c.json", kMeasures);
  if (course) return "";
  std::string all;
  for (const Error& error : course.errors()) all += to_string(error) + "\n";
  return all;
}

TEST(Course, WhatItSaysIsRead) {
  const Result<scenes::CourseSpec> course =
      scenes::read_course(course_of(R"({"measure": "peak_force_n", "low": 0, "high": 9.5, "pass_at_most": 4})",
                                    R"(, "evidence": "a study", "intervals": {"seed": 7, "confidence": 0.9})"),
                          "c.json", kMeasures);
  ASSERT_TRUE(course) << to_string(course.errors().front());
  const scenes::MarkSpec& mark = course->tasks.at(0).marks.at(0);
  EXPECT_EQ(mark.measure, "peak_force_n");
  EXPECT_EQ(mark.high, 9.5);
  EXPECT_EQ(mark.pass_at_most, 4);
  EXPECT_FALSE(mark.pass_at_least);
  EXPECT_EQ(course->evidence, "a study");
  EXPECT_EQ(course->intervals.seed, 7);
  EXPECT_EQ(course->learning, scenes::LearningSpec());
}

TEST(Course, AllMistakesAreNamedAtOnceWithTheirPlaces) {
  EXPECT_EQ(errors_of(course_of("{\"measure\": \"peak_force\", \"low\": 1},\n"
                                "{\"measure\": \"completion_time_s\", \"low\": 5, \"high\": 4},\n"
                                "{\"measure\": \"completion_time_s\", \"pass_at_lest\": 5},\n"
                                "{\"measure\": \"peak_force_n\", \"low\": 1, \"high\": 2, \"pass_at_most\": 3}",
                                ",\n\"learning\": {\"acceptable_failures\": 0.4}")),
            "c.json:2:13: error: /tasks/0/marks/0/measure: there is no measure \"peak_force\" (did you mean "
            "\"peak_force_n\"?)\n"
            "c.json:3:52: error: /tasks/0/marks/1/high: must be above low\n"
            "c.json:4:13: error: /tasks/0/marks/2/measure: got \"completion_time_s\" twice\n"
            "c.json:4:34: error: /tasks/0/marks/2/pass_at_lest: unknown key \"pass_at_lest\" (did you mean "
            "\"pass_at_least\"?)\n"
            "c.json:5:66: error: /tasks/0/marks/3/pass_at_most: lies outside the declared range\n"
            "c.json:7:13: error: /learning/unacceptable_failures: must be above acceptable_failures\n");
}

TEST(Course, TheSchemaRefusesWhatTheReaderRefuses) {
  const SchemaCheck schema(scenes::course_schema());
  const std::string good = R"({"measure": "peak_force_n", "pass_at_most": 4})";
  ASSERT_EQ(schema.problem_of(course_of(good)), "");
  ASSERT_EQ(errors_of(course_of(good)), "");
  for (const auto& [marks, more] :
       std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                        {R"({"pass_at_most": 4})", ""},
                                                        {R"({"measure": "peak_force_n", "low": "1"})", ""},
                                                        {good, R"(, "learning": {"acceptable_failures": 1})"},
                                                        {good, R"(, "intervals": {"resamples": 10})"},
                                                        {good, R"(, "marks": [])"}}) {
    EXPECT_NE(schema.problem_of(course_of(marks, more)), "") << marks << more;
    EXPECT_NE(errors_of(course_of(marks, more)), "") << marks << more;
  }
}

TEST(Course, ScenesAndExpertsThatAreMissingAreFound) {
  const std::string path = ::testing::TempDir() + "course-test.json";
  std::ofstream(path) << course_of(R"({"measure": "peak_force_n"})");
  EXPECT_TRUE(scenes::is_course(path));
  const Result<scenes::CourseSpec> course = scenes::load_course(path, kMeasures);
  ASSERT_FALSE(course);
  ASSERT_EQ(course.errors().size(), 2u);
  EXPECT_NE(course.errors()[0].message.find("there is no scene file \"s.json\""), std::string::npos);
  EXPECT_NE(course.errors()[1].message.find("there is no folder \"e\""), std::string::npos);
  EXPECT_FALSE(scenes::is_course(std::string(CTPM_SOURCE_DIR) + "/scenes/liver.json"));
}

}  // namespace
}  // namespace ctpm
