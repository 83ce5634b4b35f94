#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <filesystem>
#include <functional>
#include <thread>

#include "recordings/recover.h"
#include "recordings/replay.h"
#include "tests/recordings/kills.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

TEST(Crash, AKilledRecorderLosesAtMost200Ms) { kill_recorders(40); }

/// Runs `work` in a process whose files cannot exceed `bytes`, as on a full disk. Returns its exit code.
int on_a_full_disk(rlim_t bytes, const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(work());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

void give_space(rlim_t bytes = RLIM_INFINITY) {
  const rlimit limit{bytes, RLIM_INFINITY};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

/// Each file has a limit of its own, so that the writer finds space again when it moves the log into the file. On a
/// full disk it does not.
void take_space() { give_space(4 << 10); }

constexpr rlim_t full_at = 400 << 10;  // [bytes]

/// Appends until the first write error. Returns the number of ticks appended, or 0 without an error.
std::int64_t append_until_full(recordings::SessionWriter& writer, const recordings::SessionStart& start) {
  std::int64_t appended = 0;
  bool full = false;
  live(start, 12000, [&](const State& after, const recordings::TickRecord& record) {
    if (full) return;
    writer.append(after, record);
    ++appended;
    if (appended % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    full = !writer.status().error.empty();
  });
  return full ? appended : 0;
}

TEST(FullDisk, IsToldByStatusAndByTheEndAndWhatFitsIsGood) {
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  const int code = on_a_full_disk(full_at, [&] {
    const recordings::SessionStart start = small_start(3, 2, 2);
    auto writer = recordings::SessionWriter::create(path, start, {.keyframe_ticks = 100});
    if (!writer) return 2;
    if (append_until_full(*writer, start) == 0) return 3;
    take_space();
    for (int i = 0; i < 300; ++i) writer->append(start.initial_state, {});
    const auto ended = writer->finish();
    if (ended) return 4;
    const recordings::WriterStatus status = writer->status();
    if (status.lost <= 0 || status.committed + status.lost != status.appended) return 5;
    if (ended.errors()[0].where != path || ended.errors()[0].message.find("were not recorded") == std::string::npos)
      return 6;
    return 0;
  });
  EXPECT_EQ(code, 0);
  auto reader = recordings::SessionReader::open(path);
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_FALSE(reader->ended_cleanly());
  EXPECT_GT(reader->tick_count(), 100);
  const auto all = reader->check_all();
  EXPECT_TRUE(all) << text_of(all.errors());
  const auto verdict = recordings::verify_session(*reader);
  ASSERT_TRUE(verdict);
  EXPECT_TRUE(verdict->same) << recordings::to_string(*verdict);
}

TEST(FullDisk, SpaceThatIsFreedInTimeLosesNothing) {
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  const int code = on_a_full_disk(full_at, [&] {
    const recordings::SessionStart start = small_start(3, 2, 2);
    auto writer = recordings::SessionWriter::create(path, start, {.keyframe_ticks = 100});
    if (!writer) return 2;
    const std::int64_t appended = append_until_full(*writer, start);
    if (appended == 0) return 3;
    give_space();
    const auto ended = writer->finish();
    if (!ended) return 4;
    return ended->ticks == appended && writer->status().lost == 0 ? 0 : 5;
  });
  EXPECT_EQ(code, 0);
  auto reader = recordings::SessionReader::open(path);
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_TRUE(reader->ended_cleanly());
  EXPECT_TRUE(reader->check_all());
}

TEST(FullDisk, AtCreationLeavesNothingBehind) {
  const Folder folder;
  const int code = on_a_full_disk(8 << 10, [&] {
    const auto writer = recordings::SessionWriter::create(folder / "a.ctpm", small_start(5, 5, 5));
    return !writer && writer.errors()[0].where == folder / "a.ctpm" ? 0 : 1;
  });
  EXPECT_EQ(code, 0);
  EXPECT_TRUE(folder.names().empty());
}

/// A session that lost its end is put together anew in a second file: where that does not fit, nothing is known of what
/// it would save.
TEST(FullDisk, WhatDoesNotFitIsNotCalledLostByARecovery) {
  const Folder folder;
  const std::string path = folder / "a.ctpm", out = folder / "b.ctpm";
  {
    const recordings::SessionStart start = small_start(3, 2, 2);
    auto writer = recordings::SessionWriter::create(path, start, {.keyframe_ticks = 100});
    ASSERT_TRUE(writer);
    live(start, 6000, [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
    ASSERT_TRUE(writer->finish());
  }
  const auto size = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, size / 2);
  const auto saved = recordings::recover_session(path, out);
  ASSERT_TRUE(saved) << text_of(saved.errors());
  ASSERT_GT(saved->ticks_saved, 100);
  std::filesystem::remove(out);
  const int code = on_a_full_disk(size / 8, [&] {
    const auto refused = recordings::recover_session(path, out);
    return !refused && refused.errors()[0].where == out ? 0 : 1;
  });
  EXPECT_EQ(code, 0);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ctpm"});
}

TEST(FullDisk, AQueueThatOverflowsEndsTheRecordingAndSaysSo) {
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  const int code = on_a_full_disk(full_at, [&] {
    const recordings::SessionStart start = small_start(3, 2, 2);
    auto writer = recordings::SessionWriter::create(path, start, {.keyframe_ticks = 100, .queue_ticks = 300});
    if (!writer) return 2;
    const std::int64_t before = append_until_full(*writer, start);
    if (before == 0) return 3;
    for (int i = 0; i < 1000; ++i) writer->append(start.initial_state, {});
    give_space();
    const auto ended = writer->finish();
    const recordings::WriterStatus status = writer->status();
    if (ended || status.lost < 600 || status.appended != before + 1000) return 4;
    return 0;
  });
  EXPECT_EQ(code, 0);
  auto reader = recordings::SessionReader::open(path);
  ASSERT_TRUE(reader) << text_of(reader.errors());
  EXPECT_TRUE(reader->check_all()) << "what is there has no gap";
  EXPECT_FALSE(reader->ended_cleanly());
}

/// Runs `work` without write permission: as root, in a process that drops root. Returns its exit code.
int without_rights(const std::function<int()>& work) {
  constexpr uid_t nobody = 65534;
  const pid_t child = ::fork();
  if (child == 0) {
    if (::geteuid() == 0 && ::setuid(nobody) != 0) ::_exit(254);
    ::_exit(work());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

TEST(Crash, WhatIsLeftCanBeReadWhereNothingCanBeWritten) {
  const Folder folder;
  const std::string path = folder / "a.ctpm";
  const recordings::SessionStart start = small_start(3, 2, 2);
  const Folder live_folder;
  auto writer = recordings::SessionWriter::create(live_folder / "a.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  for (int i = 0; i < 250; ++i) writer->append(start.initial_state, {});
  while (writer->status().committed < 250) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  // kill -9 leaves the file, its log, and perhaps the log's index.
  for (const bool with_index : {false, true}) {
    for (const char* ending : {"", "-wal", "-shm"}) {
      std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
      if (std::string(ending) == "-shm" && !with_index) continue;
      write_bytes(path + ending, read_bytes(live_folder / (std::string("a.ctpm") + ending)));
      ::chmod((path + ending).c_str(), 0444);
    }
    ::chmod(folder.path().c_str(), 0555);
    const int code = without_rights([&] {
      auto reader = recordings::SessionReader::open(path);
      if (!reader) {
        std::fputs(text_of(reader.errors()).c_str(), stderr);
        return 1;
      }
      return reader->tick_count() == 250 && reader->check_all() ? 0 : 2;
    });
    EXPECT_EQ(code, 0) << "with index " << with_index;
    ::chmod(folder.path().c_str(), 0755);
  }
  EXPECT_EQ(folder.names().size(), 3u);
}

TEST(Session, AFolderThatCannotBeWrittenIsSaid) {
  const Folder folder;
  ::chmod(folder.path().c_str(), 0555);
  const int code = without_rights([&] {
    const auto writer = recordings::SessionWriter::create(folder / "a.ctpm", small_start(3, 2, 2));
    if (writer) return 1;
    return writer.errors()[0].message == "the folder " + folder.path() + " cannot be written" ? 0 : 2;
  });
  EXPECT_EQ(code, 0);
  ::chmod(folder.path().c_str(), 0755);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace ctpm
