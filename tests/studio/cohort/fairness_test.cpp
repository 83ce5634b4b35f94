// What would make `ctpm cohort` unjust and nobody would notice: it is told, or left out by name.

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <string>
#include <tuple>

#include "tests/studio/cohort/cohort_program.h"

namespace ctpm {
namespace {

class FairCohort : public CohortProgram {
 protected:
  static void copy(const std::string& from, const std::string& to) {
    fs::create_directories(fs::path(path(to)).parent_path());
    fs::copy_file(path(from), path(to), fs::copy_options::overwrite_existing);
  }
  /// block.json with a box below the block's top that no tool should enter; `top` is where it ends [mm].
  static std::string with_zone(double top) {
    std::string text = scene("ball");
    text.insert(text.rfind('}'),
                R"(, "forbidden": [{"name": "vessel", "box": {"min_mm": [-9, -9, -60], "max_mm": [9, 9, )" +
                    std::to_string(top) + "]}}]");
    return text;
  }
};

/// As root, in a process that drops root, because root may read everything.
TEST_F(FairCohort, AFolderThatCannotBeReadIsToldAndHidesNoOther) {
  for (const char* person : {"a", "b", "c"}) copy("trainees/Ana/2.ctpm", std::string("some/") + person + "/1.ctpm");
  copy("trainees/Ben/1.ctpm", "some/b/1.ctpm"), copy("trainees/Ben/2.ctpm", "some/c/1.ctpm");
  fs::create_directories(path("theirs"));
  fs::permissions(path(""), fs::perms::others_read | fs::perms::others_exec, fs::perm_options::add);
  fs::permissions(path("theirs"), fs::perms::all);
  fs::permissions(path("some/b"), fs::perms::none);
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr unsigned kNobody = 65534;
    if (::geteuid() == 0 && (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0))
      ::_exit(254);
    try {
      const ProgramOutcome done = run_ctpm(
          {"cohort", path("course.json"), "--trainees", path("some"), "-o", "out", "--no-pictures"}, path("theirs"));
      write("theirs/said", done.err + done.out);
      ::_exit(done.code);
    } catch (const std::exception&) {
      ::_exit(253);
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  fs::permissions(path("some/b"), fs::perms::owner_all);
  const std::string said = slurp(path("theirs/said"));
  EXPECT_EQ(WEXITSTATUS(status), 1) << said;
  EXPECT_TRUE(holds(said, "/some/b: error: cannot be read: Permission denied")) << said;
  EXPECT_TRUE(holds(said, "press: 3 experts, 2 attempts")) << said;
}

TEST_F(FairCohort, AMarkThatItsExpertsMissIsToldBeforeAnybodyFailsIt) {
  write("hard.json", course(R"({"measure": "peak_force_n", "pass_at_most": 0.001}, {"measure": "cut_depth_mm",
                               "pass_at_least": 1}, {"measure": "completion_time_s", "pass_at_most": 100})"));
  const ProgramOutcome checked = ctpm({"check", "hard.json"});
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_TRUE(holds(checked.err, "3 of its 3 experts miss the pass mark of peak_force_n, with ")) << checked.err;
  EXPECT_TRUE(
      holds(checked.err, "3 of its 3 experts miss the pass mark of cut_depth_mm: it has no value in their sessions"))
      << checked.err;
  EXPECT_FALSE(holds(checked.err, "completion_time_s")) << checked.err;
  const ProgramOutcome done = ctpm({"cohort", "hard.json", "--trainees", "trainees", "-o", "hard", "--no-pictures"});
  EXPECT_TRUE(holds(done.err, "3 of its 3 experts miss the pass mark of peak_force_n")) << done.err;
}

TEST_F(FairCohort, ACopyUnderAnotherNameIsTold) {
  copy("trainees/Ana/3.ctpm", "pair/ana.ctpm");
  ASSERT_EQ(ctpm({"anonymise", "trainees/Ana/3.ctpm", "--trainee", "Somebody Else", "-o", "pair/other.ctpm"}).code, 0);
  const ProgramOutcome done = ctpm({"cohort", "course.json", "--trainees", "pair", "-o", "pair-out", "--no-pictures"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(holds(done.err, "has the same motion and forces as pair/")) << done.err;
}

TEST_F(FairCohort, OneTaskIsChosenByTheLongestNameAndOneFolderOfExpertsIsOfOneTask) {
  for (const char* name : {"e1", "e2"})
    copy(std::string("experts/") + name + ".ctpm", std::string("first/") + name + ".ctpm");
  for (const char* name : {"1", "2"})
    copy(std::string("trainees/Ben/") + name + ".ctpm", std::string("second/") + name + ".ctpm");
  const auto two = [](const std::string& experts) {
    return R"({"format": "ctpm-course", "version": 1, "name": "c", "tasks": [
      {"name": "press", "scene": "block.json", "experts": "first"},
      {"name": "press-deep", "scene": "block.json", "experts": ")" +
           experts + R"("}]})";
  };
  write("two.json", two("second"));
  copy("trainees/Ana/2.ctpm", "named/Ana/press-deep/1.ctpm");
  const ProgramOutcome done = ctpm({"cohort", "two.json", "--trainees", "named", "-o", "two-out", "--no-pictures"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(holds(done.out + done.err, "press-deep: 2 experts, 1 attempt\n")) << done.out << done.err;
  write("same.json", two("first"));
  const ProgramOutcome refused = ctpm({"check", "same.json"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "first/e1.ctpm: error: is in the experts' folder of two tasks, also of 'press-deep'"))
      << refused.err;
}

TEST_F(FairCohort, TheSurfaceOfABallCountsInAZoneAndSessionsWithOtherZonesAreLeftOut) {
  write("zone.json", with_zone(10));
  write("other-zone.json", with_zone(12));
  write("no-zone.json", scene("ball"));
  for (const auto& [scene, name, depth] : {std::tuple{"zone.json", "zone-experts/1", 11.0},
                                           {"zone.json", "zone-experts/2", 11.5},
                                           {"zone.json", "zone-trainees/deep", 28.5},
                                           {"zone.json", "zone-trainees/high", 4.0},
                                           {"other-zone.json", "zone-trainees/other", 16.0},
                                           {"no-zone.json", "zone-trainees/none", 16.0}})
    record(scene, "ball", name, depth);
  const ProgramOutcome done =
      ctpm({"cohort", "--experts", "zone-experts", "--trainees", "zone-trainees", "-o", "zone-out", "--no-pictures"});
  EXPECT_EQ(done.code, 0) << done.err;
  for (const char* name : {"other", "none"})
    EXPECT_TRUE(holds(done.err, std::string("left out: zone-trainees/") + name +
                                    ".ctpm was recorded with other forbidden zones than the experts' sessions"))
        << done.err;
  // From 45 mm down by 28.5 mm the centre of the ball of 8 mm never is in the box below 10 mm.
  EXPECT_GT(std::stod(value_in("zone-out", "deep", 1, "time_in_forbidden_zones_s")), 0.02);
  EXPECT_EQ(std::stod(value_in("zone-out", "high", 1, "time_in_forbidden_zones_s")), 0);
  EXPECT_TRUE(holds(slurp(path("zone-out/trainee-deep.html")), "It was in forbidden zones: vessel for "));
  EXPECT_FALSE(holds(slurp(path("zone-out/trainee-high.html")), "It was in forbidden zones"));
  EXPECT_TRUE(holds(slurp(path("zone-out/trainee-high.html")), "high.ctpm")) << "which session an attempt is";
}

}  // namespace
}  // namespace ctpm
