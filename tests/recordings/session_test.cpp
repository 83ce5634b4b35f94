#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <thread>

#include "core/model/fields.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

/// Every field of a structure as bytes, for a bitwise comparison.
template <class S>
std::string bytes_of(const S& structure) {
  std::string bytes;
  const auto visit = [&](auto& self, std::string_view name, const auto& value) -> void {
    using T = std::decay_t<decltype(value)>;
    bytes += name;
    if constexpr (std::is_same_v<T, std::string>) {
      bytes += value;
    } else if constexpr (requires {
                           value.size();
                           value.data();
                         }) {
      bytes += std::to_string(value.size());
      for (const auto& item : value) {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(item)>> ||
                      std::is_enum_v<std::decay_t<decltype(item)>>)
          bytes.append(reinterpret_cast<const char*>(&item), sizeof item);
        else
          for_each_field(item, [&](std::string_view n, const auto& v) { self(self, n, v); });
      }
    } else {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  };
  for_each_field(structure, [&](std::string_view name, const auto& value) { visit(visit, name, value); });
  return bytes;
}

void expect_same_surface(const Surface& a, const Surface& b) {
  EXPECT_EQ(a.vertex, b.vertex);
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.binding.first, b.binding.first);
  EXPECT_EQ(a.binding.sphere, b.binding.sphere);
  EXPECT_EQ(a.binding.weight, b.binding.weight);
}

TEST(Session, WhatWasWrittenIsRead) {
  const Folder folder;
  recordings::SessionStart start = small_start();
  start.scene_text = std::string("bytes\0 of any kind \xff", 20);
  start.model.gravity = {0, 0, -9.81};
  start.initial_state.tick = 5;
  shake(start.initial_state, 1e-4, 1e-3);
  const Lived lived = record_session(folder / "a.ctpm", start, 1234);

  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_EQ(reader->start().scene_text, start.scene_text);
  EXPECT_EQ(reader->start().look, start.look);
  EXPECT_EQ(reader->start().metadata, start.metadata);
  EXPECT_EQ(reader->start().build_fingerprint, start.build_fingerprint);
  EXPECT_EQ(reader->start().physics_revision, kPhysicsRevision);
  EXPECT_TRUE(bytes_of(reader->start().model) == bytes_of(start.model));
  EXPECT_TRUE(bytes_of(reader->start().initial_state) == bytes_of(start.initial_state));
  ASSERT_EQ(reader->start().model.surfaces.size(), 1u);
  expect_same_surface(reader->start().model.surfaces[0], start.model.surfaces[0]);
  EXPECT_EQ(reader->session_id().size(), 32u);
  EXPECT_TRUE(reader->ended_cleanly());
  ASSERT_EQ(reader->tick_count(), 1234);
  const auto records = reader->ticks(0, 1234);
  ASSERT_TRUE(records) << text_of(records.errors());
  EXPECT_TRUE(*records == lived.records);
  EXPECT_TRUE(reader->check_all());
}

TEST(Session, AnyRangeOfTicksIsTheSameAsThatPartOfTheWhole) {
  const Folder folder;
  const Lived lived = record_session(folder / "a.ctpm", small_start(), 555);
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  for (const auto& [from, to] : {std::pair{0, 0}, {0, 1}, {99, 101}, {100, 200}, {37, 555}, {554, 555}, {555, 555}}) {
    const auto records = reader->ticks(from, to);
    ASSERT_TRUE(records);
    EXPECT_TRUE(std::equal(records->begin(), records->end(), lived.records.begin() + from, lived.records.begin() + to))
        << from;
  }
  for (const auto& [from, to] : {std::pair{-1, 1}, {5, 4}, {0, 556}}) EXPECT_FALSE(reader->ticks(from, to));
}

