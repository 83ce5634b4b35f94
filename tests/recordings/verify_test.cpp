#include <algorithm>

#include "recordings/recover.h"
#include "recordings/replay.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

TEST(Verify, ASessionThatWasLivedIsTheSame) {
  const Folder folder;
  record_session(folder / "a.ctpm", small_start(), 900);
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  std::int64_t done = 0;
  const auto verdict = recordings::verify_session(*reader, {.progress = [&](std::int64_t d, std::int64_t total) {
    EXPECT_EQ(total, 900);
    EXPECT_GT(d, done);
    done = d;
  }});
  ASSERT_TRUE(verdict) << text_of(verdict.errors());
  EXPECT_TRUE(verdict->same) << recordings::to_string(*verdict);
  EXPECT_EQ(verdict->ticks_compared, 900);
  EXPECT_EQ(verdict->first_tick, -1);
  EXPECT_EQ(done, 900);
}

TEST(Verify, ARangeIsVerifiedFromTheKeyframeBeforeIt) {
  const Folder folder;
  record_session(folder / "a.ctpm", small_start(), 900, 100);
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto verdict = recordings::verify_session(*reader, {.from = 357, .to = 480});
  ASSERT_TRUE(verdict) << text_of(verdict.errors());
  EXPECT_TRUE(verdict->same) << recordings::to_string(*verdict);
  EXPECT_EQ(verdict->ticks_compared, 123);
  EXPECT_FALSE(recordings::verify_session(*reader, {.from = 5, .to = 4}));
  EXPECT_FALSE(recordings::verify_session(*reader, {.from = 0, .to = 901}));
}

TEST(Verify, NamesTheFirstTickTheSphereTheQuantityAndTheSize) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  constexpr std::int64_t wrong_tick = 130;
  constexpr std::int32_t wrong_sphere = 21;
  constexpr double push = 1e-5;  // [m]
  // Push one sphere of the recorded session without recording the push; the replay lacks it.
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start,
                                                  {.wait_when_full = true, .keyframe_ticks = wrong_tick + 1});
  ASSERT_TRUE(writer);
  State state = start.initial_state;
  stepping::Stepper stepper(start.model);
  for (std::int64_t tick = 0; tick < 200; ++tick) {
    const Inputs inputs = scripted_inputs(tick, start.model.rest_position.z.back());
    const stepping::StepReport report = stepper.step(state, inputs);
    if (tick == wrong_tick) state.position.y[wrong_sphere] += push;
    writer->append(state, recordings::make_record(inputs, report, 0, recordings::state_hash(state)));
  }
  ASSERT_TRUE(writer->finish());

  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto verdict = recordings::verify_session(*reader);
  ASSERT_TRUE(verdict) << text_of(verdict.errors());
  EXPECT_FALSE(verdict->same);
  EXPECT_EQ(verdict->first_tick, wrong_tick);
  EXPECT_EQ(verdict->first_quantity, "state_hash");
  EXPECT_EQ(verdict->located_tick, wrong_tick + 1);
  EXPECT_EQ(verdict->quantity, "position.y");
  EXPECT_EQ(verdict->index, wrong_sphere);
  EXPECT_NEAR(verdict->difference, push, 1e-15);
  EXPECT_NEAR(verdict->recorded - verdict->replayed, push, 1e-15);
  EXPECT_EQ(verdict->ticks_compared, 200) << "goes on after a difference";
  EXPECT_EQ(verdict->ticks_different, 1) << "from the keyframe behind it on all is well";
  EXPECT_NE(recordings::to_string(*verdict).find("position.y[21]"), std::string::npos)
      << recordings::to_string(*verdict);
}

TEST(Verify, AForceThatDiffersAloneIsNamed) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  live(start, 150, [&](const State& after, recordings::TickRecord record) {
    if (after.tick == 80) record.tool_force.z += 0.5;
    writer->append(after, record);
  });
  ASSERT_TRUE(writer->finish());
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto verdict = recordings::verify_session(*reader);
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->first_tick, 79);
  EXPECT_EQ(verdict->first_quantity, "tool_force.z");
  EXPECT_EQ(verdict->quantity, "tool_force.z");
  EXPECT_NEAR(verdict->difference, 0.5, 1e-12);
  EXPECT_EQ(verdict->ticks_different, 1);
}

