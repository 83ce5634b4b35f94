#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/model/result.h"
#include "core/model/state.h"
#include "recordings/replay.h"
#include "recordings/session_reader.h"

namespace ctpm::server {

/// A State of a session, from which a replay can go on.
struct Moment {
  State state;
  bool is_same = true;  ///< the replay up to here was as recorded
};

/// Replays a session in the background, at low priority, and keeps States closer together than the session's keyframes
/// are. A seek then simulates at most spacing() ticks. Begins around aim() and works outwards.
class Moments {
 public:
  /// Errors: the session cannot be read.
  static Result<std::unique_ptr<Moments>> open(const std::string& file);
  ~Moments();

  /// The tick of the kept State nearest at or before `tick`, and that State; null: it is a keyframe of the session.
  std::pair<std::int64_t, std::shared_ptr<const Moment>> before(std::int64_t tick) const;

  /// Moments near `tick` are needed first.
  void aim(std::int64_t tick) { aim_ = tick; }

  std::int64_t spacing() const { return spacing_; }  ///< [ticks]
  double share() const;                              ///< of the session that was replayed already, in [0, 1]

  static constexpr std::int64_t kSpacing = 50;           ///< ticks between two States where memory allows
  static constexpr std::size_t kMostBytes = 512u << 20;  ///< of all States

 private:
  Moments(recordings::SessionReader reader, std::vector<std::int64_t> keyframes);
  void work();
  std::size_t next_interval() const;
  bool fill(recordings::ReplayCursor& cursor, std::size_t interval);

  recordings::SessionReader reader_;
  std::vector<std::int64_t> keyframes_;  ///< ticks; interval i is from the i-th to the next or the end
  std::int64_t spacing_ = kSpacing;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const Moment>> moments_;  ///< of tick i * spacing_
  std::vector<bool> is_done_;                           ///< each interval
  std::atomic<std::int64_t> aim_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace ctpm::server
