// What a session file promises, from outside: verify, replay, recover, sizes.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <thread>

#include "tests/recordings/legacy_files.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;
using testing::TemporaryFolder;

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes";
const std::string kShipped = CTPM_SHIPPED_SESSIONS;
const std::string kPress = kShipped + "/liver-press-expert.ctpm";
const std::string kCut = kShipped + "/kidney-cut-expert.ctpm";

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<fs::path> shipped_sessions() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(kShipped)) paths.push_back(entry.path());
  return paths;
}

TEST(ShippedSessions, EachIsTheSameToTheBitWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  EXPECT_GE(shipped_sessions().size(), 4u);
  for (const fs::path& path : shipped_sessions()) {
    const ProgramOutcome verified = run_ctpm({"verify", path.string(), "--threads", "2"}, folder.path());
    EXPECT_EQ(verified.code, 0) << verified.out << verified.err
                                << "after a change of the physics: ninja shipped_sessions";
    std::printf("%s", verified.out.c_str());
    EXPECT_TRUE(holds(verified.out, ": same: ")) << verified.out;
    EXPECT_TRUE(holds(verified.out, "times as fast as it was lived")) << verified.out;
    EXPECT_LT(fs::file_size(path), 4u << 20) << path;
  }
}

TEST(SessionProgram, AnOrganThatLiesOnATableReplaysToTheBit) {
  const TemporaryFolder folder;
  const ProgramOutcome recorded =
      run_ctpm({"record", kScenes + "/kidney-on-table.json", "--script", kScenes + "/scripts/kidney-on-table-push.json",
                "-o", "push.ctpm", "--fast", "--duration-s", "1.5"},
               folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const ProgramOutcome verified = run_ctpm({"verify", "push.ctpm", "--threads", "2"}, folder.path());
  EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
  EXPECT_TRUE(holds(verified.out, ": same: ")) << verified.out;
  const ProgramOutcome planned = run_ctpm({"plan", kScenes + "/kidney-on-table.json"}, folder.path());
  EXPECT_TRUE(holds(planned.out, "contact with obstacles")) << planned.out;
}

TEST(SessionProgram, TwoHandsReplayToTheBitAndBothAreToldOf) {
  const TemporaryFolder folder;
  const ProgramOutcome recorded =
      run_ctpm({"record", kScenes + "/two-hands.json", "--script", kScenes + "/scripts/two-hands-cut.json", "-o",
                "two.ctpm", "--fast", "--duration-s", "5"},
               folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const ProgramOutcome verified = run_ctpm({"verify", "two.ctpm", "--threads", "2"}, folder.path());
  EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
  const std::string info = run_ctpm({"info", "two.ctpm"}, folder.path()).out;
  for (const std::string event : {"holder touches the tissue", "second hand: press reached its force",
                                  "scalpel touches the tissue", "scalpel begins to sever"})
    EXPECT_TRUE(holds(info, event)) << event << "\n" << info;
  ASSERT_EQ(run_ctpm({"replay", "two.ctpm", "--from-s", "4", "--csv", "two.csv"}, folder.path()).code, 0);
  std::istringstream rows(slurp(folder.path() / "two.csv"));
  std::string header, row;
  std::getline(rows, header);
  EXPECT_TRUE(header.ends_with(",second_force_n,second_depth_mm,second_contacts")) << header;
  bool both = false;
  while (std::getline(rows, row))
    both = both || (holds(row, ",scalpel,") && holds(row, ",holder,") && !row.ends_with(",0"));
  EXPECT_TRUE(both) << "one hand cuts while the other holds";
  // What a scene with one hand says to it.
  const ProgramOutcome refused = run_ctpm(
      {"record", kScenes + "/liver.json", "--script", kScenes + "/scripts/two-hands-cut.json", "-o", "one.ctpm"},
      folder.path());
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "two-hands-cut.json:5:") && holds(refused.err, "the scene has one hand"))
      << refused.err;
  EXPECT_FALSE(fs::exists(folder.path() / "one.ctpm"));
}

TEST(ShippedSessions, EachScriptOfAnExpertHasAClumsyCounterpart) {
  for (const fs::path& path : shipped_sessions()) {
    std::string name = path.filename().string();
    const auto at = name.find("-expert");
    if (at == std::string::npos) continue;
    EXPECT_TRUE(fs::exists(kShipped + "/" + name.replace(at, 7, "-clumsy"))) << name;
  }
}

