#include "studio/film/pipeline.h"

#include <chrono>
#include <deque>
#include <mutex>
#include <thread>

#include "studio/film/bounded_queue.h"

namespace ctpm::film {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class FilmRun {
 public:
  FilmRun(std::int64_t frames, const FilmWork& work) : frames_(frames), work_(work) {
    for (std::size_t i = 0; i < work.shoot.size(); ++i) shots_.emplace_back(kFilmQueue);
    shooting_s_.resize(work.shoot.size());
  }

  Result<StageTimes> run() {
    const Clock::time_point start = Clock::now();
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < shots_.size(); ++i) threads.emplace_back([this, i] { shoot(i); });
    threads.emplace_back([this] { encode(); });
    draw();
    for (std::thread& thread : threads) thread.join();
    if (!errors_.empty()) return errors_;
    for (const double s : shooting_s_) times_.simulation += s;
    times_.elapsed = seconds_since(start);
    return times_;
  }

 private:
  /// The first error ends every stage.
  void fail(const Errors& errors) {
    const std::lock_guard lock(mutex_);
    if (errors_.empty()) errors_ = errors;
    for (BoundedQueue<Shot>& queue : shots_) queue.abandon();
    pictures_.abandon();
  }

  void shoot(std::size_t session) {
    for (std::int64_t frame = 0; frame < frames_; ++frame) {
      const Clock::time_point start = Clock::now();
      Result<Shot> shot = work_.shoot[session](frame);
      shooting_s_[session] += seconds_since(start);
      if (!shot) return fail(shot.errors());
      if (!shots_[session].push(std::move(*shot))) return;
    }
  }

  void draw() {
    for (std::int64_t frame = 0; frame < frames_; ++frame) {
      std::vector<Shot> shots;
      for (BoundedQueue<Shot>& queue : shots_) {
        std::optional<Shot> shot = queue.pop();
        if (!shot) return;
        shots.push_back(std::move(*shot));
      }
      const Clock::time_point start = Clock::now();
      Result<render::Frame> picture = work_.draw(std::move(shots));
      times_.rendering += seconds_since(start);
      if (!picture) return fail(picture.errors());
      if (!pictures_.push(std::move(*picture))) return;
    }
    pictures_.close();
  }

  void encode() {
    while (const std::optional<render::Frame> picture = pictures_.pop()) {
      const Clock::time_point start = Clock::now();
      const Result<Done> done = work_.encode(*picture);
      times_.encoding += seconds_since(start);
      if (!done) return fail(done.errors());
    }
  }

  const std::int64_t frames_;
  const FilmWork& work_;
  std::deque<BoundedQueue<Shot>> shots_;  // (session_count)
  BoundedQueue<render::Frame> pictures_{kFilmQueue};
  std::vector<double> shooting_s_;  // (session_count)
  StageTimes times_;                // each member belongs to one thread until the join
  std::mutex mutex_;
  Errors errors_;
};

}  // namespace

Result<StageTimes> run_film(std::int64_t frames, const FilmWork& work) { return FilmRun(frames, work).run(); }

}  // namespace ctpm::film