TEST(Session, KeyframesHoldTheStateBeforeTheirTick) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  std::vector<State> states{start.initial_state};
  auto writer =
      recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true, .keyframe_ticks = 100});
  ASSERT_TRUE(writer);
  live(start, 450, [&](const State& after, const recordings::TickRecord& record) {
    states.push_back(after);
    writer->append(after, record);
    if (record.state_hash % 8 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  const auto statistics = writer->finish();
  ASSERT_TRUE(statistics) << text_of(statistics.errors());
  EXPECT_EQ(statistics->keyframes, 4);

  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  EXPECT_EQ(*reader->keyframe_ticks(), (std::vector<std::int64_t>{0, 100, 200, 300, 400}));
  for (const std::int64_t tick : {0, 1, 99, 100, 101, 250, 399, 400, 450}) {
    const auto keyframe = reader->keyframe_at_or_before(tick);
    ASSERT_TRUE(keyframe) << text_of(keyframe.errors());
    EXPECT_EQ(keyframe->tick, tick / 100 * 100);
    EXPECT_TRUE(bytes_of(keyframe->state) == bytes_of(states[keyframe->tick])) << tick;
  }
}

/// An event with all fields set.
recordings::Event full_event(std::int32_t kind) {
  recordings::Event event;
  event.kind = static_cast<recordings::EventKind>(kind);
  event.tick = 3, event.tool = 1, event.severed = 4, event.organ = 0, event.pieces = 2, event.status = 3;
  event.depth = 0.01, event.depth_limit = 0.008, event.force = 1.5, event.force_limit = 1.25, event.late = 1e-3;
  event.parts = {1e-3, 2e-3, 3e-3, 4e-3, 5e-3};
  event.reason = "it hung up", event.held = 0.4, event.refused_samples = 7, event.sphere = 5;
  event.cells = 6;
  return event;
}

TEST(Session, AnEventStoresTheFieldsOfItsKindAndNoOthers) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  live(start, 5, [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  constexpr std::int32_t kUnknown = 40, kLast = 14;
  for (std::int32_t kind = 1; kind <= kLast; ++kind) writer->event(full_event(kind));
  writer->event(full_event(kUnknown));
  ASSERT_TRUE(writer->finish());

  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto events = reader->events();
  ASSERT_TRUE(events) << text_of(events.errors());
  ASSERT_EQ(events->size(), 15u);
  std::set<std::string> sentences;
  for (std::int32_t kind = 1; kind <= kLast; ++kind) {
    const recordings::Event& event = (*events)[static_cast<std::size_t>(kind - 1)];
    recordings::Event expected{.tick = 3, .kind = static_cast<recordings::EventKind>(kind)};
    const recordings::Event full = full_event(kind);
    switch (expected.kind) {
      case recordings::EventKind::contact_begins:
      case recordings::EventKind::contact_ends:
        expected.tool = full.tool;
        break;
      case recordings::EventKind::cut:
        expected.tool = full.tool, expected.severed = full.severed;
        break;
      case recordings::EventKind::damage:
        expected.organ = full.organ, expected.depth = full.depth, expected.depth_limit = full.depth_limit;
        expected.force = full.force, expected.force_limit = full.force_limit;
        break;
      case recordings::EventKind::late_tick:
        expected.late = full.late, expected.parts = full.parts;
        break;
      case recordings::EventKind::turned_inside_out:
      case recordings::EventKind::came_back:
        expected.cells = full.cells;
        break;
      case recordings::EventKind::device_lost:
        expected.reason = full.reason;
        break;
      case recordings::EventKind::device_back:
        expected.held = full.held, expected.refused_samples = full.refused_samples;
        break;
      case recordings::EventKind::note:
        break;
      case recordings::EventKind::piece_came_loose:
        expected.pieces = full.pieces;
        break;
      case recordings::EventKind::press_reached_force:
      case recordings::EventKind::press_gave_up:
        expected.force = full.force;
        break;
      case recordings::EventKind::step_refused:
        expected.status = full.status, expected.sphere = full.sphere;
        break;
    }
    EXPECT_EQ(event, expected) << kind;
    sentences.insert(recordings::describe(event, start.model));
  }
  EXPECT_EQ(sentences.size(), 14u) << "each kind has its own sentence, a note without text none";
  EXPECT_EQ((*events)[14], full_event(kUnknown)) << "a kind that this program does not know keeps every field";
  EXPECT_EQ(recordings::describe((*events)[0], start.model), "scalpel touches the tissue");
  EXPECT_EQ(recordings::describe({.kind = recordings::EventKind::cut, .tool = 99}, start.model),
            "tool 99 begins to sever; elements in the first tick: 0")
      << "a hostile index is only a number";
}

TEST(Session, EventsAndStatisticsComeBack) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  std::vector<recordings::Event> given;
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  const Lived lived = live(start, 1000, [&](const State& after, const recordings::TickRecord& record) {
    writer->append(after, record);
    if (after.tick % 10 != 0) return;
    if (after.tick % 20 == 0)
      given.push_back({.tick = after.tick - 1, .kind = recordings::EventKind::late_tick, .late = 1.5e-3});
    else
      given.push_back({.tick = after.tick - 1, .kind = recordings::EventKind::contact_begins, .tool = 1});
    writer->event(given.back());
  });
  const auto written = writer->finish({{"input_age_p99_s", 0.25}});
  ASSERT_TRUE(written);

  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto events = reader->events();
  ASSERT_TRUE(events) << text_of(events.errors());
  EXPECT_EQ(*events, given);
  const auto statistics = reader->statistics();
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->ticks, 1000);
  EXPECT_EQ(statistics->events, 100);
  EXPECT_EQ(statistics->late_ticks, 50);
  EXPECT_EQ(statistics->values, (std::vector<recordings::NamedValue>{{"input_age_p99_s", 0.25}}));

  // Percentiles by nearest rank, computed here by sorting.
  std::vector<double> times;
  double max_force = 0, max_depth = 0;
  std::int64_t severed = 0;
  for (const recordings::TickRecord& record : lived.records) {
    times.push_back(record.tick_time);
    max_force = std::max(max_force, norm(record.tool_force));
    max_depth = std::max(max_depth, record.depth);
    severed += record.severed;
  }
  std::sort(times.begin(), times.end());
  const double float_step = 1e-7;  // times are kept in single precision for the percentiles
  EXPECT_NEAR(statistics->tick_time_p50, times[499], float_step * times[499]);
  EXPECT_NEAR(statistics->tick_time_p99, times[989], float_step * times[989]);
  EXPECT_NEAR(statistics->tick_time_p999, times[998], float_step * times[998]);
  EXPECT_EQ(statistics->tick_time_max, times[999]);
  EXPECT_EQ(statistics->max_force, max_force);
  EXPECT_EQ(statistics->max_depth, max_depth);
  EXPECT_EQ(statistics->severed, severed);
  EXPECT_GT(severed, 0);
  EXPECT_GT(max_force, 0);
}

TEST(Session, EveryBitPatternOfARecordSurvives) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  const double strange[] = {
      0.0, -0.0, std::nan("7"), -std::nan("1"), std::numeric_limits<double>::infinity(), 5e-324, -1.7e308, 1.0};
  std::vector<recordings::TickRecord> given;
  Noise noise;
  for (int i = 0; i < 777; ++i) {
    recordings::TickRecord record;
    record.inputs.tool = i % 5 == 0 ? std::numeric_limits<std::int32_t>::min() : i % 3 - 1;
    record.inputs.position = {strange[i % 8], noise.next(), strange[(i / 8) % 8]};
    record.inputs.world_from_tool = {noise.next(), strange[(i / 3) % 8], 0, 1e-310};
    record.inputs.buttons = i % 7 == 0 ? 0xffffffffu : 0;
    record.tool_force = {strange[(i / 5) % 8], 0, -1};
    record.depth = strange[(i + 3) % 8];
    record.status = -i, record.iterations = i * i, record.contacts = 3, record.severed = i % 2;
    record.tick_time = 1e-9 * (i * 7919 % 1000003);
    record.input_age = 1e-9 * (i * 104729 % 1000003);
    record.state_hash = 0x9e3779b97f4a7c15ull * static_cast<std::uint64_t>(i);
    given.push_back(record);
  }
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  for (const recordings::TickRecord& record : given) writer->append(start.initial_state, record);
  ASSERT_TRUE(writer->finish());
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto got = reader->ticks(0, 777);
  ASSERT_TRUE(got);
  for (int i = 0; i < 777; ++i) {
    EXPECT_EQ(std::memcmp(&given[i].inputs.position, &(*got)[i].inputs.position, sizeof(Vec3)), 0) << i;
    EXPECT_EQ(std::memcmp(&given[i].inputs.world_from_tool, &(*got)[i].inputs.world_from_tool, sizeof(Quat)), 0) << i;
    EXPECT_EQ(std::memcmp(&given[i].tool_force, &(*got)[i].tool_force, sizeof(Vec3)), 0) << i;
    EXPECT_EQ(std::memcmp(&given[i].depth, &(*got)[i].depth, sizeof(double)), 0) << i;
    EXPECT_EQ(given[i].inputs.tool, (*got)[i].inputs.tool);
    EXPECT_EQ(given[i].inputs.buttons, (*got)[i].inputs.buttons);
    EXPECT_EQ(given[i].status, (*got)[i].status);
    EXPECT_EQ(given[i].iterations, (*got)[i].iterations);
    EXPECT_EQ(given[i].state_hash, (*got)[i].state_hash);
    EXPECT_DOUBLE_EQ(given[i].tick_time, (*got)[i].tick_time);
    EXPECT_DOUBLE_EQ(given[i].input_age, (*got)[i].input_age);
  }
  const auto statistics = reader->statistics();
  ASSERT_TRUE(statistics);
  std::vector<double> ages;
  for (const recordings::TickRecord& record : given)
    if (record.input_age > 0) ages.push_back(record.input_age);
  std::sort(ages.begin(), ages.end());
  const double float_step = 1e-7;  // ages are kept in single precision for the percentiles
  EXPECT_NEAR(statistics->input_age_p50, ages[387], float_step * ages[387]);
  EXPECT_NEAR(statistics->input_age_p99, ages[768], float_step * ages[768]);
  EXPECT_EQ(statistics->input_age_max, ages.back());
}