TEST(ShippedSessions, AMinuteTakesLessThan10Megabytes) {
  const TemporaryFolder folder;
  std::map<std::string, double> start_mb;  // what a session of the scene takes before its first tick
  for (const fs::path& path : shipped_sessions()) {
    const std::string name = path.stem().string(), scene = name.substr(0, name.find('-'));
    if (!start_mb.contains(scene)) {
      const auto recorded = run_ctpm({"record", kScenes + "/" + scene + ".json", "-o", scene + ".ctpm", "--fast",
                                      "--script", kScenes + "/scripts/" + name + ".json", "--duration-s", "0.001"},
                                     folder.path());
      ASSERT_EQ(recorded.code, 0) << recorded.err;
      start_mb[scene] = double(fs::file_size(folder.path() / (scene + ".ctpm"))) / 1e6;
    }
    const std::string info = run_ctpm({"info", path.string(), "--json"}, folder.path()).out;
    const auto at = info.find("\"duration_s\": ");
    ASSERT_NE(at, std::string::npos);
    const double minutes = std::strtod(info.c_str() + at + 14, nullptr) / 60;
    const double rate = (double(fs::file_size(path)) / 1e6 - start_mb[scene]) / minutes;
    std::printf("%s: %.2f MB, of which %.2f MB before the first tick; %.2f MB a minute\n", name.c_str(),
                double(fs::file_size(path)) / 1e6, start_mb[scene], rate);
    EXPECT_LT(rate, 10) << name;
  }
}

/// Rows of a CSV by the names of its columns.
std::vector<std::map<std::string, std::string>> read_csv(const fs::path& path) {
  std::istringstream lines(slurp(path));
  std::string line, cell;
  const auto split = [&] {
    std::vector<std::string> cells;
    std::istringstream in(line);
    while (std::getline(in, cell, ',')) cells.push_back(cell);
    return cells;
  };
  std::getline(lines, line);
  const std::vector<std::string> names = split();
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = split();
    EXPECT_EQ(cells.size(), names.size()) << line;
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i) row[names[i]] = cells[i];
  }
  return rows;
}

TEST(ReplayCsv, HasTimeToolForceAndDepthOfEachTick) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_ctpm({"replay", kPress, "--from-s", "1", "--to-s", "2.5", "--csv", "a.csv"}, folder.path()).code, 0);
  const auto rows = read_csv(folder.path() / "a.csv");
  ASSERT_EQ(rows.size(), 1500u);
  double most_force = 0, most_depth = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto number = [&](const char* name) { return std::stod(rows[i].at(name)); };
    EXPECT_EQ(number("tick"), double(1000 + i));
    EXPECT_NEAR(number("time_s"), 1e-3 * double(1000 + i), 1e-9);
    EXPECT_EQ(rows[i].at("tool"), "ball");
    EXPECT_EQ(number("tool_x_mm"), -45);  // the script presses straight down there
    EXPECT_EQ(number("tool_y_mm"), 30);
    EXPECT_EQ(number("tool_qw"), 1);
    EXPECT_NEAR(number("force_n"), std::hypot(number("force_x_n"), number("force_y_n"), number("force_z_n")), 1e-6);
    EXPECT_EQ(number("force_n") > 0, number("contacts") > 0) << i;
    EXPECT_EQ(number("severed"), 0);
    EXPECT_EQ(number("same_as_recorded"), 1);
    most_force = std::max(most_force, number("force_n")), most_depth = std::max(most_depth, number("depth_mm"));
  }
  EXPECT_GT(most_force, 0.5);
  EXPECT_GT(most_depth, 5);
}

TEST(ReplayCsv, HasTheDepthOfAHeldBladeAlongIt) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_ctpm({"replay", kCut, "--csv", "a.csv"}, folder.path()).code, 0);
  double deepest = 0;
  for (auto& row : read_csv(folder.path() / "a.csv")) {
    const double depth = std::stod(row.at("blade_depth_mm")), tip = std::stod(row.at("tool_z_mm"));
    EXPECT_EQ(std::stod(row.at("depth_mm")), 0) << "of balls and pins";
    EXPECT_TRUE(depth == 0 || (row.at("tool") == "scalpel" && tip < 46)) << row.at("tick");
    deepest = std::max(deepest, depth);
  }
  EXPECT_NEAR(deepest, 22.6, 0.5) << "the tip goes to 22 mm, the top is at 44.6 mm";
}

