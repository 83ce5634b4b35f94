#include <algorithm>
#include <set>

#include "core/model/fields.h"
#include "recordings/recover.h"
#include "recordings/replay.h"
#include "tests/recordings/truth.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

/// One small session with its bytes and true content, made once.
struct Sample {
  Folder folder;
  std::string path = folder / "whole.ctpm";
  Truth truth;
  std::vector<char> bytes;

  Sample() {
    const recordings::SessionStart start = small_start(3, 2, 2);
    const Lived lived = record_session(path, start, 730, 200);
    truth = truth_of(path, start, lived);
    bytes = read_bytes(path);
  }
};
const Sample& sample() {
  static const Sample one;
  return one;
}

TEST(Damage, AFileCutAtAnyLengthIsAnErrorWithItsPlace) {
  const Sample& whole = sample();
  const Folder folder;
  const std::string path = folder / "cut.ctpm";
  std::set<std::size_t> lengths;
  for (std::size_t page = 0; page * 4096 <= whole.bytes.size(); ++page)
    for (const int beside : {-1, 0, 1, 100, 2048})
      lengths.insert(page * 4096 + static_cast<std::size_t>(std::max(beside, 0)) - (beside < 0 && page > 0));
  for (std::size_t length = 0; length < 200; ++length) lengths.insert(length);
  for (const std::size_t length : lengths) {
    if (length >= whole.bytes.size()) continue;
    write_bytes(path, {whole.bytes.begin(), whole.bytes.begin() + static_cast<std::ptrdiff_t>(length)});
    const Finding finding = expect_error_or_truth(path, whole.truth, "length " + std::to_string(length));
    EXPECT_FALSE(finding.opened) << "length " << length;
  }
}

/// Offsets that are certainly payload: the heads of all compressed frames.
std::set<std::size_t> frame_heads(const std::vector<char>& bytes) {
  static constexpr char magic[] = {'\x28', '\xb5', '\x2f', '\xfd'};
  std::set<std::size_t> places;
  for (auto at = bytes.begin(); (at = std::search(at, bytes.end(), magic, magic + 4)) != bytes.end(); ++at)
    for (std::size_t i = 0; i < 12; ++i) places.insert(static_cast<std::size_t>(at - bytes.begin()) + i);
  return places;
}

/// Flips one bit at each offset, one at a time.
void flip_each(const std::set<std::size_t>& places, bool must_be_found) {
  const Sample& whole = sample();
  const Folder folder;
  const std::string path = folder / "flipped.ctpm";
  write_bytes(path, whole.bytes);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const auto put = [&](std::size_t place, char byte) {
    file.seekp(static_cast<std::streamoff>(place));
    file.put(byte);
    file.flush();
  };
  for (const std::size_t place : places) {
    const int bit = static_cast<int>(place * 5 % 8);
    put(place, static_cast<char>(whole.bytes[place] ^ (1 << bit)));
    const Finding finding =
        expect_error_or_truth(path, whole.truth, "byte " + std::to_string(place) + " bit " + std::to_string(bit));
    EXPECT_TRUE(finding.complained || !must_be_found) << "byte " << place;
    put(place, whole.bytes[place]);
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_FALSE(expect_error_or_truth(path, whole.truth, "mended").complained);
}

TEST(Damage, AFlippedBitAnywhereIsFoundOrWithoutEffect) {
  std::set<std::size_t> places;
  for (std::size_t place = 0; place < sample().bytes.size(); place += 7) places.insert(place);
  flip_each(places, false);
}

TEST(Damage, VerifyingAfterAHundredFlippedBitsIsNeverWrong) { verify_flipped_bits(100, 1); }

TEST(Damage, AFlippedBitInAnyBlockIsFound) {
  const std::set<std::size_t> places = frame_heads(sample().bytes);
  EXPECT_GE(places.size(), 12u * (7 + 8 + 3 + 1));  // parts, chunks, keyframes, end
  flip_each(places, true);
}

/// Writes the file with one byte changed, at the first offset where check_all() then reports `message`. Returns all its
/// errors; empty if there is no such offset.
std::string damage_until(const std::string& path, const std::vector<char>& bytes, const std::string& message) {
  for (std::size_t place = 4096; place < bytes.size(); place += 61) {
    std::vector<char> damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
    write_bytes(path, damaged);
    auto reader = recordings::SessionReader::open(path);
    if (!reader) continue;
    const auto all = reader->check_all();
    if (!all && text_of(all.errors()).find(message) != std::string::npos) return text_of(all.errors());
  }
  return "";
}

TEST(Damage, ADamagedChunkIsNamedByItsTicks) {
  const Sample& whole = sample();
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  ASSERT_NE(damage_until(path, whole.bytes, "chunk 300 100: the checksum does not match"), "");
  auto reader = recordings::SessionReader::open(path);
  ASSERT_TRUE(reader);
  EXPECT_TRUE(reader->ticks(0, 300)) << "what is before it can be read";
  EXPECT_TRUE(reader->ticks(400, 730)) << "what is behind it can be read";
  const auto lost = reader->ticks(250, 350);
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.errors()[0].message.find("chunk 300 100"), std::string::npos);
  EXPECT_FALSE(recordings::verify_session(*reader)) << "a replay cannot step over it";
}