TEST(Session, AFileFromBeforeInputsHadAnAgeIsReadWhole) {
  // 0.3 s of a block and a ball, recorded before the column `input_age_ns` and the fields `input_age_...` were added.
  const Folder folder;
  std::filesystem::copy(CTPM_SOURCE_DIR "/tests/recordings/old/v1-without-input-age.ctpm", folder / "a.ctpm");
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_TRUE(reader->ended_cleanly());
  EXPECT_TRUE(reader->check_all());
  const auto ticks = reader->ticks(0, 300);
  ASSERT_TRUE(ticks) << text_of(ticks.errors());
  for (const recordings::TickRecord& record : *ticks) {
    EXPECT_EQ(record.input_age, 0);
    EXPECT_GT(record.tick_time, 0);
    EXPECT_NE(record.state_hash, 0u);
  }
  const auto statistics = reader->statistics();
  ASSERT_TRUE(statistics) << text_of(statistics.errors());
  EXPECT_EQ(statistics->ticks, 300);
  EXPECT_EQ(statistics->input_age_max, 0);
}

TEST(Session, ACleanEndLeavesOneFile) {
  const Folder folder;
  record_session(folder / "a.ctpm", small_start(), 300);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ctpm"});
  ASSERT_TRUE(recordings::SessionReader::open(folder / "a.ctpm"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ctpm"}) << "reading leaves nothing behind";
}

TEST(Session, ATickIsSavedWithin200MsThoughNoOtherFollows) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start);
  ASSERT_TRUE(writer);
  for (int i = 0; i < 7; ++i) writer->append(start.initial_state, {});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(200);
  while (writer->status().committed < 7 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(writer->status().committed, 7);

  // Another program can read the session during recording.
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_EQ(reader->tick_count(), 7);
  EXPECT_FALSE(reader->ended_cleanly());
}

TEST(Session, ASessionThatIsDroppedIsSavedButHasNoEnd) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  Lived lived;
  {
    auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
    ASSERT_TRUE(writer);
    lived = live(start, 333,
                 [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  }
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_FALSE(reader->ended_cleanly());
  ASSERT_EQ(reader->tick_count(), 333);
  EXPECT_TRUE(*reader->ticks(0, 333) == lived.records);
  EXPECT_EQ(reader->statistics()->ticks, 333);
}

TEST(Session, AnExistingFileIsKeptUnlessItMayBeReplaced) {
  const Folder folder;
  write_bytes(folder / "a.ctpm", {'o', 'l', 'd'});
  const auto refused = recordings::SessionWriter::create(folder / "a.ctpm", small_start());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.errors()[0].where, folder / "a.ctpm");
  EXPECT_EQ(refused.errors()[0].message, "exists already");
  EXPECT_EQ(read_bytes(folder / "a.ctpm"), (std::vector<char>{'o', 'l', 'd'}));
  EXPECT_EQ(folder.names().size(), 1u);

  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", small_start(), {.overwrite = true});
  ASSERT_TRUE(writer) << text_of(writer.errors());
  ASSERT_TRUE(writer->finish());
  EXPECT_TRUE(recordings::SessionReader::open(folder / "a.ctpm"));
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(Session, AnErrorAtCreationLeavesNothingBehind) {
  const Folder folder;
  const auto missing = recordings::SessionWriter::create(folder / "no/a.ctpm", small_start());
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.errors()[0].message.find("does not exist"), std::string::npos);
  EXPECT_EQ(missing.errors()[0].where, folder / "no/a.ctpm");
  EXPECT_TRUE(folder.names().empty());

  recordings::SessionStart broken = small_start();
  broken.model.axial.a[3] = 27;
  broken.initial_state.velocity.x.pop_back();
  const auto refused = recordings::SessionWriter::create(folder / "a.ctpm", broken);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.errors()[0].message, "axial.a[3] is 27, must be in [0, 27)");
  EXPECT_TRUE(folder.names().empty());

  // Divisors of the blade's force law, and values that must not push outwards.
  broken = small_start();
  broken.model.tools.at(0).blade_thickness = 0, broken.model.contact_damping = -1;
  const auto unlawful = recordings::SessionWriter::create(folder / "a.ctpm", broken);
  ASSERT_FALSE(unlawful);
  ASSERT_EQ(unlawful.errors().size(), 2u);
  EXPECT_EQ(unlawful.errors()[0].message, "tools[0].blade_thickness must be in [1e-09, 1000]");
  EXPECT_EQ(unlawful.errors()[1].message, "contact_damping must be in [0, 1e+18]");

  EXPECT_FALSE(recordings::SessionWriter::create(folder.path(), small_start()));
  EXPECT_FALSE(recordings::SessionWriter::create("/proc/a.ctpm", small_start()));
  EXPECT_FALSE(recordings::SessionWriter::create("", small_start()));
}

