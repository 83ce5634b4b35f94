// What the time of a tick went to, told by what its thread did.

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "studio/session/late_ticks.h"
#include "studio/session/part_clock.h"

namespace ctpm {
namespace {

using session::PartClock;

constexpr double kWork = 3e-3, kSleep = 20e-3;  // [s]
constexpr double kResolution = 1e-4;            // of a processor's clock, and of what goes on beside the work [s]

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Keeps the processor for kWork, however long that takes on a busy machine.
void work() {
  for (const double start = processor_time(); processor_time() < start + kWork;) continue;
}

/// What a thread looks like that other programs put aside.
void rest() { std::this_thread::sleep_for(std::chrono::duration<double>(kSleep)); }

PartClock begun() {
  PartClock clock;
  clock.begin_tick(PartClock::Clock::now(), PartClock::Clock::now());
  clock.begin_step();
  return clock;
}

/// The least that each part took in some ticks alike. What the system does in a thread's name, as answering an
/// interrupt, adds to that thread's time, in few of them.
template <class Tick>
recordings::TickParts least(Tick tick) {
  recordings::TickParts least = tick();
  for (int i = 1; i < 5; ++i) {
    const recordings::TickParts parts = tick();
    for (double recordings::TickParts::*part :
         {&recordings::TickParts::solver, &recordings::TickParts::cut, &recordings::TickParts::input,
          &recordings::TickParts::recorder, &recordings::TickParts::machine})
      least.*part = std::min(least.*part, parts.*part);
  }
  return least;
}

TEST(PartClock, EachPartHasItsOwnProcessorTime) {
  const recordings::TickParts parts = least([] {
    PartClock clock = begun();
    work();
    {
      const InStage cutting(&clock, Stage::cut);
      work(), work();
      const InStage waiting(&clock, Stage::cut_surface);
      work();
    }
    work();
    clock.begin_recording();
    work();
    const recordings::TickParts parts = clock.end_tick();
    EXPECT_NEAR(parts.solver + parts.cut + clock.lost_in_step(), clock.step_time(), kResolution);
    return parts;
  });
  EXPECT_NEAR(parts.solver, 2 * kWork, kResolution);
  EXPECT_GE(parts.cut, 3 * kWork - kResolution);
  EXPECT_NEAR(parts.recorder, kWork, kResolution);
  EXPECT_LT(parts.input, kWork);
}

TEST(PartClock, TimeWithoutAProcessorIsTheMachines) {
  const recordings::TickParts parts = least([] {
    PartClock clock = begun();
    work(), rest();
    clock.begin_recording();
    EXPECT_GE(clock.lost_in_step(), kSleep - kResolution);
    rest();
    return clock.end_tick();
  });
  EXPECT_GE(parts.machine, 2 * kSleep - kResolution);
  EXPECT_NEAR(parts.solver, kWork, kResolution);
  EXPECT_LT(parts.recorder, kWork);
}

TEST(PartClock, WhoWaitsForAnInputOrACutSleeps) {
  const recordings::TickParts parts = least([] {
    PartClock clock;
    clock.begin_tick(PartClock::Clock::now(), PartClock::Clock::now());
    rest();
    clock.begin_step();
    {
      const InStage waiting(&clock, Stage::cut_surface);
      rest();
    }
    work();
    clock.begin_recording();
    return clock.end_tick();
  });
  EXPECT_GE(parts.input, kSleep - kResolution);
  EXPECT_GE(parts.cut, kSleep - kResolution);
  EXPECT_NEAR(parts.solver, kWork, kResolution) << "and it is not taken from what follows";
}

TEST(PartClock, ATickThatIsWokenLateLosesItToTheMachine) {
  PartClock clock;
  const PartClock::Clock::time_point due = PartClock::Clock::now();
  rest();
  clock.begin_tick(due, due);
  clock.begin_step(), clock.begin_recording();
  EXPECT_GE(clock.end_tick().machine, kSleep - kResolution);
  // Those who watch the session took the time from when the tick was due on.
  const PartClock::Clock::time_point end = clock.last();
  rest();
  clock.begin_tick(end, PartClock::Clock::now());
  clock.begin_step(), clock.begin_recording();
  EXPECT_GE(clock.end_tick().recorder, kSleep - kResolution);
}

TEST(LateTicks, TheMostFrequentCauseComesFirst) {
  using recordings::LateCause;
  session::LateTicks late;
  EXPECT_EQ(late.text(), "");
  for (const LateCause cause : {LateCause::solver, LateCause::cut, LateCause::cut, LateCause::machine}) late.add(cause);
  EXPECT_EQ(late.text(), "cut 2, solver 1, machine 1");
  EXPECT_EQ(late.total(), 4);
}

}  // namespace
}  // namespace ctpm