TEST(Damage, ADamagedKeyframeCostsTimeButNotTheReplay) {
  const Sample& whole = sample();
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  ASSERT_NE(damage_until(path, whole.bytes, "keyframe 400: the checksum does not match"), "");
  auto reader = recordings::SessionReader::open(path);
  ASSERT_TRUE(reader);
  auto cursor = recordings::ReplayCursor::create(*reader);
  ASSERT_TRUE(cursor);
  ASSERT_TRUE(cursor->seek(450));
  EXPECT_EQ(recordings::state_hash(cursor->state()), whole.truth.state_hashes[450]);
}

TEST(Damage, WhatIsNotASessionIsSaidPlainly) {
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  const auto message = [&] {
    const auto reader = recordings::SessionReader::open(path);
    EXPECT_FALSE(reader);
    return reader ? "" : to_string(reader.errors()[0]);
  };
  EXPECT_EQ(message(), path + ": error: does not exist");
  write_bytes(path, {});
  EXPECT_EQ(message(), path + ": error: is not a session file: it is empty");
  write_bytes(path, std::vector<char>(5000, 'v'));
  EXPECT_EQ(message(),
            path + ": error: is not a session file: it does not begin like one (if it was one, try to recover it)");
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_EQ(message(), path + ": error: is not a session file: it is not a regular file");
  std::filesystem::remove(path);

  // Another SQLite database has other numbers in the header.
  std::vector<char> other = sample().bytes;
  other[71] = 'X';
  write_bytes(path, other);
  EXPECT_EQ(message(), path + ": error: is not a session file: it is another SQLite database");
}

TEST(Damage, ANewerVersionIsRefusedWithBothNumbers) {
  const Folder folder;
  std::vector<char> newer = sample().bytes;
  newer[63] = 9;  // the last byte of user_version
  write_bytes(folder / "a.ctpm", newer);
  const auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.errors()[0].message, "is of format version 9, this program reads up to 1");
  // It may be damaged: what can be read is saved, and how it was read is said.
  const auto saved = recordings::recover_session(folder / "a.ctpm", folder / "b.ctpm");
  ASSERT_TRUE(saved);
  ASSERT_EQ(saved->repairs.size(), 1u);
  EXPECT_EQ(saved->repairs[0],
            "its header says that it is of format version 9, which this program does not know; it is read as of "
            "version 1");
}