TEST(Session, ALeftOverLogIsNotTakenForItsOwn) {
  const Folder folder;
  write_bytes(folder / "a.ctpm-wal", {'l', 'o', 'g'});
  const auto refused = recordings::SessionWriter::create(folder / "a.ctpm", small_start());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.errors()[0].where, folder / "a.ctpm-wal");
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(StateHash, DependsOnEveryFieldAndEveryBit) {
  recordings::SessionStart start = small_start();
  State state = start.initial_state;
  const std::uint64_t before = recordings::state_hash(state);
  EXPECT_EQ(recordings::state_hash(state), before);
  int fields = 0;
  for_each_field(state, [&](std::string_view name, auto& member) {
    using T = std::decay_t<decltype(member)>;
    const auto flip = [&](void* byte) { *static_cast<unsigned char*>(byte) ^= 1; };
    if constexpr (requires { member.push_back({}); }) {
      if (!member.empty()) {
        flip(&member.back());
        EXPECT_NE(recordings::state_hash(state), before) << name;
        flip(&member.back());
      }
      member.push_back({});
      EXPECT_NE(recordings::state_hash(state), before) << name << " with one more";
      member.pop_back();
    } else {
      flip(reinterpret_cast<char*>(&member) + sizeof(T) - 1);
      EXPECT_NE(recordings::state_hash(state), before) << name;
      flip(reinterpret_cast<char*>(&member) + sizeof(T) - 1);
    }
    ++fields;
  });
  EXPECT_EQ(fields, 42);
  EXPECT_EQ(recordings::state_hash(state), before);
}

