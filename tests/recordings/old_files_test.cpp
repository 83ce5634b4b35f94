// Files of each released version are kept in old/ and stay readable.

#include <algorithm>

#include "recordings/replay.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

const std::string kOld = CTPM_SOURCE_DIR "/tests/recordings/old";

/// Copies an old file to a writable folder, because SQLite may create files beside it.
std::string copy_of(const std::string& name, const Folder& folder) {
  std::filesystem::copy(kOld + "/" + name, folder / name);
  return folder / name;
}

/// The distance between the cells of two joined spheres equals their rest distance, in spacings.
void expect_cells_of_neighbours(const Model& model) {
  ASSERT_FALSE(model.organs.empty());
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const auto a = std::size_t(model.axial.a[e]), b = std::size_t(model.axial.b[e]);
    const LatticeCell p = model.cell[a], q = model.cell[b];
    const Vec3 cells{double(q[0] - p[0]), double(q[1] - p[1]), double(q[2] - p[2])};
    const double distance = norm(model.rest_position[b] - model.rest_position[a]);
    EXPECT_NEAR(norm(cells) * model.organs[0].spacing, distance, 1e-9) << "element " << e;
  }
}

TEST(OldFiles, EachOpensAndGivesAllThatItHolds) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kOld)) {
    if (entry.path().extension() != ".ctpm") continue;
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    const Folder folder;
    auto reader = recordings::SessionReader::open(copy_of(name, folder));
    ASSERT_TRUE(reader) << text_of(reader.errors());
    EXPECT_EQ("v" + std::to_string(reader->format_version()), name.substr(0, name.find_first_of("-.")));
    EXPECT_TRUE(reader->ended_cleanly());
    const auto whole = reader->check_all();
    EXPECT_TRUE(whole) << text_of(whole.errors());
    EXPECT_FALSE(reader->start().scene_text.empty());
    EXPECT_GT(reader->start().model.sphere_count(), 0u);
    const auto ticks = reader->ticks(0, reader->tick_count());
    ASSERT_TRUE(ticks) << text_of(ticks.errors());
    const auto keyframes = reader->keyframe_ticks();
    ASSERT_TRUE(keyframes) << text_of(keyframes.errors());
    for (const std::int64_t tick : *keyframes) {
      const auto keyframe = reader->keyframe_at_or_before(tick);
      ASSERT_TRUE(keyframe) << text_of(keyframe.errors());
      // The hash stored by the recording program.
      if (tick == 0) continue;
      EXPECT_EQ(recordings::state_hash(keyframe->state), (*ticks)[std::size_t(tick - 1)].state_hash) << tick;
    }
    expect_cells_of_neighbours(reader->start().model);
    EXPECT_EQ(reader->start().model.tissue_cells.size(), 0u) << "no program of that time resisted inversion";
    EXPECT_TRUE(reader->events());
    EXPECT_TRUE(reader->statistics());
    EXPECT_EQ(reader->start().physics_revision, 0) << "recorded before revisions were stored";
    // Replay need not stay bit-equal, but must always run.
    const auto verdict = recordings::verify_session(*reader);
    ASSERT_TRUE(verdict) << text_of(verdict.errors());
    EXPECT_EQ(verdict->ticks_compared, reader->tick_count());
    ++count;
  }
  EXPECT_GE(count, 2);
}

/// Results of the session in v1.ctpm, recorded with record_session(). Never change them.
TEST(OldFiles, AFileOfVersion1GivesWhatWasRecorded) {
  const Folder folder;
  auto reader = recordings::SessionReader::open(copy_of("v1.ctpm", folder));
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_EQ(reader->start().scene_text, "{ \"scene\": \"a block\" }\n");
  EXPECT_EQ(reader->start().metadata.at("user"), "a trainee");
  EXPECT_EQ(reader->start().model.surfaces.at(0).triangle.size(), 4u);
  ASSERT_EQ(reader->tick_count(), 600);
  const auto ticks = reader->ticks(0, 600);
  ASSERT_TRUE(ticks) << text_of(ticks.errors());
  const double top = reader->start().model.rest_position.z.back();
  double most_force = 0;
  std::int64_t severed = 0;
  for (std::size_t i = 0; i < ticks->size(); ++i) {
    const recordings::TickRecord& record = (*ticks)[i];
    EXPECT_EQ(record.inputs.tool, i < 400 ? 0 : 1) << i;
    EXPECT_EQ(record.inputs.buttons, i < 400 ? 0u : 1u) << i;
    if (i >= 400) {
      EXPECT_EQ(record.inputs.position, (Vec3{-0.03 + 2e-4 * double(i - 400), 0.0061, top - 0.01})) << i;
    }
    EXPECT_DOUBLE_EQ(record.tick_time, double(250000 + i % 977) / 1e9) << i;
    most_force = std::max(most_force, norm(record.tool_force)), severed += record.severed;
  }
  const auto statistics = reader->statistics();
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->max_force, most_force);
  EXPECT_EQ(statistics->severed, severed);
  EXPECT_EQ(ticks->front().state_hash, 5300509955314225949u);
  EXPECT_EQ(ticks->back().state_hash, 11516883611922199071u);
  EXPECT_NEAR(most_force, 1.47386, 5e-6);
  EXPECT_EQ(severed, 10);
  const auto events = reader->events();
  ASSERT_TRUE(events);
  EXPECT_EQ(events->size(), 6u);
  EXPECT_EQ(events->front().kind, recordings::EventKind::cut);
  const auto keyframes = reader->keyframe_ticks();
  ASSERT_TRUE(keyframes);
  EXPECT_EQ(*keyframes, (std::vector<std::int64_t>{0, 250, 500}));
}

}  // namespace
}  // namespace ctpm