TEST(Damage, APowerCutInTheLogLosesOnlyTheEnd) {
  const Folder folder;
  const recordings::SessionStart start = small_start(3, 2, 2);
  auto writer =
      recordings::SessionWriter::create(folder / "live.ctpm", start, {.wait_when_full = true, .keyframe_ticks = 200});
  ASSERT_TRUE(writer);
  const Lived lived = live(start, 600, [&](const State& after, const recordings::TickRecord& record) {
    writer->append(after, record);
    if (after.tick % 60 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  });
  while (writer->status().committed < 600) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::vector<char> file = read_bytes(folder / "live.ctpm"), log = read_bytes(folder / "live.ctpm-wal");
  Truth truth = truth_of(folder / "live.ctpm", start, lived);

  const std::string path = folder / "cut.ctpm";
  std::set<std::int64_t> counts;
  std::set<std::size_t> lengths{log.size()};
  for (std::size_t length = 0; length < log.size(); length += 1009) lengths.insert(length);
  for (const std::size_t length : lengths) {
    std::filesystem::remove(path + "-shm");
    write_bytes(path, file);
    write_bytes(path + "-wal", {log.begin(), log.begin() + static_cast<std::ptrdiff_t>(length)});
    const Finding finding = expect_error_or_truth(path, truth, "log of " + std::to_string(length));
    EXPECT_FALSE(finding.complained) << "log of " << length;
    counts.insert(recordings::SessionReader::open(path)->tick_count());
  }
  EXPECT_GE(counts.size(), 3u) << "shorter logs hold fewer ticks";
  EXPECT_EQ(*counts.begin(), 0);
  EXPECT_EQ(*counts.rbegin(), 600);
}

TEST(Damage, ALogOfAnotherSessionIsNotMixedIn) {
  const Folder folder;
  const recordings::SessionStart start = small_start(3, 2, 2);
  std::vector<char> files[2], logs[2];
  Truth truth;
  for (int i = 0; i < 2; ++i) {
    auto writer = recordings::SessionWriter::create(folder / std::to_string(i), start, {.wait_when_full = true});
    ASSERT_TRUE(writer);
    const Lived lived = live(
        start, 300, [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
    while (writer->status().committed < 300) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    files[i] = read_bytes(folder / std::to_string(i)), logs[i] = read_bytes(folder / (std::to_string(i) + "-wal"));
    if (i == 0) truth = truth_of(folder / "0", start, lived);
  }
  write_bytes(folder / "a.ctpm", files[0]);
  write_bytes(folder / "a.ctpm-wal", logs[1]);
  EXPECT_TRUE(expect_error_or_truth(folder / "a.ctpm", truth, "mixed").complained);
}

TEST(Recover, AWholeSessionComesBackWhole) {
  const Sample& whole = sample();
  const Folder folder;
  const auto report = recordings::recover_session(whole.path, folder / "out.ctpm");
  ASSERT_TRUE(report) << text_of(report.errors());
  EXPECT_TRUE(report->complete);
  EXPECT_TRUE(report->losses.empty());
  EXPECT_EQ(report->ticks_saved, 730);
  EXPECT_EQ(report->keyframes_saved, 3);
  EXPECT_TRUE(report->verdict.same);
  EXPECT_EQ(report->verdict.ticks_compared, 730);
  auto reader = recordings::SessionReader::open(folder / "out.ctpm");
  ASSERT_TRUE(reader);
  EXPECT_TRUE(reader->ended_cleanly());
  EXPECT_TRUE(*reader->ticks(0, 730) == whole.truth.records);
  EXPECT_TRUE(*reader->events() == whole.truth.events);
}

TEST(Recover, ADamagedChunkIsNamedAndWhatIsBeforeItSaved) {
  const Sample& whole = sample();
  const Folder folder;
  ASSERT_NE(damage_until(folder / "a.ctpm", whole.bytes, "chunk 300 100: the checksum does not match"), "");
  const auto report = recordings::recover_session(folder / "a.ctpm", folder / "out.ctpm");
  ASSERT_TRUE(report) << text_of(report.errors());
  EXPECT_FALSE(report->complete);
  EXPECT_EQ(report->ticks_saved, 300);
  EXPECT_EQ(report->ticks_dropped, 330);
  ASSERT_FALSE(report->losses.empty());
  EXPECT_NE(report->losses[0].find("chunk 300 100"), std::string::npos);
  EXPECT_TRUE(report->verdict.same);
  EXPECT_EQ(report->verdict.ticks_compared, 300);
  auto reader = recordings::SessionReader::open(folder / "out.ctpm");
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->ended_cleanly());
  ASSERT_EQ(reader->tick_count(), 300);
  EXPECT_TRUE(
      std::equal(whole.truth.records.begin(), whole.truth.records.begin() + 300, reader->ticks(0, 300)->begin()));
}

TEST(Recover, AFileCutShortGivesItsBeginning) {
  const Sample& whole = sample();
  const Folder folder;
  std::int64_t most = 0;
  for (const int percent : {40, 60, 70, 80, 90, 97}) {
    const std::string path = folder / (std::to_string(percent) + ".ctpm");
    write_bytes(path, {whole.bytes.begin(),
                       whole.bytes.begin() + static_cast<std::ptrdiff_t>(whole.bytes.size() * percent / 100)});
    EXPECT_FALSE(recordings::SessionReader::open(path));
    const auto report = recordings::recover_session(path, folder / "out.ctpm");
    if (!report) {
      EXPECT_FALSE(std::filesystem::exists(folder / "out.ctpm"));
      continue;
    }
    EXPECT_FALSE(report->complete);
    EXPECT_FALSE(report->losses.empty());
    EXPECT_TRUE(report->verdict.same);
    EXPECT_GE(report->ticks_saved, most) << "a longer rest holds no less";
    most = report->ticks_saved;
    std::filesystem::remove(folder / "out.ctpm");
  }
  EXPECT_GE(most, 300);
  EXPECT_LE(most, 730);
}

TEST(Recover, ALostHeaderAndListOfTablesCostNothing) {
  const Sample& whole = sample();
  const Folder folder;
  for (const std::size_t lost : {16, 100, 1000, 4096}) {
    std::vector<char> damaged = whole.bytes;
    std::fill(damaged.begin(), damaged.begin() + static_cast<std::ptrdiff_t>(lost), '\x55');
    write_bytes(folder / "a.ctpm", damaged);
    EXPECT_FALSE(recordings::SessionReader::open(folder / "a.ctpm"));
    const auto report = recordings::recover_session(folder / "a.ctpm", folder / "out.ctpm");
    ASSERT_TRUE(report) << text_of(report.errors());
    EXPECT_TRUE(report->complete);
    ASSERT_EQ(report->repairs.size(), 1u);
    EXPECT_NE(report->repairs[0].find("put together anew"), std::string::npos);
    EXPECT_EQ(report->ticks_saved, 730);
    EXPECT_TRUE(report->verdict.same);
    EXPECT_EQ(folder.names().size(), 2u) << "nothing else is left";
    std::filesystem::remove(folder / "out.ctpm");
  }
}

TEST(Recover, WhatAKilledRecorderLeftInTheLogIsFoundWithoutTheHeader) {
  const Folder folder;
  const recordings::SessionStart start = small_start(3, 2, 2);
  auto writer = recordings::SessionWriter::create(folder / "live.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  const Lived lived = live(
      start, 300, [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  while (writer->status().committed < 300) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::vector<char> file = read_bytes(folder / "live.ctpm"), log = read_bytes(folder / "live.ctpm-wal");
  std::fill_n(file.begin(), 4096, '\x55');
  // A page behind the frames of an earlier, longer log is not of this one.
  log.insert(log.end(), 24 + 4096, '\x55');
  write_bytes(folder / "a.ctpm", file), write_bytes(folder / "a.ctpm-wal", log);
  const auto report = recordings::recover_session(folder / "a.ctpm", folder / "out.ctpm");
  ASSERT_TRUE(report) << text_of(report.errors());
  EXPECT_EQ(report->ticks_saved, 300);
  EXPECT_TRUE(report->verdict.same);
  EXPECT_FALSE(report->complete) << "it has no end";
}

TEST(Recover, AnyDamagedPageGivesATrueBeginningOrAnError) {
  const Sample& whole = sample();
  const Folder folder;
  int recovered = 0, complete = 0;
  for (std::size_t page = 1; page * 4096 < whole.bytes.size(); ++page) {
    std::vector<char> damaged = whole.bytes;
    std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(page * 4096), 4096, '\0');
    write_bytes(folder / "a.ctpm", damaged);
    const auto report = recordings::recover_session(folder / "a.ctpm", folder / "out.ctpm");
    if (!report) {
      EXPECT_FALSE(std::filesystem::exists(folder / "out.ctpm"));
      continue;
    }
    ++recovered;
    // Pages that only lead to others cost nothing.
    EXPECT_EQ(report->complete, report->losses.empty()) << "page " << page;
    EXPECT_TRUE(!report->complete || report->ticks_saved == 730) << "page " << page;
    complete += report->complete;
    EXPECT_EQ(report->verdict.same, report->ticks_saved > 0) << "page " << page;
    auto reader = recordings::SessionReader::open(folder / "out.ctpm");
    ASSERT_TRUE(reader);
    ASSERT_EQ(reader->tick_count(), report->ticks_saved);
    const auto records = reader->ticks(0, report->ticks_saved);
    ASSERT_TRUE(records);
    EXPECT_TRUE(std::equal(records->begin(), records->end(), whole.truth.records.begin())) << "page " << page;
    std::filesystem::remove(folder / "out.ctpm");
  }
  std::printf("%d of %zu pages cost a part of the session, %d nothing\n", recovered - complete,
              whole.bytes.size() / 4096 - 1, complete);
  EXPECT_GE(recovered, 4);
  EXPECT_GE(complete, 2) << "the inner pages of the tables of parts and chunks";
}

TEST(Recover, RefusesToReplaceAFileAndWhatCannotBeReplayed) {
  const Sample& whole = sample();
  const Folder folder;
  write_bytes(folder / "out.ctpm", {'o', 'l', 'd'});
  const auto refused = recordings::recover_session(whole.path, folder / "out.ctpm");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.errors()[0].message, "exists already");
  EXPECT_EQ(read_bytes(folder / "out.ctpm").size(), 3u);

  write_bytes(folder / "no.ctpm", std::vector<char>(9000, 'x'));
  EXPECT_FALSE(recordings::recover_session(folder / "no.ctpm", folder / "new.ctpm"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new.ctpm"));
}

}  // namespace
}  // namespace ctpm
