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
  std::int64_t tick = 0;
  State state;
  bool is_same = true;  ///< the replay up to here was as recorded
};

/// A State in memory. Its swept surface is most of it after a long cut, and but for the last row it is the beginning of
/// that of later States, of which there is one copy.
struct KeptState {
  State state;                    ///< without the first `shared_points` points of its swept surface
  std::size_t shared_points = 0;  ///< those are in the copy
  bool is_same = true;            ///< as Moment::is_same

  std::size_t swept_points() const { return shared_points + state.swept.size(); }
};

/// Keeps States of a session closer together than its keyframes are, so that a seek simulates at most spacing() ticks:
/// reads the keyframes, replays the session in the background, at low priority, and takes what others simulated. Of the
/// intervals between two keyframes that of aim() comes first. Then the longest ways are halved: the first half of each
/// interval comes before the third quarter of any, and so on, around aim() first.
class Moments {
 public:
  /// Errors: the session cannot be read.
  static Result<std::unique_ptr<Moments>> open(const std::string& file);
  ~Moments();

  /// A tick, and the State before it; null: it is a keyframe that is not in memory.
  using Place = std::pair<std::int64_t, std::shared_ptr<const KeptState>>;

  /// The nearest kept State at or before `tick`.
  Place before(std::int64_t tick) const;

  /// The nearest kept State after `tick`; nothing: `tick` is beyond the last one.
  std::optional<Place> after(std::int64_t tick) const;

  /// The moment at a place; in place of a damaged keyframe one that is earlier. `reader`: the caller's, of this
  /// session. Errors: the session cannot be read.
  Result<Moment> read(const Place& place, recordings::SessionReader& reader);

  /// Takes the State before `tick`, to which a replay came that began at a kept State, if one is missing there.
  void keep(std::int64_t tick, const State& state, bool is_same);

  /// Moments near `tick` are needed first.
  void aim(std::int64_t tick) { aim_ = tick; }

  /// What waits in the background while somebody waits for a picture.
  enum class Rest {
    none,
    replaying,  ///< the glimpse is there
    all,
  };
  void rest(Rest rest) { rest_ = rest; }

  std::int64_t spacing() const { return spacing_; }  ///< [ticks]
  double share() const;                              ///< of the session that was replayed already, in [0, 1]

  static constexpr std::int64_t kSpacing = 50;  ///< ticks between two States where memory allows
  /// For the States of one session, at least; where there is more memory, a sixteenth of it [bytes].
  static constexpr std::size_t kLeastMemory = 512u << 20;

 private:
  Moments(recordings::SessionReader reader, std::vector<std::int64_t> keyframes, std::optional<State> last);
  void work();
  std::size_t next_interval() const;
  std::int64_t end_of(std::size_t interval) const;
  bool is_done(std::size_t interval) const;
  void wait_while_replaying_rests() const;
  void fill(recordings::ReplayCursor& cursor, std::size_t interval);
  std::shared_ptr<const KeptState> without_sweep(State state, bool is_same) const;
  State with_sweep(const KeptState& kept) const;

  recordings::SessionReader reader_;
  std::vector<std::int64_t> keyframes_;  ///< ticks; interval i is from the i-th to the next or the end
  std::optional<State> last_;            ///< of the last keyframe, of which the cut is the longest; none: damaged
  bool keeps_keyframes_ = false;         ///< there is memory for all of them
  std::int64_t spacing_ = kSpacing;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const KeptState>> moments_;          ///< of tick i * spacing_
  std::vector<std::shared_ptr<const KeptState>> keyframe_states_;  ///< those that were read, of keyframes_
  std::vector<std::int64_t> filled_;                               ///< up to where each interval has its States [ticks]
  std::atomic<std::int64_t> aim_{0};
  std::atomic<bool> ends_{false};
  std::atomic<Rest> rest_{Rest::none};
  std::thread thread_;
};

}  // namespace ctpm::server
