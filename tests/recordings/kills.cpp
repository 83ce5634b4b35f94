#include "tests/recordings/kills.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include "recordings/replay.h"
#include "tests/recordings/sessions.h"

namespace ctpm::testing {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::int64_t session_ticks = 400;
constexpr auto allowed_loss = std::chrono::milliseconds(200);

/// Progress of the recorder, in shared memory that outlives it.
struct Shared {
  std::atomic<bool> created;
  std::atomic<std::int64_t> appended;
  std::atomic<std::int64_t> appended_at_ns[session_ticks];
};

std::int64_t now_ns() { return Clock::now().time_since_epoch() / std::chrono::nanoseconds(1); }

/// The child: records one session of 400 ms and ends it if not killed before.
[[noreturn]] void record_until_killed(const std::string& path, const recordings::SessionStart& start, Shared& shared) {
  auto writer = recordings::SessionWriter::create(path, start, {.keyframe_ticks = 50});
  if (!writer) ::_exit(1);
  shared.created = true;
  auto deadline = Clock::now();
  live(start, session_ticks, [&](const State& after, const recordings::TickRecord& record) {
    std::this_thread::sleep_until(deadline += std::chrono::milliseconds(1));
    writer->append(after, record);
    const std::int64_t tick = shared.appended;
    shared.appended_at_ns[tick] = now_ns();
    shared.appended = tick + 1;
  });
  if (!writer->finish()) ::_exit(1);
  while (true) ::pause();
}

/// `most_lost_ns`: the most that any of them lost so far.
void check_what_is_left(const std::string& path, const Shared& shared, std::int64_t killed_at_ns,
                        std::int64_t& most_lost_ns) {
  if (!shared.created && !std::filesystem::exists(path)) return;
  auto reader = recordings::SessionReader::open(path);
  ASSERT_TRUE(reader) << text_of(reader.errors());
  const auto all = reader->check_all();
  ASSERT_TRUE(all) << text_of(all.errors());
  const std::int64_t kept = reader->tick_count();
  ASSERT_LE(shared.appended, kept + session_ticks);
  if (kept < shared.appended) {
    const std::int64_t lost_ns = killed_at_ns - shared.appended_at_ns[kept];
    most_lost_ns = std::max(most_lost_ns, lost_ns);
    EXPECT_LE(lost_ns, allowed_loss / std::chrono::nanoseconds(1))
        << "kept " << kept << " of " << shared.appended << " ticks";
  }
  const auto verdict = recordings::verify_session(*reader);
  ASSERT_TRUE(verdict) << text_of(verdict.errors());
  EXPECT_EQ(verdict->same, kept > 0) << recordings::to_string(*verdict);
  EXPECT_EQ(verdict->ticks_compared, kept);
}

/// One recorder process and its shared memory.
struct Victim {
  Folder folder;
  Shared* shared = nullptr;
  pid_t child = -1;
  Clock::time_point dies_at;
  std::int64_t killed_at_ns = 0;
};

/// Several concurrent recorders, each killed at its own moment. They mostly sleep, so they do not slow each other down.
void kill_together(std::span<Shared* const> memory, const recordings::SessionStart& start, std::mt19937& random,
                   std::int64_t& most_lost_ns) {
  std::uniform_int_distribution<int> life_us(500, 430000);
  std::vector<Victim> victims(memory.size());
  for (std::size_t i = 0; i < victims.size(); ++i) {
    Victim& victim = victims[i];
    victim.shared = new (memory[i]) Shared{};
    victim.child = ::fork();
    ASSERT_GE(victim.child, 0);
    if (victim.child == 0) record_until_killed(victim.folder / "a.ctpm", start, *victim.shared);
    victim.dies_at = Clock::now() + std::chrono::microseconds(life_us(random));
  }
  std::vector<Victim*> in_order;
  for (Victim& victim : victims) in_order.push_back(&victim);
  std::sort(in_order.begin(), in_order.end(), [](const Victim* a, const Victim* b) { return a->dies_at < b->dies_at; });
  for (Victim* victim : in_order) {
    std::this_thread::sleep_until(victim->dies_at);
    victim->killed_at_ns = now_ns();
    ::kill(victim->child, SIGKILL);
  }
  for (const Victim& victim : victims) {
    int status = 0;
    ASSERT_EQ(::waitpid(victim.child, &status, 0), victim.child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the recorder ended by itself";
    check_what_is_left(victim.folder / "a.ctpm", *victim.shared, victim.killed_at_ns, most_lost_ns);
  }
}

}  // namespace

void kill_recorders(int count) {
  constexpr int together = 2;
  const recordings::SessionStart starts[] = {small_start(3, 2, 2), small_start(3, 2, 2, 2)};
  std::mt19937 random(12345);
  void* memory = ::mmap(nullptr, together * sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  std::vector<Shared*> places;
  for (int i = 0; i < together; ++i) places.push_back(static_cast<Shared*>(memory) + i);
  std::int64_t most_lost_ns = 0;
  for (int killed = 0; killed < count && !::testing::Test::HasFailure(); killed += together) {
    SCOPED_TRACE("kills from " + std::to_string(killed));
    kill_together(std::span(places).first(std::size_t(std::min(together, count - killed))),
                  starts[killed / together % 2], random, most_lost_ns);
  }
  std::printf("%d killed recorders: at most %.1f ms lost\n", count, 1e-6 * double(most_lost_ns));
  ::munmap(memory, together * sizeof(Shared));
}

}  // namespace ctpm::testing