/// A session that the physics `revision` made, with hashes of its own.
void record_with_other_physics(const std::string& path, std::int32_t revision = kPhysicsRevision) {
  recordings::SessionStart start = testing::small_start();
  start.physics_revision = revision;
  // No keyframe lies behind the ticks that differ: it would contradict their hashes.
  auto writer = recordings::SessionWriter::create(path, start, {.wait_when_full = true, .keyframe_ticks = 1000});
  testing::live(start, 300, [&](const State& after, const recordings::TickRecord& record) {
    recordings::TickRecord other = record;
    if (after.tick > 120) ++other.state_hash;
    writer->append(after, other);
  });
  CTPM_CHECK(bool(writer->finish()), "a test's session can be finished");
}

TEST(Texts, OfAFileCannotSteerTheTerminal) {
  const TemporaryFolder folder;
  recordings::SessionStart start = testing::small_start();
  start.build_fingerprint =
      "build \x1b]0;title\x07\nverdict: same\xc2\x9b"
      "1m \xe2\x80\xae";
  start.metadata["source"] = "a\x1b[2J";
  start.model.organs[0].name = "organ\xc2\x9b 1m \xe2\x80\xae";
  start.model.tools[0].name = std::string(900, 'x') + ",\"";
  auto writer = recordings::SessionWriter::create((folder.path() / "a.ctpm").string(), start, {.wait_when_full = true});
  writer->event({.kind = recordings::EventKind::note, .text = "note\x1b[31m\r"});
  testing::live(start, 20, [&](const State& after, const recordings::TickRecord& r) { writer->append(after, r); });
  CTPM_CHECK(bool(writer->finish({{"value\x1b", 1}})), "a test's session can be finished");
  const auto is_plain = [](const std::string& text) {
    return std::none_of(text.begin(), text.end(), [](char c) {
      return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || static_cast<unsigned char>(c) >= 0x7f;
    });
  };
  for (const std::vector<std::string>& command : {std::vector<std::string>{"info", "a.ctpm"},
                                                  {"info", "a.ctpm", "--json"},
                                                  {"verify", "a.ctpm"},
                                                  {"replay", "a.ctpm", "--csv", "a.csv"},
                                                  {"compare", "a.ctpm", "a.ctpm", "-o", "report"},
                                                  {"check", "no\x1b[31m.json"},
                                                  {"info", "no\x1b[31m.ctpm"}}) {
    const auto outcome = run_ctpm(command, folder.path());
    EXPECT_TRUE(is_plain(outcome.out) && is_plain(outcome.err)) << command[0] << ": " << outcome.out << outcome.err;
    EXPECT_FALSE(holds(outcome.out, "\nverdict: same")) << command[0];
  }
  // A table of 20 ticks, each in one row of the same length.
  std::istringstream rows(slurp(folder.path() / "a.csv"));
  std::string header, row;
  std::getline(rows, header);
  for (int tick = 0; tick < 20; ++tick) {
    std::getline(rows, row);
    EXPECT_TRUE(holds(row, ",\"" + std::string(900, 'x') + ",\"\"\",")) << row;
    EXPECT_EQ(std::ranges::count(row, ','), std::ranges::count(header, ',') + 1) << row;
  }
  EXPECT_FALSE(std::getline(rows, row)) << row;
  EXPECT_TRUE(holds(run_ctpm({"info", "a.ctpm"}, folder.path()).out, "build \\x1b]0;title\\x07\\x0averdict: same"));
}

TEST(OtherPhysics, ASessionStillOpensAndGivesItsDataAndTheVerdictNamesBothBuilds) {
  const TemporaryFolder folder;
  record_with_other_physics((folder.path() / "a.ctpm").string());
  const auto verified = run_ctpm({"verify", "a.ctpm"}, folder.path());
  EXPECT_EQ(verified.code, 1);
  EXPECT_TRUE(holds(verified.out, "different: first at tick 120 (state_hash), 180 of 300 ticks differ"))
      << verified.out;
  EXPECT_TRUE(holds(verified.out, "recorded by: test build\n")) << verified.out;
  EXPECT_TRUE(holds(verified.out, "replayed by: ctpm ")) << verified.out;
  EXPECT_EQ(run_ctpm({"info", "a.ctpm"}, folder.path()).code, 0);
  const auto replayed = run_ctpm({"replay", "a.ctpm", "--csv", "a.csv"}, folder.path());
  EXPECT_EQ(replayed.code, 1);
  EXPECT_TRUE(holds(replayed.out, "NOT as recorded")) << replayed.out;
  const auto rows = read_csv(folder.path() / "a.csv");
  ASSERT_EQ(rows.size(), 300u);
  EXPECT_EQ(rows[119].at("same_as_recorded"), "1");
  EXPECT_EQ(rows[120].at("same_as_recorded"), "0");
}

