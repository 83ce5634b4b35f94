#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/studio/commands/run_program.h"

namespace ctpm {

namespace fs = std::filesystem;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;

inline bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Experts, two trainees and a course, made once for all tests.
class CohortProgram : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new testing::TemporaryFolder;
    write("block.json", scene("ball"));
    write("other.json", scene("pusher"));
    for (const auto& [name, depth] : std::vector<std::pair<std::string, double>>{{"experts/e1", 11.5},
                                                                                 {"experts/e2", 12},
                                                                                 {"experts/e3", 12.5},
                                                                                 {"trainees/Ana/1", 16},
                                                                                 {"trainees/Ana/2", 12},
                                                                                 {"trainees/Ana/3", 12.2},
                                                                                 {"trainees/Ben/1", 18},
                                                                                 {"trainees/Ben/2", 17}})
      record("block.json", "ball", name, depth);
    record("other.json", "pusher", "trainees/Ben/other", 12);
    write("course.json", course(R"({"measure": "peak_force_n", "low": 0, "high": 50, "pass_at_most": LIMIT},
                                   {"measure": "completion_time_s"})"));
  }
  static void TearDownTestSuite() { delete folder_, folder_ = nullptr; }

  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static void write(const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(path(name)).parent_path());
    std::ofstream(path(name)) << text;
  }
  static ProgramOutcome ctpm(const std::vector<std::string>& arguments) { return run_ctpm(arguments, folder_->path()); }

  static std::string scene(const std::string& tool) {
    return R"({"format": "ctpm-scene", "version": 1, "name": "block", "settle_s": 0, "organs": [{"name": "block",
      "rig": {"block": [4, 4, 3]}, "material": {"preset": "liver"}, "anchors": [{"lowest_mm": 1}]}],
      "tools": [{"name": ")" +
           tool + R"(", "kind": "ball", "radius_mm": 8}]})";
  }
  static void record(const std::string& scene, const std::string& tool, const std::string& name, double depth) {
    std::ostringstream script;
    script << R"({"format": "ctpm-script", "version": 1, "steps": [{"take": {"tool": ")" << tool
           << R"(", "at_mm": [0, 0, 45]}}, {"press": {"distance_mm": )" << depth
           << R"(, "speed_mm_per_s": 60}}, {"wait_s": 0.05}, {"release": {"distance_mm": 12, "speed_mm_per_s": 60}},
              {"put_away": true}]})";
    write("script.json", script.str());
    fs::create_directories(fs::path(path(name)).parent_path());
    const ProgramOutcome recorded = ctpm({"record", scene, "--script", "script.json", "-o", name + ".ctpm", "--fast"});
    ASSERT_EQ(recorded.code, 0) << recorded.err;
  }
  /// The course with a limit between the experts' peak forces and those of the worst presses.
  static std::string course(std::string marks) {
    const double limit = 0.5 * (peak("experts/e3.ctpm") + peak("trainees/Ana/1.ctpm"));
    if (const auto at = marks.find("LIMIT"); at != std::string::npos) marks.replace(at, 5, std::to_string(limit));
    return R"({"format": "ctpm-course", "version": 1, "name": "Pressing", "tasks": [{"name": "press",
      "scene": "block.json", "experts": "experts", "marks": [)" +
           marks + R"(]}],
      "learning": {"acceptable_failures": 0.3, "unacceptable_failures": 0.7, "false_alarm": 0.3, "missed": 0.3}})";
  }
  static double peak(const std::string& session) {
    const auto info = nlohmann::json::parse(ctpm({"info", session, "--json"}).out);
    return info["max_force_n"];
  }
  /// The rows of results.csv, as fields without quotes.
  static std::vector<std::vector<std::string>> rows_of(const std::string& folder) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream text(slurp(path(folder + "/results.csv")));
    for (std::string line; std::getline(text, line);) {
      rows.emplace_back();
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
    }
    return rows;
  }
  /// The value of a measure of a person's attempt in results.csv; empty: there is none.
  static std::string value_in(const std::string& folder, const std::string& person, int attempt,
                              const std::string& measure) {
    for (const auto& row : rows_of(folder))
      if (row[3] == person && row[4] == std::to_string(attempt) && row[9] == measure) return row[11];
    return "no row";
  }

  static inline testing::TemporaryFolder* folder_ = nullptr;
};

}  // namespace ctpm
