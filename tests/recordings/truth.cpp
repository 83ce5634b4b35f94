#include "tests/recordings/truth.h"

#include <algorithm>
#include <fstream>
#include <random>

#include "core/model/fields.h"
#include "recordings/replay.h"

namespace ctpm::testing {
namespace {

/// Hash of a whole Model: the hash of a State that holds all its numbers in one array.
std::uint64_t hash_of(const Model& model) {
  State all;
  const auto add = [&](const auto& self, const auto& value) -> void {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, Vec3>)
      all.kelvin_elongation.insert(all.kelvin_elongation.end(), {value.x, value.y, value.z});
    else if constexpr (std::is_same_v<T, Quat>)
      all.kelvin_elongation.insert(all.kelvin_elongation.end(), {value.w, value.x, value.y, value.z});
    else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
      all.kelvin_elongation.push_back(static_cast<double>(value));
    else if constexpr (requires { value.begin(); })
      for (const auto& item : value) self(self, item);
    else
      for_each_field(value, [&](std::string_view, const auto& member) { self(self, member); });
  };
  add(add, model);
  return recordings::state_hash(all);
}

}  // namespace

Truth truth_of(const std::string& path, const recordings::SessionStart& start, const Lived& lived) {
  Truth truth;
  truth.start = start;
  truth.records = lived.records;
  truth.state_hashes.push_back(recordings::state_hash(start.initial_state));
  for (const recordings::TickRecord& record : lived.records) truth.state_hashes.push_back(record.state_hash);
  truth.model_hash = hash_of(start.model);
  auto reader = recordings::SessionReader::open(path);
  CTPM_CHECK(bool(reader), "the undamaged session opens");
  truth.events = *reader->events();
  return truth;
}

Finding expect_error_or_truth(const std::string& path, const Truth& truth, const std::string& what) {
  Finding finding;
  const auto complain = [&](const Errors& errors) {
    finding.complained = true;
    for (const Error& error : errors) {
      EXPECT_EQ(error.where, path) << what;
      EXPECT_FALSE(error.message.empty()) << what;
    }
  };
  auto reader = recordings::SessionReader::open(path);
  if (!reader) {
    complain(reader.errors());
    return finding;
  }
  finding.opened = true;
  EXPECT_EQ(reader->start().scene_text, truth.start.scene_text) << what;
  EXPECT_EQ(reader->start().look, truth.start.look) << what;
  EXPECT_EQ(reader->start().metadata, truth.start.metadata) << what;
  EXPECT_EQ(reader->start().build_fingerprint, truth.start.build_fingerprint) << what;
  EXPECT_EQ(hash_of(reader->start().model), truth.model_hash) << what;
  EXPECT_EQ(recordings::state_hash(reader->start().initial_state), truth.state_hashes[0]) << what;

  const std::int64_t count = reader->tick_count();
  EXPECT_LE(count, static_cast<std::int64_t>(truth.records.size())) << what;
  if (reader->ended_cleanly()) {
    EXPECT_EQ(count, static_cast<std::int64_t>(truth.records.size())) << what;
  }
  const std::int64_t known = std::min<std::int64_t>(count, truth.records.size());
  for (std::int64_t from = 0; from < known; from += 50) {
    const std::int64_t to = std::min(from + 50, known);
    const auto records = reader->ticks(from, to);
    if (records) {
      EXPECT_TRUE(
          std::equal(records->begin(), records->end(), truth.records.begin() + from, truth.records.begin() + to))
          << what;
    } else {
      complain(records.errors());
    }
    const auto keyframe = reader->keyframe_at_or_before(to);
    if (keyframe) {
      EXPECT_EQ(recordings::state_hash(keyframe->state), truth.state_hashes.at(keyframe->tick)) << what;
    } else {
      complain(keyframe.errors());
    }
  }
  if (const auto events = reader->events(); !events) {
    complain(events.errors());
  } else {
    const std::size_t expected = reader->ended_cleanly() ? truth.events.size() : events->size();
    EXPECT_TRUE(events->size() == expected && expected <= truth.events.size() &&
                std::equal(events->begin(), events->end(), truth.events.begin()))
        << what;
  }
  if (const auto all = reader->check_all(); !all) complain(all.errors());
  return finding;
}

namespace {

bool is_said_same(const std::string& path) {
  auto reader = recordings::SessionReader::open(path);
  const auto verdict = reader ? recordings::verify_session(*reader) : reader.errors();
  return verdict && verdict->same;
}

}  // namespace

void verify_flipped_bits(int count, unsigned seed) {
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  const recordings::SessionStart start = small_start(6, 5, 5);
  const Lived lived = record_session(path, start, 100, 50);
  const Truth truth = truth_of(path, start, lived);
  const std::vector<char> bytes = read_bytes(path);
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::size_t> pick(0, 8 * bytes.size() - 1);
  int found = 0;
  for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
    const std::size_t bit = pick(random);
    std::vector<char> flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write_bytes(path, flipped);
    const std::string what = "bit " + std::to_string(bit);
    const Finding finding = expect_error_or_truth(path, truth, what);
    const bool is_same = is_said_same(path);
    EXPECT_EQ(is_same, !finding.complained) << what;
    found += !is_same;
  }
  std::printf("%d flipped bits: %d found, %d in bytes that nothing uses\n", count, found, count - found);
  EXPECT_GT(found, count / 4);
}

}  // namespace ctpm::testing
