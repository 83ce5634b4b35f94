// Verifying is checking everything: tables, counts, links and statistics, whether or not a replay reads them.

#include "recordings/internal/statistics.h"
#include "recordings/replay.h"
#include "tests/recordings/forge.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using recordings::SessionStatistics;

/// What verifying a file says: errors, or the verdict.
struct Said {
  bool is_same = false;
  std::string text;
};

Said verify(const std::string& path) {
  auto reader = recordings::SessionReader::open(path);
  if (!reader) return {false, text_of(reader.errors())};
  const auto verdict = recordings::verify_session(*reader);
  if (!verdict) return {false, text_of(verdict.errors())};
  return {verdict->same, recordings::to_string(*verdict)};
}

/// A session with keyframes 0, 250, 500, 750 and with events.
class WholeFile : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    record_session(*folder_ / "good.ctpm", small_start(), 900);
  }
  static void TearDownTestSuite() { delete folder_; }

  /// Applies `damage` to a copy, and expects that verifying it names `message`.
  void expect_named(const std::function<void(Forge&)>& damage, const std::string& message) const {
    const std::string path = *folder_ / "bad.ctpm";
    std::filesystem::copy_file(*folder_ / "good.ctpm", path, std::filesystem::copy_options::overwrite_existing);
    {
      Forge forge(path);
      damage(forge);
    }
    const Said said = verify(path);
    EXPECT_FALSE(said.is_same) << message;
    EXPECT_NE(said.text.find(message), std::string::npos) << message << " is not in: " << said.text;
  }

  inline static Folder* folder_ = nullptr;
};

TEST_F(WholeFile, IsTheSameUntouched) { EXPECT_TRUE(verify(*folder_ / "good.ctpm").is_same); }

TEST_F(WholeFile, EventsAreChecked) {
  expect_named([](Forge& f) { f.run("UPDATE event SET data = zeroblob(length(data)) WHERE first = 0"); },
               "the checksum does not match");
  expect_named([](Forge& f) { f.run("DELETE FROM event WHERE first = (SELECT max(first) FROM event)"); },
               "events are left");
  expect_named([](Forge& f) { f.run("DELETE FROM event WHERE first = 0"); }, "event");
  // Only what is missing is said to be.
  const std::string path = *folder_ / "bad.ctpm";
  EXPECT_EQ(verify(path).text.find("missing"), verify(path).text.rfind("missing")) << verify(path).text;
}

/// The events of the first run, with right checksums.
void change_events(Forge& forge, const std::function<void(recordings::Event&)>& change) {
  using namespace recordings::session_file;
  forge.change("event", "0", [&](Bytes& content) {
    std::vector<recordings::Event> events;
    std::string problem;
    ByteReader in(content, 1 << 20);
    FieldSet set(in, problem);
    FieldReader(set, in.budget(), problem)("events", events);
    CTPM_CHECK(problem.empty() && !events.empty(), "events to forge");
    change(events.front());
    content.clear();
    put_field_set(content, [&](FieldWriter& writer) { writer("events", events); });
  });
}

TEST_F(WholeFile, TheLinksOfEventsAreChecked) {
  expect_named([](Forge& f) { change_events(f, [](recordings::Event& e) { e.tool = 2; }); }, "tool is 2");
  expect_named([](Forge& f) { change_events(f, [](recordings::Event& e) { e.severed = -3; }); }, "severed is below 0");
  expect_named([](Forge& f) { change_events(f, [](recordings::Event& e) { e.tick = 901; }); }, "tick 901");
  expect_named([](Forge& f) { change_events(f, [](recordings::Event& e) { e.tick = -1; }); }, "tick -1");
}

