#include "tests/recordings/kills.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "recordings/replay.h"
#include "tests/recordings/sessions.h"

namespace ctpm::testing {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::int64_t session_ticks = 400;
constexpr auto allowed_loss = std::chrono::milliseconds(200);

/// What the recorder tells about itself in memory that outlives it.
struct Shared {
  std::atomic<bool> created;
  std::atomic<std::int64_t> appended;
  std::atomic<std::int64_t> appended_at_ns[session_ticks];
};

std::int64_t now_ns() { return Clock::now().time_since_epoch() / std::chrono::nanoseconds(1); }

/// The child: one session of 400 ms, ended properly if it lives that long.
[[noreturn]] void record_until_killed(const std::string& path, const SessionStart& start, Shared& shared) {
  auto writer = SessionWriter::create(path, start, {.keyframe_ticks = 50});
  if (!writer) ::_exit(1);
  shared.created = true;
  auto deadline = Clock::now();
  live(start, session_ticks, [&](const State& after, const TickRecord& record) {
    std::this_thread::sleep_until(deadline += std::chrono::milliseconds(1));
    writer->append(after, record);
    const std::int64_t tick = shared.appended;
    shared.appended_at_ns[tick] = now_ns();
    shared.appended = tick + 1;
  });
  if (!writer->finish()) ::_exit(1);
  while (true) ::pause();
}

void check_what_is_left(const std::string& path, const Shared& shared, std::int64_t killed_at_ns) {
  if (!shared.created && !std::filesystem::exists(path)) return;
  auto reader = SessionReader::open(path);
  ASSERT_TRUE(reader) << text_of(reader.errors());
  const auto all = reader->check_all();
  ASSERT_TRUE(all) << text_of(all.errors());
  const std::int64_t kept = reader->tick_count();
  ASSERT_LE(shared.appended, kept + session_ticks);
  if (kept < shared.appended) {
    const std::int64_t lost_ns = killed_at_ns - shared.appended_at_ns[kept];
    EXPECT_LE(lost_ns, allowed_loss / std::chrono::nanoseconds(1))
        << "kept " << kept << " of " << shared.appended << " ticks";
  }
  const auto verdict = verify_session(*reader);
  ASSERT_TRUE(verdict) << text_of(verdict.errors());
  EXPECT_TRUE(verdict->same) << to_string(*verdict);
  EXPECT_EQ(verdict->ticks_compared, kept);
}

}  // namespace

void kill_recorders(int count) {
  const SessionStart start = small_start(3, 2, 2);
  std::mt19937 random(12345);
  std::uniform_int_distribution<int> life_us(500, 430000);
  void* memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("kill " + std::to_string(i));
    const Folder folder;
    auto* shared = new (memory) Shared{};
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) record_until_killed(folder / "a.ctpm", start, *shared);
    std::this_thread::sleep_for(std::chrono::microseconds(life_us(random)));
    const std::int64_t killed_at_ns = now_ns();
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the recorder ended by itself";
    check_what_is_left(folder / "a.ctpm", *shared, killed_at_ns);
  }
  ::munmap(memory, sizeof(Shared));
}

}  // namespace ctpm::testing
