// `ctpm compare` from outside: an expert's press beside a clumsy one, and everything that it refuses.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>

#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run_ctpm;
using testing::slurp;

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes";
const std::string kShipped = CTPM_SHIPPED_SESSIONS;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The number behind `"name": ` within the object that holds `"key": "KEY"`; NaN if there is none.
double value_of(const std::string& json, const std::string& key, const std::string& name) {
  const auto at = json.find("\"key\": \"" + key + "\"");
  if (at == std::string::npos) return NAN;
  const auto end = json.find('}', at), found = json.find("\"" + name + "\": ", at);
  return found < end ? std::strtod(json.c_str() + found + name.size() + 4, nullptr) : NAN;
}

/// Works beside the shipped sessions. A replay of them takes seconds: what asks for no replayed force says --no-verify.
class Compare : public ::testing::Test {
 protected:
  /// What `compare --json` prints of the shipped presses, replayed: once for all tests.
  const testing::ProgramOutcome& presses() const {
    static const testing::ProgramOutcome kCompared = compare(press_, hard_press_, {"--json"});
    return kCompared;
  }
  testing::ProgramOutcome compare(const std::string& expert, const std::string& trainee,
                                  const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{"compare", expert, trainee};
    command.insert(command.end(), more.begin(), more.end());
    return run_ctpm(command, folder_.path());
  }

  const std::string press_ = kShipped + "/liver-press-expert.ctpm", hard_press_ = kShipped + "/liver-press-clumsy.ctpm";
  const std::string cut_ = kShipped + "/kidney-cut-expert.ctpm", clumsy_cut_ = kShipped + "/kidney-cut-clumsy.ctpm";
  const testing::TemporaryFolder folder_;
};