TEST(StateHash, TellsWhereOneArrayEndsAndTheNextBegins) {
  State a, b;
  a.position.x = {1, 0}, a.position.y = {2};
  b.position.x = {1}, b.position.y = {0, 2};
  EXPECT_NE(recordings::state_hash(a), recordings::state_hash(b));
}

TEST(StateHash, IsWhatTheFormatSays) {
  // XXH3-64 of the 160 bytes of FORMAT.md section 5, written by another program.
  EXPECT_EQ(recordings::state_hash(State{}), 0x518046858ef5aa7cull);
  // Likewise the 202 bytes with elements of which the last two have internal variables: two arrays of each kind.
  State cut;
  cut.kelvin_elongation = {0.25, -0.5};
  cut.axial_severed = {1, 0, 1, 1, 0}, cut.axial_crossing = {7, 0, 9, 200, 0};
  EXPECT_EQ(recordings::state_hash(cut), 0x598f9dbf6d0f5425ull);
}

TEST(StateHash, TellsWithAndWithoutAnInternalVariableApart) {
  State a, b;
  a.kelvin_elongation = {0}, a.axial_severed = {1, 0, 0};
  b.kelvin_elongation = {0, 0}, b.axial_severed = {1, 0, 0};
  EXPECT_NE(recordings::state_hash(a), recordings::state_hash(b));
}

}  // namespace
}  // namespace ctpm
