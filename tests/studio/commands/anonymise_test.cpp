// `ctpm anonymise` from outside: a word that stands in every place of a session is in no byte of the new one, which
// verifies all the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "recordings/internal/ed25519.h"
#include "recordings/internal/statistics.h"
#include "recordings/signature.h"
#include "tests/recordings/forge.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using recordings::Event;
using recordings::EventKind;
using recordings::SessionReader;
using testing::Forge;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;
using namespace recordings;
using session_file::Bytes;

/// Each place of a session has a word of its own, so that a failure tells which one was forgotten.
const std::vector<std::string> kInContent{
    "SecretScene",  "SecretTask",  "SecretZone", "SecretComment", "SecretOrgan",  "SecretTool",  "SecretCamera",
    "SecretProbe",  "SecretTable", "SecretLook", "SecretUser",    "/home/secret", "SecretBuild", "SecretNote",
    "SecretReason", "SecretCount", "SecretOld",  "SecretSigner",  "SecretPart"};

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The content of every block of a session, before compression, one after the other.
std::string contents_of(const std::string& path) {
  const std::string copy = path + ".copy";
  fs::copy_file(path, copy, fs::copy_options::overwrite_existing);
  auto store = session_file::SessionStore::open(copy, false);
  const std::vector<std::string> parts = *store->part_names();
  Forge forge(copy);
  std::string all;
  const auto collect = [&](Bytes& content) { all.append(content.begin(), content.end()); };
  for (const std::string& part : parts) {
    all += part;
    EXPECT_TRUE(forge.change("part", part, collect)) << part;
  }
  for (const char* table : {"chunk", "keyframe", "event"}) {
    const std::vector<std::int64_t> keys = *store->keys(table);
    for (const std::int64_t key : keys)
      EXPECT_TRUE(forge.change(table, std::to_string(key), collect)) << table << " " << key;
  }
  return all;
}