TEST_F(Compare, AClumsyCutIsWorseInEveryMeasureThatHasAnExpertsValue) {
  const auto compared = compare(cut_, clumsy_cut_, {"--json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const std::string& json = compared.out;
  for (const char* lower : {"completion_time_s", "path_length_mm", "idle_time_s"})
    EXPECT_GT(value_of(json, lower, "trainee"), value_of(json, lower, "expert")) << lower;
  for (const char* higher : {"economy_of_motion", "spectral_arc_length", "log_dimensionless_jerk"})
    EXPECT_LT(value_of(json, higher, "trainee"), value_of(json, higher, "expert")) << higher;
  EXPECT_GT(value_of(json, "elements_severed_by_expert_only", "trainee"), 0);
  EXPECT_GT(value_of(json, "elements_severed_by_trainee_only", "trainee"), 0);
  EXPECT_EQ(value_of(json, "elements_severed", "expert"),
            value_of(json, "elements_severed_by_both", "trainee") +
                value_of(json, "elements_severed_by_expert_only", "trainee"));
  // The blade's depth is that along the blade: its largest is that of the cut, within what it goes in 0.01 s.
  const auto plot = json.find("Depth of the blade in the tissue"), curve = json.find("\"name\": \"expert\"", plot);
  ASSERT_NE(plot, std::string::npos);
  const auto values = json.find("\"y\": [", curve);
  double deepest = 0;
  const char* at = json.c_str() + values + 6;
  for (char* end = nullptr; *at != ']'; at = end) deepest = std::max(deepest, std::strtod(at + 1, &end));
  EXPECT_NEAR(deepest, value_of(json, "cut_depth_along_blade_mm", "expert"), 0.5);
  EXPECT_TRUE(std::isnan(value_of(json, "largest_depth_mm", "trainee"))) << "a blade pushes nothing";
  // The second cut lies 10 to 14 mm beside the first.
  EXPECT_GT(value_of(json, "cut_path_hausdorff_mm", "trainee"), 8);
  EXPECT_TRUE(holds(json, "\"what\": \"cut where the expert did not\"")) << json;
  EXPECT_LT(json.find("Cut only where"), json.find("Stay on the expert's path")) << "harm comes first";
}

TEST_F(Compare, AHardPressPassesTheForceOfTheExpertAndTheDamageDepth) {
  const testing::ProgramOutcome& compared = presses();
  ASSERT_EQ(compared.code, 0) << compared.err;
  EXPECT_EQ(value_of(compared.out, "time_above_force_limit_s", "expert"), 0);
  EXPECT_GT(value_of(compared.out, "time_above_force_limit_s", "trainee"), 0.1);
  EXPECT_EQ(value_of(compared.out, "time_beyond_damage_depth_s", "expert"), 0);
  EXPECT_GT(value_of(compared.out, "time_beyond_damage_depth_s", "trainee"), 0);
  // A limit that is given holds for both.
  const auto strict = compare(press_, hard_press_, {"--json", "--no-verify", "--force-limit", "0.5"});
  ASSERT_EQ(strict.code, 0) << strict.err;
  EXPECT_GT(value_of(strict.out, "time_above_force_limit_s", "expert"), 0);
  EXPECT_GT(value_of(strict.out, "impulse_above_force_limit_n_s", "trainee"),
            value_of(compared.out, "impulse_above_force_limit_n_s", "trainee"));
}

TEST_F(Compare, ASessionBesideItselfIsTheSame) {
  const auto compared = compare(cut_, cut_, {"--json", "--no-verify"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  EXPECT_EQ(value_of(compared.out, "cut_overlap", "trainee"), 1);
  for (const char* none : {"cut_path_mean_distance_mm", "cut_path_hausdorff_mm", "aligned_deviation_mean_mm",
                           "elements_severed_by_trainee_only"})
    EXPECT_EQ(value_of(compared.out, none, "trainee"), 0) << none;
  EXPECT_FALSE(holds(compared.out, "worse")) << compared.out;
  EXPECT_TRUE(holds(compared.out, "\"moments\": []")) << compared.out;
}

TEST_F(Compare, WritesOnePageThatLoadsNothingAndItsNumbers) {
  const auto compared = compare(press_, hard_press_, {"-o", "report"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  EXPECT_TRUE(holds(compared.out, "peak force")) << compared.out;
  EXPECT_TRUE(holds(compared.out, "worst moments")) << compared.out;
  const std::string page = slurp(folder_.path() / "report/report.html");
  for (const char* part : {"Worst moments first", "Force on the tool", "Path of the tool, from above",
                           "Path of the tool, from the side", "aligned in time", "Balasubramanian"})
    EXPECT_TRUE(holds(page, part)) << part;
  for (const char* loading : {"src=\"http", "href=\"http", "<script src", "@import", "fetch("})
    EXPECT_FALSE(holds(page, loading)) << loading;
  const auto pause = page.find("long pause");
  ASSERT_NE(pause, std::string::npos);
  EXPECT_LT(page.find("force above the limit"), pause);  // the gravest comes first
  EXPECT_FALSE(holds(page, "away from the expert"))
      << "it is below the expert's path for pressing too deep, which is said";
  // What to do better comes before everything else; events of the plots lead to pictures of both hands.
  EXPECT_LT(page.find("Press more gently: 7.8"), page.find("<h2>"));
  int events = 0;
  for (auto at = page.find("href=\"#"); at != std::string::npos; at = page.find("href=\"#", at + 1), ++events) {
    const std::string place = page.substr(at + 7, page.find('"', at + 7) - at - 7);
    EXPECT_TRUE(holds(page, "<figure id=\"" + place + "\"><img")) << "a picture of " << place;
  }
  EXPECT_GE(events, 4);
  std::size_t pictures = 0;
  for (auto at = page.find("<img"); at != std::string::npos; at = page.find("<img", at + 1)) ++pictures;
  EXPECT_EQ(pictures, 8u);
  const std::string results = slurp(folder_.path() / "report/results.json");
  EXPECT_LT(results.find("Press more gently: 7.8"), results.find("\"measures\""));
  EXPECT_EQ(results, presses().out);
}

TEST_F(Compare, NamesTheCommandThatShowsTheWorstMoment) {
  const auto compared = compare(press_, hard_press_, {"--no-verify"});
  const auto at = compared.out.find("to see the worst: ctpm export ");
  ASSERT_NE(at, std::string::npos) << compared.out;
  std::istringstream words(compared.out.substr(at + std::string("to see the worst: ctpm ").size()));
  std::vector<std::string> command{std::istream_iterator<std::string>(words), {}};
  for (const char* more : {"--size", "320x180", "--fps", "5"}) command.push_back(more);
  const auto exported = run_ctpm(command, folder_.path());
  EXPECT_EQ(exported.code, 0) << exported.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "worst.mp4"));
}

TEST_F(Compare, TheCommandThatShowsTheWorstMomentCanBeTypedWhateverTheFileIsCalled) {
  fs::copy_file(hard_press_, folder_.path() / "Ana's press 1.ctpm");
  const auto compared = compare(press_, "Ana's press 1.ctpm", {"--no-verify"});
  EXPECT_TRUE(holds(compared.out, "to see the worst: ctpm export 'Ana'\\''s press 1.ctpm' -o worst.mp4 "))
      << compared.out;
}

TEST_F(Compare, ASessionThatGoesOnFromAnotherIsMeasuredWithAWarning) {
  const std::string script = kScenes + "/scripts/kidney-cut-expert.json";
  const auto recorded = run_ctpm({"record", "--continue", clumsy_cut_, "--at", "6", "--script", script, "-o", "on.ctpm",
                                  "--fast", "--duration-s", "2"},
                                 folder_.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const auto compared = compare(cut_, "on.ctpm", {"--json", "--no-verify"});
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_TRUE(holds(compared.err, "warning: the sessions begin from different states")) << compared.err;
  // What was severed before the session began is not counted as done in it.
  EXPECT_LT(value_of(compared.out, "elements_severed", "trainee"),
            value_of(compared.out, "elements_severed", "expert"));
}

TEST_F(Compare, SessionsOfDifferentScenesAreRefusedWithTheReason) {
  const auto other_organ = compare(press_, clumsy_cut_, {"-o", "none"});
  EXPECT_EQ(other_organ.code, 2);
  EXPECT_TRUE(holds(other_organ.err, "its organs are kidney instead of liver")) << other_organ.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "none"));

  // The same kidney, half as stiff: as many spheres and elements, other forces.
  std::string scene = slurp(kScenes + "/kidney.json");
  const std::string scale = "\"stiffness_scale\": 1.32065";
  int replaced = 0;
  for (auto at = scene.find(scale); at != std::string::npos; at = scene.find(scale), ++replaced)
    scene.replace(at, scale.size(), "\"stiffness_scale\": 0.660325");
  ASSERT_EQ(replaced, 2) << "of the organ and of its capsule";
  fs::create_directory(folder_.path() / "organs");
  fs::copy_file(kScenes + "/organs/kidney.obj", folder_.path() / "organs/kidney.obj");
  std::ofstream(folder_.path() / "soft.json") << scene;
  const auto recorded = run_ctpm({"record", "soft.json", "-o", "soft.ctpm", "--fast", "--duration-s", "0.2", "--script",
                                  kScenes + "/scripts/kidney-cut-expert.json"},
                                 folder_.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const auto softer = compare(cut_, "soft.ctpm");
  EXPECT_EQ(softer.code, 2);
  EXPECT_TRUE(holds(softer.err, "its network differs in organs[0].modulus")) << softer.err;
}

TEST_F(Compare, DamagedAndMissingSessionsAreSaidSo) {
  std::string bytes = slurp(clumsy_cut_);
  bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(folder_.path() / "flipped.ctpm", std::ios::binary) << bytes;
  const auto flipped = compare(cut_, "flipped.ctpm");
  EXPECT_EQ(flipped.code, 2) << flipped.out;
  EXPECT_TRUE(holds(flipped.err, "flipped.ctpm")) << flipped.err;
  const auto missing = compare("no.ctpm", "neither.ctpm");
  EXPECT_EQ(missing.code, 2);
  EXPECT_TRUE(holds(missing.err, "no.ctpm") && holds(missing.err, "neither.ctpm")) << missing.err;
  const auto limit = compare(cut_, clumsy_cut_, {"--force-limit", "-1"});
  EXPECT_EQ(limit.code, 2);
  EXPECT_TRUE(holds(limit.err, "--force-limit")) << limit.err;
}

}  // namespace
}  // namespace ctpm