TEST(OtherPhysics, TheRevisionIsToldBeforeTheReplayAndWithTheResults) {
  const TemporaryFolder folder;
  const std::int32_t newer = kPhysicsRevision + 1;
  record_with_other_physics((folder.path() / "newer.ctpm").string(), newer);
  const std::string remark = "recorded with physics revision " + std::to_string(newer) + ", this build computes " +
                             std::to_string(kPhysicsRevision) + "; replay will differ";
  for (const char* command : {"verify", "replay"}) {
    const auto told = run_ctpm({command, "newer.ctpm"}, folder.path());
    EXPECT_EQ(told.code, 1);
    EXPECT_TRUE(told.err.starts_with("newer.ctpm: warning: " + remark + "\n")) << told.err;
  }
  EXPECT_TRUE(holds(run_ctpm({"verify", "newer.ctpm"}, folder.path()).out, "ticks differ; " + remark));
  EXPECT_TRUE(holds(run_ctpm({"info", "newer.ctpm"}, folder.path()).out, "physics    " + remark + "\n"));
  const std::string json = run_ctpm({"info", "newer.ctpm", "--json"}, folder.path()).out;
  EXPECT_TRUE(holds(json, "\"physics_revision\": " + std::to_string(newer) + ",")) << json;
  EXPECT_TRUE(holds(json, "\"physics_remark\": \"" + remark + "\"")) << json;

  record_with_other_physics((folder.path() / "old.ctpm").string(), 0);
  EXPECT_TRUE(holds(run_ctpm({"verify", "old.ctpm"}, folder.path()).err, "before physics revisions were stored"));
  record_with_other_physics((folder.path() / "same.ctpm").string());
  EXPECT_FALSE(holds(run_ctpm({"verify", "same.ctpm"}, folder.path()).err, "warning"));
}

TEST(OtherPhysics, ASessionOfARetiredIntegratorIsRefusedByNameByEveryCommand) {
  const TemporaryFolder folder;
  testing::write_with_integrator((folder.path() / "a.ctpm").string(), 1, 0);
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"info", "a.ctpm"}, {"verify", "a.ctpm"}, {"replay", "a.ctpm"}, {"export", "a.ctpm", "-o", "a.avi"}}) {
    const auto refused = run_ctpm(command, folder.path());
    EXPECT_EQ(refused.code, 2) << command[0];
    EXPECT_TRUE(
        holds(refused.err, "a.ctpm: error: was recorded with symplectic Euler, which this program no longer has"))
        << refused.err;
  }
}

TEST(Info, SaysWhatAnOldSessionLeavesOpen) {
  const TemporaryFolder folder;
  testing::write_with_integrator((folder.path() / "a.ctpm").string(), 0, 0);
  const auto info = run_ctpm({"info", "a.ctpm"}, folder.path());
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_TRUE(holds(info.out, "note       the session does not store which integrator `auto` became")) << info.out;
}

TEST(Info, ListsEventsInOrderOfTime) {
  const TemporaryFolder folder;
  const recordings::SessionStart start = testing::small_start();
  auto writer = recordings::SessionWriter::create((folder.path() / "a.ctpm").string(), start, {.wait_when_full = true});
  testing::live(start, 300, [&](const State& after, const recordings::TickRecord& record) {
    writer->append(after, record);
    if (after.tick == 200) writer->event({.tick = 200, .text = "later"});
    if (after.tick == 250) writer->event({.tick = 150, .kind = recordings::EventKind::contact_ends, .tool = 1});
  });
  ASSERT_TRUE(writer->finish());
  for (const char* json : {"", "--json"}) {
    const auto info =
        run_ctpm(*json ? std::vector<std::string>{"info", "a.ctpm", json} : std::vector<std::string>{"info", "a.ctpm"},
                 folder.path());
    EXPECT_LT(info.out.find("scalpel leaves the tissue"), info.out.find("later")) << info.out;
  }
}

TEST(OldFiles, TheProgramListsAndExportsThem) {
  const TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(std::string(CTPM_SOURCE_DIR) + "/tests/recordings/old")) {
    if (entry.path().extension() != ".ctpm") continue;
    const std::string name = entry.path().filename().string();
    fs::copy(entry.path(), folder.path() / name);
    const auto info = run_ctpm({"info", name}, folder.path());
    EXPECT_EQ(info.code, 0) << info.err;
    const auto replayed = run_ctpm({"replay", name, "--csv", name + ".csv"}, folder.path());
    EXPECT_TRUE(replayed.code == 0 || replayed.code == 1) << replayed.err;  // physics may have changed since
    EXPECT_GE(read_csv(folder.path() / (name + ".csv")).size(), 300u) << name;
  }
}