TEST(Verify, AKeyframeThatIsNotItsTicksStateIsAnError) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  auto writer =
      recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true, .keyframe_ticks = 50});
  ASSERT_TRUE(writer);
  live(start, 120, [&](State after, const recordings::TickRecord& record) {
    if (after.tick == 100) after.velocity.x[3] += 1;
    writer->append(after, record);
  });
  ASSERT_TRUE(writer->finish());
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto verdict = recordings::verify_session(*reader);
  ASSERT_FALSE(verdict);
  EXPECT_NE(verdict.errors()[0].message.find("keyframe 100"), std::string::npos);
}

TEST(Verify, NothingComparedIsNoGoodVerdict) {
  const Folder folder;
  record_session(folder / "a.ctpm", small_start(), 0);
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  EXPECT_TRUE(reader->check_all());
  EXPECT_TRUE(reader->ended_cleanly());
  const auto verdict = recordings::verify_session(*reader);
  ASSERT_TRUE(verdict) << text_of(verdict.errors());
  EXPECT_FALSE(verdict->same);
  EXPECT_EQ(verdict->ticks_compared, 0);
  EXPECT_EQ(recordings::to_string(*verdict), "no verdict: there is no tick to compare");
}

TEST(Verify, TheVerdictDoesNotDependOnTheThreads) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  auto writer =
      recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true, .keyframe_ticks = 50});
  ASSERT_TRUE(writer);
  live(start, 620, [&](const State& after, recordings::TickRecord record) {
    if (after.tick == 320 || after.tick == 520) record.depth += 1;
    writer->append(after, record);
  });
  ASSERT_TRUE(writer->finish());
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  for (const int threads : {1, 2, 3, 64}) {
    std::int64_t done = 0;
    const auto verdict = recordings::verify_session(
        *reader, {.from = 7, .threads = threads, .progress = [&](std::int64_t d, std::int64_t) { done = d; }});
    ASSERT_TRUE(verdict) << text_of(verdict.errors());
    EXPECT_EQ(verdict->first_tick, 319);
    EXPECT_EQ(verdict->first_quantity, "depth");
    EXPECT_NEAR(verdict->difference, 1, 1e-12);
    EXPECT_EQ(verdict->ticks_compared, 613);
    EXPECT_EQ(verdict->ticks_different, 2);
    EXPECT_EQ(done, 613);
  }
}

TEST(Replay, ASessionGoesOnFromAMomentOfAnother) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  const Lived parent = record_session(folder / "parent.ctpm", start, 500, 100);
  auto reader = recordings::SessionReader::open(folder / "parent.ctpm");
  ASSERT_TRUE(reader);
  const auto from = recordings::continue_session(*reader, 333);
  ASSERT_TRUE(from) << text_of(from.errors());
  EXPECT_EQ(recordings::state_hash(from->initial_state), parent.records[332].state_hash);

  // Continuing with the same inputs gives the parent's results.
  auto writer = recordings::SessionWriter::create(folder / "child.ctpm", *from, {.wait_when_full = true});
  ASSERT_TRUE(writer) << text_of(writer.errors());
  State state = from->initial_state;
  stepping::Stepper stepper(from->model);
  for (std::size_t tick = 333; tick < 500; ++tick) {
    const stepping::StepReport report = stepper.step(state, parent.records[tick].inputs);
    writer->append(state,
                   recordings::make_record(parent.records[tick].inputs, report, 0, recordings::state_hash(state)));
  }
  EXPECT_EQ(recordings::state_hash(state), recordings::state_hash(parent.last));
  ASSERT_TRUE(writer->finish());
  auto child = recordings::SessionReader::open(folder / "child.ctpm");
  ASSERT_TRUE(child);
  EXPECT_EQ(child->start().metadata.at(recordings::parent_session_key), reader->session_id());
  EXPECT_EQ(child->start().metadata.at(recordings::parent_tick_key), "333");
  EXPECT_NE(child->session_id(), reader->session_id());
  const auto verdict = recordings::verify_session(*child);
  ASSERT_TRUE(verdict);
  EXPECT_TRUE(verdict->same) << recordings::to_string(*verdict);
  EXPECT_FALSE(recordings::continue_session(*reader, 501));
}

