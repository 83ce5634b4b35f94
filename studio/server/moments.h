#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
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

/// Keeps States of a session closer together than its keyframes are, so that a seek simulates at most spacing() ticks:
/// replays the session in the background, at low priority, around aim() first, and takes what others simulated.
class Moments {
 public:
  /// Errors: the session cannot be read.
  static Result<std::unique_ptr<Moments>> open(const std::string& file);
  ~Moments();

  /// A tick, and the State before it; null: it is a keyframe of the session.
  using Place = std::pair<std::int64_t, std::shared_ptr<const Moment>>;

  /// The nearest kept State at or before `tick`.
  Place before(std::int64_t tick) const;

  /// The nearest kept State after `tick`; nothing: `tick` is beyond the last one.
  std::optional<Place> after(std::int64_t tick) const;

  /// The place with its State; in place of a damaged keyframe one that is earlier. `reader`: the caller's, of this
  /// session. Errors: the session cannot be read.
  Result<Place> read(const Place& place, recordings::SessionReader& reader) const;

  /// Takes the State before `tick`, to which a replay came that began at a kept State, if one is missing there.
  void keep(std::int64_t tick, const State& state, bool is_same);

  /// Moments near `tick` are needed first.
  void aim(std::int64_t tick) { aim_ = tick; }

  std::int64_t spacing() const { return spacing_; }  ///< [ticks]
  double share() const;                              ///< of the session that was replayed already, in [0, 1]

  static constexpr std::int64_t kSpacing = 50;  ///< ticks between two States where memory allows
  /// For the States of one session, at least; where there is more memory, a sixteenth of it [bytes].
  static constexpr std::size_t kLeastMemory = 512u << 20;

 private:
  Moments(recordings::SessionReader reader, std::vector<std::int64_t> keyframes);
  void work();
  std::size_t next_interval() const;
  std::int64_t end_of(std::size_t interval) const;
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