TEST(RecoverProgram, ExitsWith3WhenSomethingIsMissingAndWith0WhenNothingIs) {
  const TemporaryFolder folder;
  const auto whole = run_ctpm({"recover", kPress, "-o", "whole.ctpm"}, folder.path());
  EXPECT_EQ(whole.code, 0) << whole.out << whole.err;
  EXPECT_TRUE(holds(whole.out, "same: ")) << whole.out;

  // One bit in a chunk of ticks, somewhere behind the middle.
  const std::string damaged = (folder.path() / "damaged.ctpm").string();
  std::vector<char> bytes = testing::read_bytes(kPress);
  std::string damage;
  for (std::size_t place = bytes.size() * 3 / 4; damage.empty() && place < bytes.size(); place += 997) {
    bytes[place] = char(bytes[place] ^ 4);
    testing::write_bytes(damaged, bytes);
    bytes[place] = char(bytes[place] ^ 4);
    auto reader = recordings::SessionReader::open(damaged);
    const auto all = reader ? reader->check_all() : Result<Done>(Done{});
    if (!all && holds(testing::text_of(all.errors()), "chunk")) damage = testing::text_of(all.errors());
  }
  ASSERT_FALSE(damage.empty());
  const auto verified = run_ctpm({"verify", "damaged.ctpm"}, folder.path());
  EXPECT_EQ(verified.code, 2);
  EXPECT_TRUE(holds(verified.err, "chunk")) << verified.err;
  const auto partly = run_ctpm({"recover", "damaged.ctpm", "-o", "saved.ctpm"}, folder.path());
  EXPECT_EQ(partly.code, 3) << partly.out << partly.err;
  EXPECT_TRUE(holds(partly.out, "lost: ")) << partly.out;
  EXPECT_TRUE(holds(partly.out, "same: ")) << partly.out;
  EXPECT_EQ(run_ctpm({"verify", "saved.ctpm"}, folder.path()).code, 0);
}

TEST(RecoverProgram, SavesTheBeginningOfAFileThatWasCutShort) {
  const TemporaryFolder folder;
  for (const auto& [session, percent] :
       {std::pair<std::string, int>{"liver-press-expert", 90}, {"kidney-cut-expert", 99}}) {
    const std::string name = session + std::to_string(percent) + ".ctpm", saved = "saved-" + name;
    const std::string whole = slurp(kShipped + "/" + session + ".ctpm");
    std::ofstream(folder.path() / name, std::ios::binary) << whole.substr(0, whole.size() * std::size_t(percent) / 100);
    EXPECT_EQ(run_ctpm({"verify", name}, folder.path()).code, 2);
    const auto recovered = run_ctpm({"recover", name, "-o", saved}, folder.path());
    EXPECT_EQ(recovered.code, 3) << name << recovered.out << recovered.err;
    EXPECT_TRUE(holds(recovered.out, "same: ")) << recovered.out;
    EXPECT_FALSE(recovered.out.starts_with(saved + ": 0 ticks")) << recovered.out;
  }
}

TEST(KilledProgram, LeavesASessionThatIsSaidToBeUnfinishedAndCanBeRecovered) {
  const TemporaryFolder folder;
  const std::string scene = kScenes + "/skin.json", session = (folder.path() / "a.ctpm").string();
  const pid_t child = fork();
  if (child == 0) {
    freopen("/dev/null", "w", stdout), freopen("/dev/null", "w", stderr);
    execl(CTPM_PROGRAM, "ctpm", "record", scene.c_str(), "-o", session.c_str(), nullptr);
    _exit(127);
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!fs::exists(session) && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);

  const auto verified = run_ctpm({"verify", "a.ctpm"}, folder.path());
  EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
  EXPECT_TRUE(holds(verified.err, "no clean end")) << verified.err;
  const auto compared = run_ctpm({"compare", "a.ctpm", "a.ctpm"}, folder.path());
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_TRUE(holds(compared.err, "warning: a.ctpm has no clean end: what is there is measured")) << compared.err;
  const auto recovered = run_ctpm({"recover", "a.ctpm", "-o", "b.ctpm"}, folder.path());
  EXPECT_EQ(recovered.code, 3) << recovered.out << recovered.err;
  EXPECT_TRUE(holds(recovered.out, "lost: the session was cut off")) << recovered.out;
}

}  // namespace
}  // namespace ctpm