TEST(PhysicsRevision, IsThatOfTheRecordingUntilASessionGoesOn) {
  const Folder folder;
  recordings::SessionStart start = small_start();
  start.physics_revision = kPhysicsRevision + 3;
  record_session(folder / "a.ctpm", start, 50);
  ASSERT_TRUE(recordings::recover_session(folder / "a.ctpm", folder / "saved.ctpm"));
  for (const char* name : {"a.ctpm", "saved.ctpm"}) {
    auto reader = recordings::SessionReader::open(folder / name);
    ASSERT_TRUE(reader) << text_of(reader.errors());
    EXPECT_EQ(reader->start().physics_revision, kPhysicsRevision + 3) << name;
    const auto verdict = recordings::verify_session(*reader);
    ASSERT_TRUE(verdict);
    EXPECT_EQ(verdict->physics_revision, kPhysicsRevision + 3);
    const auto further = recordings::continue_session(*reader, 20);
    ASSERT_TRUE(further);
    EXPECT_EQ(further->physics_revision, kPhysicsRevision) << "this build computes what comes after";
  }
}

/// Every revision has one line in the table of FORMAT.md, and every line has a revision.
TEST(PhysicsRevision, EachHasItsLineInTheFormat) {
  std::ifstream in(CTPM_SOURCE_DIR "/recordings/FORMAT.md");
  std::string line;
  std::int32_t last = 0;
  bool is_there = false;
  while (std::getline(in, line)) {
    is_there = is_there || line == "| physics revision | what changed, and why |";
    if (is_there && line.starts_with("| " + std::to_string(last + 1) + " |")) ++last;
  }
  EXPECT_TRUE(is_there);
  EXPECT_EQ(last, kPhysicsRevision);
}

TEST(Replay, SeekingGivesTheSameStateAsWalking) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  std::vector<std::uint64_t> hashes{recordings::state_hash(start.initial_state)};
  auto writer =
      recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true, .keyframe_ticks = 100});
  ASSERT_TRUE(writer);
  live(start, 600, [&](const State& after, const recordings::TickRecord& record) {
    hashes.push_back(record.state_hash);
    writer->append(after, record);
  });
  ASSERT_TRUE(writer->finish());
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  auto cursor = recordings::ReplayCursor::create(*reader);
  ASSERT_TRUE(cursor);
  for (const std::int64_t tick : {350, 351, 20, 600, 0, 100, 99, 599}) {
    ASSERT_TRUE(cursor->seek(tick));
    EXPECT_EQ(cursor->tick(), tick);
    EXPECT_EQ(recordings::state_hash(cursor->state()), hashes[tick]) << tick;
    EXPECT_TRUE(cursor->same_so_far());
  }
  ASSERT_TRUE(cursor->step());
  EXPECT_EQ(cursor->record().state_hash, hashes[600]);
  const auto end = cursor->step();
  ASSERT_TRUE(end);
  EXPECT_FALSE(*end);
  EXPECT_FALSE(cursor->seek(601));
  EXPECT_FALSE(cursor->seek(-1));
}

TEST(Verify, ATickWhoseInputWasRefusedIsReplayedAsSuch) {
  const Folder folder;
  const recordings::SessionStart start = small_start();
  auto writer =
      recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true, .keyframe_ticks = 20});
  ASSERT_TRUE(writer);
  State state = start.initial_state;
  stepping::Stepper stepper(start.model);
  for (int tick = 0; tick < 100; ++tick) {
    Inputs inputs = scripted_inputs(tick, start.model.rest_position.z.back());
    if (tick % 9 == 5) inputs.position.x = std::nan("");
    if (tick % 9 == 7) inputs.tool = 17;
    const stepping::StepReport report = stepper.step(state, inputs);
    EXPECT_EQ(report.status == stepping::StepStatus::bad_input, tick % 9 == 5 || tick % 9 == 7);
    writer->append(state, recordings::make_record(inputs, report, 0, recordings::state_hash(state)));
  }
  ASSERT_TRUE(writer->finish());
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto verdict = recordings::verify_session(*reader);
  ASSERT_TRUE(verdict) << text_of(verdict.errors());
  EXPECT_TRUE(verdict->same) << recordings::to_string(*verdict);
  EXPECT_EQ(verdict->ticks_compared, 100);
}

}  // namespace
}  // namespace ctpm
