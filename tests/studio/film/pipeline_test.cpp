#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "studio/film/bounded_queue.h"
#include "studio/film/pipeline.h"

namespace ctpm {
namespace {

/// A frame that carries its number.
render::Frame numbered(std::int64_t number) { return render::blank_frame(2, 2, std::uint8_t(number), 0, 0); }

void nap(int microseconds) { std::this_thread::sleep_for(std::chrono::microseconds(microseconds)); }

TEST(Film, KeepsTheOrderAndNeverMoreThanAFewFramesInMemory) {
  constexpr std::int64_t kFrames = 300;
  for (const int slow_stage : {0, 1, 2}) {
    std::atomic<int> shots = 0, pictures = 0;
    int most_shots = 0, most_pictures = 0;
    std::int64_t drawn = 0, encoded = 0;
    film::FilmWork work;
    work.shoot = {[&](std::int64_t frame) -> Result<film::Shot> {
      if (slow_stage == 0) nap(200);
      ++shots;
      film::Shot shot;
      shot.overlay.tick = frame;
      return shot;
    }};
    work.draw = [&](std::vector<film::Shot> taken) -> Result<render::Frame> {
      if (slow_stage == 1) nap(200);
      most_shots = std::max(most_shots, shots--);
      ++pictures;
      EXPECT_EQ(taken.at(0).overlay.tick, drawn);
      return numbered(drawn++);
    };
    work.encode = [&](const render::Frame& frame) -> Result<Done> {
      if (slow_stage == 2) nap(200);
      most_pictures = std::max(most_pictures, pictures--);
      EXPECT_EQ(frame, numbered(encoded++));
      return Done{};
    };
    const auto times = film::run_film(kFrames, work);
    ASSERT_TRUE(times);
    EXPECT_EQ(encoded, kFrames);
    // What waits in the queue, one in the hands of whoever made it and one of whoever takes it.
    EXPECT_LE(most_shots, int(film::kFilmQueue) + 2);
    EXPECT_LE(most_pictures, int(film::kFilmQueue) + 2);
    EXPECT_GT(times->elapsed, 0);
  }
}

TEST(Film, StagesWorkAtTheSameTime) {
  film::FilmWork work;
  work.shoot = {[](std::int64_t) -> Result<film::Shot> { return nap(2000), film::Shot{}; }};
  work.draw = [](std::vector<film::Shot>) -> Result<render::Frame> { return nap(2000), numbered(0); };
  work.encode = [](const render::Frame&) -> Result<Done> { return nap(2000), Done{}; };
  const auto times = film::run_film(100, work);
  ASSERT_TRUE(times);
  EXPECT_LT(times->elapsed, 0.6 * times->work()) << "one after another they would take all of it";
}

TEST(Film, AnErrorOfAnyStageStopsThemAll) {
  for (const int bad : {0, 1, 2}) {
    std::atomic<std::int64_t> shot = 0;
    film::FilmWork work;
    work.shoot = {[&](std::int64_t frame) -> Result<film::Shot> {
                    if (bad == 0 && frame == 7) return Error{"shoot", "broke", ""};
                    return ++shot, film::Shot{};
                  },
                  [](std::int64_t) -> Result<film::Shot> { return film::Shot{}; }};
    work.draw = [&](std::vector<film::Shot> taken) -> Result<render::Frame> {
      EXPECT_EQ(taken.size(), 2u);
      if (bad == 1 && shot > 7) return Error{"draw", "broke", ""};
      return numbered(0);
    };
    work.encode = [&](const render::Frame&) -> Result<Done> {
      if (bad == 2 && shot > 7) return Error{"encode", "broke", ""};
      return Done{};
    };
    const auto times = film::run_film(1'000'000, work);
    ASSERT_FALSE(times);
    EXPECT_EQ(times.errors().size(), 1u);
    EXPECT_EQ(times.errors()[0].where, bad == 0 ? "shoot" : bad == 1 ? "draw" : "encode");
    EXPECT_LT(shot, 1'000'000);
  }
}

TEST(Film, AClosedQueueGivesWhatWaitsAndTakesNothing) {
  film::BoundedQueue<int> queue(3);
  EXPECT_TRUE(queue.push(1) && queue.push(2));
  queue.close();
  EXPECT_FALSE(queue.push(3));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

}  // namespace
}  // namespace ctpm
