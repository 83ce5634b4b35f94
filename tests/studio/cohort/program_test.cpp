// `ctpm cohort` from outside: presses on a small block, some of them too hard.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "recordings/internal/database.h"
#include "recordings/pseudonym.h"
#include "tests/studio/cohort/cohort_program.h"

namespace ctpm {
namespace {

TEST_F(CohortProgram, TraineesAreMeasuredBesideABandOfExperts) {
  const ProgramOutcome done = ctpm({"cohort", "course.json", "--trainees", "trainees", "-o", "out"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(holds(done.out, "press: 3 experts, 5 attempts")) << done.out;
  EXPECT_TRUE(holds(done.out, "attempt 3, passed")) << done.out;
  EXPECT_TRUE(holds(done.out, "attempt 2, not passed, fails too often")) << done.out;
  EXPECT_TRUE(holds(done.out, "not validated")) << done.out;
  EXPECT_TRUE(holds(done.err, "other.ctpm is of no task")) << done.err;

  // What a session measures by itself is what it says itself, and what `compare` says of it.
  EXPECT_NEAR(std::stod(value_in("out", "Ana", 1, "peak_force_n")), peak("trainees/Ana/1.ctpm"), 1e-12);
  const auto compared =
      nlohmann::json::parse(ctpm({"compare", "experts/e1.ctpm", "trainees/Ana/1.ctpm", "--json"}).out);
  for (const auto& measure : compared["measures"]) {
    const std::string key = measure["key"];
    // A cohort has no force limit of one expert's peak; measures of a pair are means over the experts.
    if (!measure.contains("expert") || !measure.contains("trainee") || holds(key, "force_limit")) continue;
    EXPECT_NEAR(std::stod(value_in("out", "Ana", 1, key)), measure["trainee"], 1e-9) << key;
  }
  double deviation = 0;
  for (const std::string expert : {"e1", "e2", "e3"}) {
    const auto pair =
        nlohmann::json::parse(ctpm({"compare", "experts/" + expert + ".ctpm", "trainees/Ben/1.ctpm", "--json"}).out);
    for (const auto& measure : pair["measures"])
      if (measure["key"] == "aligned_deviation_mean_mm") deviation += double(measure["trainee"]) / 3;
  }
  EXPECT_NEAR(std::stod(value_in("out", "Ben", 1, "aligned_deviation_mean_mm")), deviation, 1e-9);
  EXPECT_EQ(value_in("out", "Ana", 1, "cut_overlap"), "") << "nobody cut: no number stands for it";

  const std::string ana = slurp(path("out/trainee-Ana.html")), ben = slurp(path("out/trainee-Ben.html")),
                    all = slurp(path("out/index.html"));
  EXPECT_TRUE(holds(ana, "press, attempt 3: passed."));
  EXPECT_TRUE(holds(ben, "press, attempt 2: not passed. Missed: peak force ("));
  EXPECT_TRUE(holds(ben, "% of the way the force is above the experts&#39; band") ||
              holds(ben, "% of the way the force is above the experts' band"));
  EXPECT_FALSE(holds(ana, "the force is above the experts"));
  // Events of the plots lead to pictures of the trainee and an expert.
  EXPECT_TRUE(holds(ben, "href=\"#task-1-moment-1\"") && holds(ben, "<figure id=\"task-1-moment-1\"><img"));
  EXPECT_TRUE(holds(ben, "The middle expert at the same place"));
  EXPECT_TRUE(holds(all, "href=\"trainee-Ben.html\""));
  EXPECT_TRUE(holds(all,
                    "press: 1 of 2 trainees has learned it, 1 passed in the latest attempt. "
                    "Missed most often: peak force (1 of 2)."));
  EXPECT_TRUE(holds(all, "1 session belongs to no task and is left out."));
  for (const std::string& page : {ana, ben, all}) EXPECT_TRUE(holds(page, "Not validated"));
}

TEST_F(CohortProgram, TheSameSessionsGiveTheSameFilesAndVerifyingChangesNoNumber) {
  ASSERT_EQ(ctpm({"cohort", "course.json", "--trainees", "trainees", "-o", "one"}).code, 0);
  ASSERT_EQ(ctpm({"cohort", "course.json", "--trainees", "trainees", "-o", "two"}).code, 0);
  for (const char* file : {"index.html", "trainee-Ana.html", "results.csv", "statements.jsonl"})
    EXPECT_EQ(slurp(path(std::string("one/") + file)), slurp(path(std::string("two/") + file))) << file;
  ASSERT_EQ(ctpm({"cohort", "course.json", "--trainees", "trainees", "-o", "verified", "--verify"}).code, 0);
  EXPECT_EQ(slurp(path("one/results.csv")), slurp(path("verified/results.csv")));
  EXPECT_TRUE(holds(slurp(path("one/index.html")), "they were not verified"));
  EXPECT_TRUE(holds(slurp(path("verified/index.html")), "Every session was replayed as it was recorded"));
}

TEST_F(CohortProgram, AFolderIsWrittenAnewAndNoOtherFilesInIt) {
  const std::vector<std::string> command{"cohort", "course.json", "--trainees", "trainees", "--no-pictures", "-o"};
  const auto into = [&](const std::string& folder) {
    std::vector<std::string> whole = command;
    whole.push_back(folder);
    return ctpm(whole);
  };
  for (int time = 0; time < 2; ++time) {
    const ProgramOutcome done = into("again");
    EXPECT_EQ(done.code, 0) << "time " << time << ": " << done.err;
  }
  write("site/index.html", "<p>somebody's page</p>");
  write("table/results.csv", "somebody's table");
  for (const char* folder : {"site", "table"}) {
    const ProgramOutcome refused = into(folder);
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(holds(refused.err, "exists already, and no report of this program lies beside it")) << refused.err;
  }
  // Said before the work begins, with everything else that is wrong.
  for (const char* name : {"cohort", "calibrate", "compare"}) {
    std::vector<std::string> wrong{name, "none.json", "-o", "course.json/out"};
    if (wrong[0] == "cohort") wrong.insert(wrong.end(), {"--trainees", "trainees"});
    if (wrong[0] == "compare") wrong.insert(wrong.end(), {"nor.ctpm", "--force-limit", "-1"});
    const ProgramOutcome refused = ctpm(wrong);
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(holds(refused.err, "none.json: error:") && holds(refused.err, "course.json/out: error: cannot be made"))
        << refused.err;
    EXPECT_EQ(holds(refused.err, "--force-limit: error:"), wrong[0] == "compare") << refused.err;
  }
}

TEST_F(CohortProgram, ThePageOfATraineeWhoLeftGoesAndNoOtherFile) {
  const auto into = [&](const char* trainees) {
    EXPECT_EQ(ctpm({"cohort", "course.json", "--trainees", trainees, "--no-pictures", "-o", "left"}).code, 0);
  };
  for (const char* one : {"Ana", "Ben"})
    fs::create_directories(path("class")),
        fs::copy(path(std::string("trainees/") + one), path(std::string("class/") + one), fs::copy_options::recursive);
  into("class");
  write("left/trainee-notes.html", "<p>somebody's notes</p>"), write("left/trainee-Ben.txt", "somebody's text");
  fs::copy_file(path("left/trainee-Ben.html"), path("left/kept-Ben.html"));
  fs::remove_all(path("class/Ben"));
  into("class");
  EXPECT_FALSE(fs::exists(path("left/trainee-Ben.html")));
  for (const char* name : {"trainee-Ana.html", "trainee-notes.html", "trainee-Ben.txt", "kept-Ben.html", "index.html"})
    EXPECT_TRUE(fs::exists(path(std::string("left/") + name))) << name;
}

TEST_F(CohortProgram, TablesAndStatementsHoldEverySession) {
  ASSERT_EQ(ctpm({"cohort", "course.json", "--trainees", "trainees", "-o", "tables"}).code, 0);
  const auto rows = rows_of("tables");
  ASSERT_EQ((rows.size() - 1) % 8, 0u) << "eight sessions, each with every measure";
  namespace session_file = recordings::session_file;
  auto database = session_file::Database::open(path("tables/results.sqlite"), session_file::Database::Access::read);
  ASSERT_TRUE(database);
  auto count = database->prepare("SELECT count(*), count(value), sum(role = 'expert') FROM result");
  ASSERT_TRUE(count && count->step() == session_file::Statement::Outcome::row);
  EXPECT_EQ(count->integer(0), std::int64_t(rows.size() - 1));
  EXPECT_EQ(count->integer(2) * 8, count->integer(0) * 3);
  EXPECT_GT(count->integer(1), 0);

  std::istringstream lines(slurp(path("tables/statements.jsonl")));
  std::vector<nlohmann::json> statements;
  for (std::string line; std::getline(lines, line);) statements.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(statements.size(), 5u);
  EXPECT_EQ(statements[0]["actor"]["account"]["name"], "Ana");
  EXPECT_FALSE(statements[0]["actor"].contains("mbox"));
  EXPECT_EQ(statements[0]["verb"]["id"], "http://adlnet.gov/expapi/verbs/failed");
  EXPECT_EQ(statements[2]["result"]["success"], true);
  EXPECT_TRUE(statements[0].contains("timestamp"));
  if (!recordings::name_uuid("x").empty()) {
    EXPECT_NE(statements[0]["id"], statements[1]["id"]);
  }
}

TEST_F(CohortProgram, ANameGivesItsUuid) {
  if (recordings::name_uuid("x").empty()) GTEST_SKIP() << "built without CTPM_SIGNING";
  // As Python's uuid.uuid5(uuid.NAMESPACE_URL, ...) prints it.
  EXPECT_EQ(recordings::name_uuid("https://ctpm.invalid/a"), "c8e87fa2-0dd0-5022-8075-dc9cbd8d7754");
}

TEST_F(CohortProgram, FoldersWithoutACourseHaveNoMarks) {
  const ProgramOutcome done = ctpm({"cohort", "--experts", "experts", "--trainees", "trainees", "-o", "folders"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_FALSE(holds(done.out, "passed")) << done.out;
  EXPECT_TRUE(holds(slurp(path("folders/index.html")), "it has no pass marks"));
  EXPECT_TRUE(holds(slurp(path("folders/statements.jsonl")), "verbs/completed"));
}

TEST_F(CohortProgram, TwoExpertsAndOneAttemptAreNotSaidToSpread) {
  fs::create_directories(path("two"));
  fs::create_directories(path("lone/Ben"));
  for (const char* name : {"e1", "e3"})
    fs::copy_file(path(std::string("experts/") + name + ".ctpm"), path(std::string("two/") + name + ".ctpm"));
  fs::copy_file(path("trainees/Ben/1.ctpm"), path("lone/Ben/1.ctpm"));
  const ProgramOutcome done =
      ctpm({"cohort", "--experts", "two", "--trainees", "lone", "-o", "of-two", "--no-pictures"});
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string page = slurp(path("of-two/trainee-Ben.html")), all = slurp(path("of-two/index.html"));
  EXPECT_TRUE(holds(page, "farther from the experts&#39; way") || holds(page, "farther from the experts' way"));
  EXPECT_TRUE(holds(page, "mm, two experts have no spread of it."));
  for (const std::string& text : {page, all}) {
    for (const char* rounding : {"e-14", "e-15", "e-16", "e-17"})
      EXPECT_FALSE(holds(text, rounding)) << text.substr(text.find(rounding) - 200, 220);
    EXPECT_FALSE(holds(text, "insufficient data") || holds(text, "nobody else"));
    EXPECT_FALSE(holds(text, "<img"));
  }
  const std::string head = ">95 % interval</th>";
  const auto interval = all.find(head);
  ASSERT_NE(interval, std::string::npos);
  EXPECT_EQ(all.find(head, interval + 1), std::string::npos) << "one attempt has no interval";
}

TEST_F(CohortProgram, AShallowerPressHasNoBetterForces) {
  record("block.json", "ball", "shallow/Cy/1", 8);
  const ProgramOutcome done = ctpm({"cohort", "--experts", "experts", "--trainees", "shallow", "-o", "shallow-out"});
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string page = slurp(path("shallow-out/trainee-Cy.html"));
  const auto row = page.find("peak force<");
  ASSERT_NE(row, std::string::npos);
  EXPECT_TRUE(holds(page.substr(row, page.find("</tr>", row) - row), "less done")) << page.substr(row, 600);
  EXPECT_TRUE(holds(page, "the attempt reached less than the experts (largest depth "));
}

TEST_F(CohortProgram, AnonymisedSessionsAreOrderedByTheirElapsedTimes) {
  if (recordings::name_uuid("x").empty()) GTEST_SKIP() << "built without CTPM_SIGNING";
  const auto anonymise = [&](std::vector<std::string> sessions, const std::string& who, const std::string& out) {
    sessions.insert(sessions.begin(), "anonymise");
    sessions.insert(sessions.end(), {"--key", "key", "--trainee", who, "-o", out});
    const ProgramOutcome done = ctpm(sessions);
    ASSERT_EQ(done.code, 0) << done.err;
  };
  anonymise({"trainees/Ana/3.ctpm", "trainees/Ana/1.ctpm", "trainees/Ana/2.ctpm"}, "Ana", "hidden/");
  int number = 0;
  for (const std::string expert : {"e1", "e2", "e3"})
    anonymise({"experts/" + expert + ".ctpm"}, "Expert " + std::to_string(++number), "hidden-experts/");
  const ProgramOutcome done = ctpm({"cohort", "--experts", "hidden-experts", "--trainees", "hidden", "-o", "hid"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_FALSE(holds(done.out, "Ana"));
  const std::string statements = slurp(path("hid/statements.jsonl"));
  EXPECT_FALSE(holds(statements, "timestamp") || holds(statements, "Ana"));
  const std::string first = statements.substr(0, statements.find('\n'));
  const double force =
      nlohmann::json::parse(first)["result"]["extensions"]["https://ctpm.invalid/measures/peak_force_n"];
  EXPECT_NEAR(force, peak("trainees/Ana/1.ctpm"), 1e-12) << "the earliest attempt is the first";
}

TEST_F(CohortProgram, AnonymisedSessionsAreOfTheirSceneWhateverItsNames) {
  if (recordings::name_uuid("x").empty()) GTEST_SKIP() << "built without CTPM_SIGNING";
  // Zones of which one is passed through; the names of organ and tool become pseudonyms.
  std::string named = scene("pusher");
  named.replace(named.find("\"name\": \"block\",\n      \"rig\""), 15, "\"name\": \"lump\"");
  named.insert(named.rfind('}'),
               R"(, "forbidden": [{"name": "vessel", "sphere": {"centre_mm": [0, 0, 36], "radius_mm": 4}}])");
  write("named.json", named);
  for (const char* name : {"named-experts/a", "named-experts/b", "named/Dan/1"})
    record("named.json", "pusher", name, 12);
  const ProgramOutcome hidden = ctpm({"anonymise", "named/Dan/1.ctpm", "--trainee", "Dan", "-o", "named-hidden/"});
  ASSERT_EQ(hidden.code, 0) << hidden.err;
  const ProgramOutcome done =
      ctpm({"cohort", "--experts", "named-experts", "--trainees", "named-hidden", "-o", "named-out", "--no-pictures"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(holds(done.out, "named-experts: 2 experts, 1 attempt")) << done.out << done.err;
  std::string page;
  for (const auto& file : fs::directory_iterator(path("named-out")))
    if (file.path().filename().string().starts_with("trainee-")) page = slurp(file.path());
  const auto zone = page.find("forbidden: zone-");
  ASSERT_NE(zone, std::string::npos) << page;
  EXPECT_FALSE(holds(page.substr(zone, page.find("</tr>", zone) - zone), "insufficient data"));
  const std::string session = fs::directory_iterator(path("named-hidden"))->path().string();
  const ProgramOutcome compared = ctpm({"compare", "named-experts/a.ctpm", session});
  EXPECT_EQ(compared.code, 0) << compared.err;
  // Of sessions that are not anonymised, names tell scenes apart.
  EXPECT_EQ(ctpm({"compare", "named-experts/a.ctpm", "experts/e1.ctpm"}).code, 2);
}

TEST_F(CohortProgram, ACourseIsCheckedWithItsScenesAndItsExpertsSessions) {
  EXPECT_EQ(ctpm({"check", "course.json"}).out, "course.json: good, 1 task; not validated\n");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = slurp(path("course.json"));
    return text.replace(text.find(from), from.size(), to);
  };
  // The scene was changed after the experts had recorded: trainees who record now belong to no task.
  write("moved.json", changed("block.json", "other.json"));
  const std::string warning =
      "other.json: warning: is not the scene in which the experts of the task 'press' worked: its tools are pusher "
      "instead of ball, in ";
  const ProgramOutcome checked = ctpm({"check", "moved.json"});
  EXPECT_EQ(checked.code, 0);
  EXPECT_EQ(checked.out, "moved.json: good, 1 task; not validated, 1 warning\n");
  EXPECT_TRUE(holds(checked.err, warning)) << checked.err;
  const ProgramOutcome measured = ctpm({"cohort", "moved.json", "--trainees", "trainees", "-o", "m", "--no-pictures"});
  EXPECT_EQ(measured.code, 0);
  EXPECT_TRUE(holds(measured.err, warning)) << measured.err;
  // Where every session is of a task, no scene is read for it.
  const ProgramOutcome all = ctpm({"cohort", "moved.json", "--trainees", "trainees/Ana", "-o", "m", "--no-pictures"});
  EXPECT_EQ(all.code, 0);
  EXPECT_FALSE(holds(all.err, "other.json")) << all.err;

  write("broken.json", "{}");
  write("spoilt/a.ctpm", "no session");
  write("broken-course.json", changed("block.json", "broken.json"));
  std::string text = slurp(path("broken-course.json"));
  write("broken-course.json", text.replace(text.find("\"experts\": \"experts\""), 20, "\"experts\": \"spoilt\""));
  const ProgramOutcome refused = ctpm({"check", "broken-course.json"});
  EXPECT_EQ(refused.code, 2);
  for (const char* part :
       {"spoilt/a.ctpm: error: is not a session file", "spoilt: error: holds no session", "broken.json:1:1: error:"})
    EXPECT_TRUE(holds(refused.err, part)) << part << " is not in: " << refused.err;
}

TEST_F(CohortProgram, ADamagedSessionIsToldAndTheOthersAreMeasured) {
  const auto half_of = [](const std::string& session) {
    const std::string whole = slurp(path(session));
    return whole.substr(0, whole.size() / 2);
  };
  fs::create_directories(path("some/Ana"));
  for (const char* name : {"1", "3"})
    fs::copy_file(path(std::string("trainees/Ana/") + name + ".ctpm"), path(std::string("some/Ana/") + name + ".ctpm"));
  write("some/Ana/2.ctpm", half_of("trainees/Ana/2.ctpm"));
  write("some/Ben/1.ctpm", "no session");
  // Opened without a fault, but damaged among its ticks.
  std::string flipped = slurp(path("trainees/Ben/2.ctpm"));
  for (std::size_t at = flipped.size() / 3; at < flipped.size() / 2; at += 64) flipped[at] = char(flipped[at] ^ 1);
  write("some/Ben/2.ctpm", flipped);
  const ProgramOutcome done = ctpm({"cohort", "course.json", "--trainees", "some", "-o", "some-out", "--no-pictures"});
  EXPECT_EQ(done.code, 1) << done.err;
  EXPECT_TRUE(holds(done.out, "press: 3 experts, 2 attempts")) << done.out;
  const std::string page = slurp(path("some-out/index.html"));
  EXPECT_TRUE(holds(page, "3 sessions cannot be read and are left out.")) << done.err;
  for (const char* file : {"some/Ana/2.ctpm", "some/Ben/1.ctpm", "some/Ben/2.ctpm"}) {
    EXPECT_TRUE(holds(done.err, std::string("left out: ") + file)) << done.err;
    EXPECT_TRUE(holds(page, file)) << file;
  }
  fs::remove(path("some/Ana/1.ctpm")), fs::remove(path("some/Ana/3.ctpm"));
  const ProgramOutcome none = ctpm({"cohort", "course.json", "--trainees", "some", "-o", "none-out"});
  EXPECT_EQ(none.code, 2) << none.err;
  EXPECT_TRUE(holds(none.err, "some/Ben/1.ctpm: error: ")) << none.err;
  EXPECT_FALSE(fs::exists(path("none-out/index.html")));
}

TEST_F(CohortProgram, ALegendNamesTwoPassMarksOnce) {
  write("both.json", course(R"({"measure": "peak_force_n", "pass_at_least": 0.001, "pass_at_most": LIMIT})"));
  ASSERT_EQ(ctpm({"cohort", "both.json", "--trainees", "trainees", "-o", "both", "--no-pictures"}).code, 0);
  const std::string page = slurp(path("both/trainee-Ana.html"));
  const auto legend = page.find(">pass mark</text>");
  ASSERT_NE(legend, std::string::npos);
  EXPECT_EQ(page.find(">pass mark</text>", legend + 1), std::string::npos);
}

TEST_F(CohortProgram, ForceIsCountedForTheOrganThatIsTouchedAndForTheZoneThatTheSceneForbids) {
  // Two livers beside each other; the tool presses the second one, and its tip ends in a zone.
  const std::string organs = R"({"name": "left", "mesh": "liver.obj", "material": {"preset": "liver"},
      "fill": {"radius_mm": 12, "gap_mm": 12}, "anchors": [{"lowest_mm": 20}]},
      {"name": "right", "mesh": "liver.obj", "at_mm": [400, 0, 0], "material": {"preset": "liver"},
      "fill": {"radius_mm": 12, "gap_mm": 12}, "anchors": [{"lowest_mm": 20}]})";
  fs::copy_file(std::string(CTPM_SOURCE_DIR) + "/scenes/organs/liver.obj", path("liver.obj"));
  write("two.json", R"({"format": "ctpm-scene", "version": 1, "name": "two", "settle_s": 0, "organs": [)" + organs +
                        R"(], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 10}],
      "forbidden": [{"name": "vessel", "box": {"min_mm": [300, -200, -200], "max_mm": [500, 200, 96]}},
                    {"name": "nerve", "sphere": {"centre_mm": [0, 0, 500], "radius_mm": 5}}]})");
  write("two.script.json", R"({"format": "ctpm-script", "version": 1, "steps": [
      {"take": {"tool": "ball", "at_mm": [357, 31, 130]}}, {"press": {"distance_mm": 40, "speed_mm_per_s": 100}},
      {"release": {"distance_mm": 30, "speed_mm_per_s": 100}}, {"put_away": true}]})");
  for (const std::string name : {"two-experts/a", "two-experts/b", "two-trainees/c"}) {
    fs::create_directories(fs::path(path(name)).parent_path());
    const ProgramOutcome recorded =
        ctpm({"record", "two.json", "--script", "two.script.json", "-o", name + ".ctpm", "--fast"});
    ASSERT_EQ(recorded.code, 0) << recorded.err;
  }
  const std::vector<std::string> command{"cohort", "--experts", "two-experts", "--trainees", "two-trainees", "-o"};
  auto believed = command, verified = command;
  believed.push_back("two-believed"), verified.insert(verified.end(), {"two-verified", "--verify"});
  ASSERT_EQ(ctpm(believed).code, 0);
  const ProgramOutcome done = ctpm(verified);
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_FALSE(holds(slurp(path("two-believed/results.csv")), "organ right")) << "not replayed: nobody knows";
  const auto of = [&](const std::string& structure, const std::string& measure) {
    for (const auto& row : rows_of("two-verified"))
      if (row.size() > 14 && row[3] == "c" && row[9] == measure && row[14] == structure) return std::stod(row[11]);
    return -1.0;
  };
  const double whole = std::stod(value_in("two-verified", "c", 1, "peak_force_n"));
  EXPECT_GT(whole, 0.1);
  EXPECT_EQ(of("organ right", "peak_force_n"), whole);
  EXPECT_EQ(of("organ left", "peak_force_n"), 0);
  EXPECT_EQ(of("organ right", "impulse_n_s"), std::stod(value_in("two-verified", "c", 1, "impulse_n_s")));
  EXPECT_GT(of("zone vessel", "impulse_n_s"), 0);
  EXPECT_EQ(of("zone nerve", "impulse_n_s"), 0);
  EXPECT_GT(std::stod(value_in("two-verified", "c", 1, "time_in_forbidden_zones_s")), 0.1);
  EXPECT_TRUE(holds(slurp(path("two-verified/trainee-c.html")), "forbidden: vessel"));
}

TEST_F(CohortProgram, WhatCannotBeMeasuredIsRefusedWithEveryReason) {
  fs::create_directories(path("one-expert"));
  fs::copy_file(path("experts/e1.ctpm"), path("one-expert/e1.ctpm"));
  ProgramOutcome refused = ctpm({"cohort", "--experts", "one-expert", "--trainees", "trainees", "-o", "refused"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "one expert's session, which cannot tell how much experts differ")) << refused.err;
  fs::create_directories(path("twice"));
  for (const char* name : {"e1", "e2"})
    fs::copy_file(path(std::string("experts/") + name + ".ctpm"), path(std::string("twice/") + name + ".ctpm"));
  fs::copy_file(path("experts/e1.ctpm"), path("twice/again.ctpm"));
  write("twice/broken.ctpm", "no session");
  refused = ctpm({"cohort", "--experts", "twice", "--trainees", "trainees", "-o", "refused"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "is the same session as") && holds(refused.err, "broken.ctpm")) << refused.err;
  fs::create_directories(path("empty"));
  refused = ctpm({"cohort", "--experts", "nowhere", "--trainees", "empty", "-o", "course.json/out"});
  EXPECT_EQ(refused.code, 2);
  for (const char* part :
       {"nowhere: error: does not exist", "empty: error: holds no session", "course.json/out: error: cannot be made"})
    EXPECT_TRUE(holds(refused.err, part)) << refused.err;
  write("bad.json", course(R"({"measure": "peak_forse_n"}, {"measure": "completion_time_s", "low": 2, "high": 1})"));
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"cohort", "bad.json", "--trainees", "trainees", "-o", "refused"},
        {"check", "bad.json"}}) {
    refused = ctpm(command);
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(holds(refused.err, "bad.json:2:") && holds(refused.err, "did you mean \"peak_force_n\"?") &&
                holds(refused.err, "must be above low"))
        << refused.err;
  }
  EXPECT_FALSE(fs::exists(path("refused")));
  EXPECT_EQ(ctpm({"check", "course.json"}).code, 0);
}

}  // namespace
}  // namespace ctpm