TEST_F(WholeFile, KeyframesAreChecked) {
  expect_named([](Forge& f) { f.run("DELETE FROM keyframe WHERE tick = 500"); }, "keyframes are left");
  for (const char* tick : {"-1", "9223372036854775807"})
    expect_named([&](Forge& f) { f.run(std::string("UPDATE keyframe SET tick = ") + tick + " WHERE tick = 500"); },
                 "keyframe");
  expect_named([](Forge& f) { f.move_keyframe(500, -1); }, "keyframe -1");
  expect_named([](Forge& f) { f.move_keyframe(500, INT64_MAX); }, "keyframe of tick 9223372036854775807");
  expect_named([](Forge& f) { f.move_keyframe(500, 501); }, "keyframe 501");
}

TEST_F(WholeFile, EveryStatisticIsCountedAnew) {
  using namespace recordings::session_file;
  std::vector<std::string> names;
  const SessionStatistics any;
  for_each_field(any, [&](std::string_view name, const auto&) { names.emplace_back(name); });
  ASSERT_GE(names.size(), 14u);
  for (const std::string& changed : names)
    expect_named(
        [&](Forge& forge) {
          forge.change("part", "finish", [&](Bytes& content) {
            SessionStatistics stored;
            std::string problem, value_names;
            std::vector<double> values;
            ByteReader in(content, 1 << 20);
            FieldSet set(in, problem);
            FieldReader reader(set, in.budget(), problem);
            for_each_field(stored, reader);
            for_each_field(stored, [&](std::string_view name, auto& value) {
              if (name == changed) value = -1 - value;
            });
            content.clear();
            put_finish(content, stored);
          });
        },
        changed == "ticks"       ? "ticks are left"
        : changed == "events"    ? "events are left"
        : changed == "keyframes" ? "keyframes are left"
                                 : changed);
}

TEST_F(WholeFile, ChunksAndPartsAreChecked) {
  expect_named([](Forge& f) { f.run("DELETE FROM chunk WHERE first = (SELECT max(first) FROM chunk)"); },
               "ticks are left");
  expect_named([](Forge& f) { f.run("DELETE FROM chunk WHERE first = 200"); }, "ticks 200 to");
  expect_named([](Forge& f) { f.run("INSERT INTO part VALUES('later', 4, 5, x'00')"); }, "part later");
  expect_named(
      [](Forge& f) {
        f.change("part", "initial", [](session_file::Bytes& content) {
          State state;
          std::string problem;
          session_file::ByteReader in(content, 1 << 30);
          session_file::get_fields(in, state, problem);
          CTPM_CHECK(problem.empty(), "a state to forge");
          state.tick += 1;
          content.clear();
          session_file::put_fields(content, state);
        });
      },
      "part initial: is another state than keyframe 0");
}

/// A recorder that is killed leaves its log beside the file; somebody copies the file alone.
TEST(LostLog, IsToldAndTheFileAloneHoldsAllButSeconds) {
  const Folder folder;
  const std::string path = folder / "a.ctpm", alone = folder / "alone.ctpm";
  const recordings::SessionStart start = small_start(3, 2, 2);
  auto writer = recordings::SessionWriter::create(path, start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  std::filesystem::copy_file(path, alone);
  {
    auto reader = recordings::SessionReader::open(alone);
    ASSERT_TRUE(reader) << text_of(reader.errors());
    EXPECT_EQ(reader->tick_count(), 0);
    ASSERT_EQ(reader->remarks().size(), 1u);
    EXPECT_NE(reader->remarks()[0].find("alone.ctpm-wal"), std::string::npos);
  }
  live(start, 300, [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  // Far below the 4 MiB after which SQLite copies the log by itself.
  std::int64_t held = 0;
  for (int tries = 0; tries < 600 && held < 300; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::filesystem::copy_file(path, alone, std::filesystem::copy_options::overwrite_existing);
    if (const auto reader = recordings::SessionReader::open(alone)) held = reader->tick_count();
  }
  EXPECT_EQ(held, 300) << "while the session is still being recorded";
  EXPECT_TRUE(verify(alone).is_same);
}

}  // namespace
}  // namespace ctpm
