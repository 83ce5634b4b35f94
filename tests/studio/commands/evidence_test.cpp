// A session as evidence, from outside: events that somebody changed, signatures, and time that a late machine lost.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "recordings/internal/statistics.h"
#include "recordings/signature.h"
#include "tests/recordings/forge.h"
#include "tests/studio/commands/running_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using recordings::Event;
using recordings::EventKind;
using testing::Forge;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::RunningProgram;
using testing::TemporaryFolder;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class Evidence : public ::testing::Test {
 protected:
  Evidence() {
    std::ofstream(path("block.json")) << R"({"format": "ctpm-scene", "version": 1, "name": "block",
      "settle_s": 0, "organs": [{"name": "block", "rig": {"block": [4, 3, 3]}, "material": {"preset": "liver"},
      "anchors": [{"lowest_mm": 1}]}], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8},
      {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 30}]})";
    std::ofstream(path("press.json")) << R"({"format": "ctpm-script", "version": 1, "steps": [
      {"take": {"tool": "ball", "at_mm": [0, 0, 50]}}, {"press": {"distance_mm": 30, "speed_mm_per_s": 60}},
      {"wait_s": 0.1}, {"put_away": true}, {"wait_s": 1}]})";
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  ProgramOutcome ctpm(const std::vector<std::string>& arguments) { return run_ctpm(arguments, folder_.path()); }
  void record() {
    const ProgramOutcome outcome = ctpm({"record", "block.json", "--script", "press.json", "-o", "a.ctpm", "--fast"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  TemporaryFolder folder_;
};

/// Writes the session's events anew, with right checksums and counts.
void forge_events(const std::string& path, const std::function<void(std::vector<Event>&)>& change) {
  using namespace recordings::session_file;
  std::vector<Event> events;
  recordings::SessionStatistics statistics;
  {
    auto reader = recordings::SessionReader::open(path);
    events = *reader->events(), statistics = *reader->statistics();
  }
  change(events);
  Forge forge(path);
  forge.run("DELETE FROM event WHERE first > 0");
  forge.change("event", "0", [&](Bytes& content) {
    content.clear();
    put_field_set(content, [&](FieldWriter& writer) { writer("events", events); });
  });
  forge.recount_events(0, std::int64_t(events.size()));
  statistics.events = std::int64_t(events.size());
  forge.change("part", "finish", [&](Bytes& content) {
    content.clear();
    put_finish(content, statistics);
  });
}

TEST_F(Evidence, AnEventThatIsAddedChangedOrTakenAwayIsFoundThoughEveryCountIsMadeRight) {
  record();
  ASSERT_EQ(ctpm({"verify", "a.ctpm"}).code, 0);
  const auto contact = [](std::vector<Event>& events) {
    return std::ranges::find_if(events, [](const Event& e) { return e.kind == EventKind::contact_begins; });
  };
  const std::vector<std::pair<std::function<void(std::vector<Event>&)>, std::string>> forgeries{
      {[](std::vector<Event>&) {}, "same"},
      {[](std::vector<Event>& e) { e.push_back({.tick = 3, .kind = EventKind::note, .text = "of the moment"}); },
       "same"},
      {[&](std::vector<Event>& e) { e.erase(contact(e)); }, "different: the event 'contact"},
      {[](std::vector<Event>& e) {
         std::erase_if(e, [](const Event& x) { return x.kind == EventKind::contact_ends; });
       },
       "is missing"},
      {[&](std::vector<Event>& e) { contact(e)->tick += 1; }, "does not follow from its ticks"},
      {[&](std::vector<Event>& e) { contact(e)->tool = 1; }, "does not follow from its ticks"},
      {[](std::vector<Event>& e) { e.push_back({.tick = 9, .kind = EventKind::cut, .tool = 1, .severed = 3}); },
       "does not follow from its ticks"}};
  for (const auto& [change, said] : forgeries) {
    fs::copy_file(path("a.ctpm"), path("b.ctpm"), fs::copy_options::overwrite_existing);
    forge_events(path("b.ctpm"), change);
    const ProgramOutcome verified = ctpm({"verify", "b.ctpm"});
    EXPECT_TRUE(holds(verified.out, said)) << said << " is not in: " << verified.out << verified.err;
    EXPECT_EQ(verified.code, said == "same" ? 0 : 1);
  }
}

TEST_F(Evidence, NothingComparedIsNoGoodVerdict) {
  auto writer = recordings::SessionWriter::create(path("none.ctpm"), testing::small_start());
  ASSERT_TRUE(writer && writer->finish());
  const ProgramOutcome verified = ctpm({"verify", "none.ctpm"});
  EXPECT_EQ(verified.code, 1);
  EXPECT_TRUE(holds(verified.out, "no verdict: there is no tick to compare")) << verified.out;
}

TEST_F(Evidence, ABuildThatCannotSignSaysSo) {
  if (recordings::can_sign()) GTEST_SKIP() << "built with CTPM_SIGNING";
  record();
  std::ofstream(path("me.pem")) << "a key";
  for (const std::vector<std::string>& command : {std::vector<std::string>{"key", "new.pem"},
                                                  {"sign", "a.ctpm", "--key", "me.pem"},
                                                  {"verify", "a.ctpm", "--key", "me.pem"}}) {
    const ProgramOutcome outcome = ctpm(command);
    EXPECT_EQ(outcome.code, 2) << command[0];
    EXPECT_TRUE(holds(outcome.err, "this build cannot sign")) << outcome.err;
    EXPECT_TRUE(holds(outcome.err, "CTPM_SIGNING=ON")) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(path("new.pem")));
  EXPECT_EQ(ctpm({"verify", "a.ctpm"}).code, 0);
}

TEST_F(Evidence, AnExamIsSignedAndVerifyingNamesItsKey) {
  if (!recordings::can_sign()) GTEST_SKIP() << "built without CTPM_SIGNING";
  record();
  const ProgramOutcome made = ctpm({"key", "me.pem"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(ctpm({"key", "me.pem"}).code, 2) << "a key is not replaced";
  ASSERT_EQ(ctpm({"key", "other.pem"}).code, 0);
  const ProgramOutcome unsigned_yet = ctpm({"verify", "a.ctpm", "--key", "me.pem.pub"});
  EXPECT_EQ(unsigned_yet.code, 1);
  EXPECT_TRUE(holds(unsigned_yet.out, "is not signed")) << unsigned_yet.out;
  ASSERT_EQ(ctpm({"sign", "a.ctpm", "--key", "me.pem", "--name", "A. Trainee"}).code, 0);
  const ProgramOutcome good = ctpm({"verify", "a.ctpm", "--key", "me.pem.pub"});
  EXPECT_EQ(good.code, 0) << good.out << good.err;
  const std::string key = made.out.substr(made.out.find("public key ") + 11, 64);
  EXPECT_TRUE(holds(good.out, "signed with the key " + key + " by A. Trainee")) << good.out;
  const ProgramOutcome wrong = ctpm({"verify", "a.ctpm", "--key", "other.pem.pub"});
  EXPECT_EQ(wrong.code, 1);
  EXPECT_TRUE(holds(wrong.out, "that is not the key")) << wrong.out;
  // A change that no checksum and no replay tells.
  forge_events(path("a.ctpm"), [](std::vector<Event>& e) { e.push_back({.kind = EventKind::note, .text = "late"}); });
  const ProgramOutcome changed = ctpm({"verify", "a.ctpm"});
  EXPECT_EQ(changed.code, 2) << changed.out;
  EXPECT_TRUE(holds(changed.err, "is not what was signed with the key " + key)) << changed.err;
}

/// The machine is late because it stops the program for a while.
TEST_F(Evidence, TimeThatALateMachineLosesIsSaidByRecordAndInfo) {
  RunningProgram program({"record", "block.json", "--script", "press.json", "-o", "a.ctpm"}, folder_.path());
  for (int i = 0; i < 3000 && !fs::exists(path("a.ctpm-wal")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  // The file is there before the tissue has settled, which takes a moment; then the press goes on for 1.7 s.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  program.stop_for(std::chrono::milliseconds(600));
  const ProgramOutcome recorded = program.outcome();
  EXPECT_EQ(recorded.code, 0) << recorded.err;
  EXPECT_TRUE(holds(recorded.out, "s behind real time at the end")) << recorded.out;
  EXPECT_TRUE(holds(recorded.out, "THE SESSION IS SHORTER THAN THE TIME IT TOOK")) << recorded.out;
  const ProgramOutcome info = ctpm({"info", "a.ctpm"});
  const std::size_t at = info.out.find("clock      ");
  ASSERT_NE(at, std::string::npos) << info.out;
  EXPECT_GE(std::atof(info.out.c_str() + at + 11), 0.4) << info.out;
  EXPECT_EQ(ctpm({"verify", "a.ctpm"}).code, 0);
}

TEST_F(Evidence, TheClockIsShownWhileASessionIsRecorded) {
  // `script` gives the program a terminal.
  const ProgramOutcome shown = testing::run(
      {"script", "-qec", std::string(CTPM_PROGRAM) + " record block.json --script press.json -o a.ctpm", "/dev/null"},
      folder_.path());
  EXPECT_EQ(shown.code, 0) << shown.out;
  EXPECT_TRUE(holds(shown.out, "tick p99 ")) << shown.out;
  EXPECT_TRUE(holds(shown.out, " s behind")) << shown.out;
}

}  // namespace
}  // namespace ctpm