class Anonymise : public ::testing::Test {
 protected:
  Anonymise() {
    if (!can_sign()) return;
    std::ofstream(path("block.json"))
        << R"({"format": "ctpm-scene", "version": 1, "name": "SecretScene", "task": "SecretTask",
      // SecretComment drew this
      "settle_s": 0, "organs": [{"name": "SecretOrgan", "rig": {"block": [4, 3, 3]}, "material": {"preset": "liver"},
      "anchors": [{"lowest_mm": 1}]}],
      "tools": [{"name": "SecretTool", "kind": "ball", "radius_mm": 8},
                {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 30}],
      "obstacles": [{"name": "SecretTable", "plane": {"point_mm": [0, 0, -500], "normal": [0, 0, 1]}}],
      "forbidden": [{"name": "SecretZone", "sphere": {"centre_mm": [0, 0, -400], "radius_mm": 5}}],
      "probes": [{"name": "SecretProbe", "at_mm": [0, 0, 20]}],
      "cameras": [{"name": "SecretCamera", "eye_mm": [0, -300, 200], "target_mm": [0, 0, 0]}]})";
    std::ofstream(path("press.json")) << R"({"format": "ctpm-script", "version": 1, "steps": [
      {"take": {"tool": "SecretTool", "at_mm": [0, 0, 50]}}, {"press": {"distance_mm": 30, "speed_mm_per_s": 60}},
      {"wait_s": 0.6}, {"put_away": true}, {"wait_s": 0.4}]})";
  }
  void SetUp() override {
    if (!can_sign()) GTEST_SKIP() << "built without CTPM_SIGNING";
    const ProgramOutcome recorded = ctpm({"record", "block.json", "--script", "press.json", "-o", "a.ctpm", "--fast"});
    ASSERT_EQ(recorded.code, 0) << recorded.err;
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  ProgramOutcome ctpm(const std::vector<std::string>& arguments) { return run_ctpm(arguments, folder_.path()); }

  /// Puts a word into each place of the session that holds text, and signs it.
  void fill_every_place(const std::string& name) {
    using namespace session_file;
    std::vector<Event> events;
    SessionStatistics statistics;
    std::map<std::string, std::string> metadata;
    {
      auto reader = SessionReader::open(path(name));
      events = *reader->events(), statistics = *reader->statistics(), metadata = reader->start().metadata;
    }
    events.push_back({.tick = 3, .kind = EventKind::note, .text = "SecretNote was nervous"});
    events.push_back({.tick = 4, .kind = EventKind::device_lost, .reason = "SecretReason:18944"});
    events.push_back({.tick = 5, .kind = EventKind::late_tick, .text = "SecretOld", .values = {1}});
    statistics.events = std::int64_t(events.size()), statistics.late_ticks += 1;
    statistics.values = {{"SecretCount", 4}};
    metadata["user"] = "SecretUser", metadata["motion_file"] = "/home/secret/hand.csv";
    {
      Forge forge(path(name));
      const auto put_anew = [&](const char* part, const auto& put) {
        ASSERT_TRUE(forge.change("part", part, [&](Bytes& content) { content.clear(), put(content); })) << part;
      };
      forge.run("DELETE FROM event WHERE first > 0");
      forge.change("event", "0", [&](Bytes& content) {
        content.clear(), put_field_set(content, [&](FieldWriter& writer) { writer("events", events); });
      });
      forge.recount_events(0, std::int64_t(events.size()));
      put_anew("finish", [&](Bytes& content) { put_finish(content, statistics); });
      put_anew("look", [&](Bytes& content) { put_raw(content, "SecretLook", 10); });
      put_anew("metadata", [&](Bytes& content) {
        put_field_set(content, [&](FieldWriter& writer) {
          for (const auto& [key, value] : metadata) writer(key, value);
        });
      });
      ASSERT_TRUE(forge.change("part", "session", [](Bytes& content) {
        // The identity's build text, in place: the lengths stay.
        const std::string build = "ctpm ", secret = "SecretBuild";
        const auto at = std::search(content.begin(), content.end(), build.begin(), build.end());
        ASSERT_NE(at, content.end());
        std::copy(secret.begin(), secret.end(), at);
      }));
      // A part that no program knows, and one that was there: its name stays on a free page of the database.
      forge.add_part("SecretPart", "SecretPart");
      for (int i = 0; i < 40; ++i) forge.add_part("SecretGone" + std::to_string(i), std::string(3000, char('a' + i)));
      forge.run("PRAGMA secure_delete=OFF");
      forge.run("DELETE FROM part WHERE name LIKE 'SecretGone%'");
    }
    ASSERT_EQ(ctpm({"key", "me.pem"}).code, 0);
    const ProgramOutcome is_signed = ctpm({"sign", name, "--key", "me.pem", "--name", "SecretSigner"});
    ASSERT_EQ(is_signed.code, 0) << is_signed.err;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Anonymise, NoPlaceOfASessionKeepsAWordAndItStillVerifies) {
  fill_every_place("a.ctpm");
  const std::string before = contents_of(path("a.ctpm"));
  for (const std::string& word : kInContent) ASSERT_TRUE(holds(before, word)) << word << ": the test looks nowhere";
  ASSERT_TRUE(holds(slurp(path("a.ctpm")), "SecretGone")) << "the test looks at no free page";

  const ProgramOutcome done =
      ctpm({"anonymise", "a.ctpm", "--trainee", "Ana Secretname", "--key", "course.key", "-o", "b.ctpm"});
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string bytes = slurp(path("b.ctpm")), after = contents_of(path("b.ctpm"));
  for (const std::string& text : {bytes, after}) {
    std::string lower;
    std::ranges::transform(text, std::back_inserter(lower), [](char c) { return char(std::tolower(c)); });
    EXPECT_FALSE(holds(lower, "secret")) << lower.substr(lower.find("secret"), 40);
  }
  for (const char* said : {"texts of notes", "the signature", "metadata 'user'", "comments of the scene",
                           "the scene's task", "stays: the shape of the organs"})
    EXPECT_TRUE(holds(done.out, said)) << said << " is not in " << done.out;

  const ProgramOutcome verified = ctpm({"verify", "b.ctpm"});
  EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
  auto a = SessionReader::open(path("a.ctpm")), b = SessionReader::open(path("b.ctpm"));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(*a->ticks(0, a->tick_count()), *b->ticks(0, b->tick_count()));
  EXPECT_EQ(*a->keyframe_ticks(), *b->keyframe_ticks());
  EXPECT_NE(a->session_id(), b->session_id());
  EXPECT_EQ(b->created_unix_s(), 0);
  EXPECT_EQ(folder_.list().find("unfinished"), std::string::npos);
  // What follows from the ticks is still there, and the scene is still one that pictures are drawn of.
  EXPECT_EQ(a->events()->size(), b->events()->size());
  EXPECT_EQ(ctpm({"export", "b.ctpm", "-o", "b.png", "--at-s", "0.3", "--size", "160x120"}).code, 0);
  EXPECT_TRUE(holds(ctpm({"info", "b.ctpm"}).out, "recorded 0 s after the first session"));
}

TEST_F(Anonymise, OneKeyGivesOnePseudonymAndAnotherKeyAnother) {
  const auto trainee = [&](const std::string& name, const std::string& key, const std::string& out) {
    std::vector<std::string> command{"anonymise", "a.ctpm", "--trainee", name, "-o", out};
    if (!key.empty()) command.insert(command.end(), {"--key", key});
    EXPECT_EQ(ctpm(command).code, 0);
    return SessionReader::open(path(out))->start().metadata.at("trainee");
  };
  const std::string ana = trainee("Ana", "one.key", "1.ctpm");
  EXPECT_EQ(ana, trainee("Ana", "one.key", "2.ctpm"));
  EXPECT_NE(ana, trainee("Ben", "one.key", "3.ctpm"));
  EXPECT_NE(ana, trainee("Ana", "two.key", "4.ctpm"));
  EXPECT_NE(trainee("Ana", "", "5.ctpm"), trainee("Ana", "", "6.ctpm"));
  EXPECT_EQ(ana.size(), std::string("trainee-").size() + 12) << ana;
  EXPECT_EQ(fs::status(path("one.key")).permissions() & fs::perms::mask,
            fs::perms::owner_read | fs::perms::owner_write);
  // Sessions of one key are of one scene still.
  EXPECT_EQ(ctpm({"compare", "1.ctpm", "2.ctpm"}).code, 0);
}

TEST_F(Anonymise, TheKeyedHashIsThatOfRfc4231) {
  const session_file::Bytes jefe{'J', 'e', 'f', 'e'};
  const auto hash = session_file::keyed_hash(jefe, session_file::view("what do ya want for nothing?"));
  std::string digits;
  for (const std::uint8_t byte : hash) digits += "0123456789abcdef"[byte >> 4], digits += "0123456789abcdef"[byte & 15];
  EXPECT_EQ(digits, "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");  // its case 2
}

TEST_F(Anonymise, SessionsThatBelongTogetherKeepTheirOrderAndTheirParent) {
  ASSERT_EQ(
      ctpm({"record", "--continue", "a.ctpm", "--at", "0.2", "--script", "press.json", "-o", "later.ctpm", "--fast"})
          .code,
      0);
  const ProgramOutcome done = ctpm({"anonymise", "later.ctpm", "a.ctpm", "--key", "k", "-o", "out/"});
  ASSERT_EQ(done.code, 0) << done.err;
  std::vector<SessionReader> sessions;
  for (const auto& entry : fs::directory_iterator(path("out")))
    sessions.push_back(std::move(*SessionReader::open(entry.path().string())));
  ASSERT_EQ(sessions.size(), 2u);
  std::ranges::sort(sessions, {}, &SessionReader::created_unix_s);
  EXPECT_EQ(sessions[0].created_unix_s(), 0);
  EXPECT_GT(sessions[1].created_unix_s(), 0);
  EXPECT_LT(sessions[1].created_unix_s(), 600);
  EXPECT_EQ(sessions[1].start().metadata.at("parent_session"), sessions[0].session_id());
}

TEST_F(Anonymise, WhatCannotBeDoneIsRefusedWholly) {
  std::ofstream(path("text.ctpm")) << "no session";
  ProgramOutcome refused = ctpm({"anonymise", "a.ctpm", "text.ctpm", "missing.ctpm", "--key", "new.key", "-o", "out"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "text.ctpm") && holds(refused.err, "missing.ctpm")) << refused.err;
  EXPECT_FALSE(fs::exists(path("out")) || fs::exists(path("new.key")));
  EXPECT_EQ(ctpm({"anonymise", "a.ctpm", "-o", "text.ctpm"}).code, 2);
  EXPECT_EQ(slurp(path("text.ctpm")), "no session");
  std::ofstream(path("short.key")) << "short";
  refused = ctpm({"anonymise", "a.ctpm", "--key", "short.key", "-o", "b.ctpm"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "short.key: error: is no key")) << refused.err;
  std::ofstream(path("scene.json")) << "{ \"format\": \"ctpm-scene\", \"version\": 1, \"organs\": [] }";
  std::ofstream(path("public.key")) << "-----BEGIN PUBLIC KEY-----\nMCowBQYDK2VwAyEA\n-----END PUBLIC KEY-----\n";
  for (const auto& [file, kind] :
       {std::pair("scene.json", "JSON"), std::pair("public.key", "the public key"), std::pair("a.ctpm", "a session")}) {
    refused = ctpm({"anonymise", "a.ctpm", "--key", file, "-o", "b.ctpm"});
    EXPECT_EQ(refused.code, 2) << file;
    EXPECT_TRUE(holds(refused.err, std::string(file) + ": error: is no key but " + kind)) << refused.err;
  }
  refused = ctpm({"anonymise", "a.ctpm", "a.ctpm", "-o", "both.ctpm"});
  EXPECT_TRUE(refused.code == 2 && holds(refused.err, "both.ctpm: error: is the name of one session")) << refused.err;
  refused = ctpm({"anonymise", "a.ctpm", "a.ctpm", "-o", "twice/"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "is the same session as another")) << refused.err;
  EXPECT_FALSE(fs::exists(path("b.ctpm")) || fs::exists(path("twice")));
}

}  // namespace
}  // namespace ctpm
