#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "recordings/session_reader.h"

namespace ctpm::recordings {

/// Replays a session by simulating it from keyframes. Between keyframes, all positions come from the simulation.
class ReplayCursor {
 public:
  /// `reader` must outlive the cursor. The cursor starts before tick 0.
  static Result<ReplayCursor> create(SessionReader& reader);
  ReplayCursor(ReplayCursor&&) noexcept;
  ReplayCursor& operator=(ReplayCursor&&) noexcept;
  ~ReplayCursor();

  /// Moves to the State before `tick`, in [0, tick_count]. Starts from the current position if no keyframe is nearer.
  /// Errors: no such tick, or a chunk on the path is damaged.
  Result<Done> seek(std::int64_t tick);

  /// Moves to `state`, the State before `tick` that a cursor of the same session had.
  void resume(std::int64_t tick, const State& state);

  /// Builds at once what the next step would have to build of the State, which may take tenths of a second after cuts.
  /// Reads nothing.
  void prepare();

  /// Simulates one tick. Returns false at the end of the session. Error: the tick's chunk is damaged.
  Result<bool> step();

  std::int64_t tick() const;  ///< number of ticks done; state() is the State before this tick
  const State& state() const;
  const TickRecord& record() const;            ///< recorded values of the last tick done
  const stepping::StepReport& report() const;  ///< simulated values of the last tick done
  double tick_time() const;                    ///< time that its simulation took now [s]
  bool same_so_far() const;  ///< every tick since the last keyframe or resume() matched its recorded hash

 private:
  struct Impl;
  explicit ReplayCursor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Returns the start of a session that continues `parent` from the State before `tick`. It takes the parent's scene,
/// network and look, and names the parent in the metadata. The State is simulated, not read from the file. Errors: no
/// such tick, or the session is damaged or does not replay.
Result<SessionStart> continue_session(SessionReader& parent, std::int64_t tick);

struct VerifyOptions {
  std::int64_t from = 0;  ///< first tick to compare; simulation begins at the last keyframe at or before it
  std::int64_t to = -1;   ///< one past the last tick to compare; -1: to the end
  int threads = 1;        ///< >= 1; the verdict does not depend on it
  std::function<void(std::int64_t done, std::int64_t total)> progress = {};  ///< called from time to time; may be empty
  /// Asked by every thread before each tick, unless empty; true ends it with an error.
  std::function<bool()> should_stop = {};
  /// Called for each simulated tick, unless empty; with several threads from each of them, at any time.
  std::function<void(std::int64_t tick, const stepping::StepReport& report)> look = {};
};

/// Result of comparing a new simulation with the recording.
struct Verdict {
  bool same = true;                   ///< nothing differs; false if no tick was compared
  std::int32_t physics_revision = 0;  ///< revision of the recording; 0: recorded before revisions were stored
  std::int64_t ticks_compared = 0;
  std::int64_t ticks_different = 0;
  std::int64_t first_tick = -1;    ///< first tick that differs; -1: none
  std::string first_quantity;      ///< quantity that differs there: `state_hash`, `tool_force.x`, `depth`, `status` ...
  std::int64_t located_tick = -1;  ///< first keyframe after the difference, where `quantity` was compared; -1: none
  std::string quantity;  ///< field of the State; without a located_tick, the first number of first_tick that differs,
                         ///< else `state_hash`
  std::int32_t index = -1;  ///< sphere or element with the largest difference; -1: the field is a single value
  double recorded = 0, replayed = 0;  ///< both values, in the quantity's unit
  double difference = 0;              ///< |replayed - recorded|
};

/// The verdict in one readable sentence.
std::string to_string(const Verdict& verdict);

/// Simulates the session from its recorded inputs and compares every state hash, force and report. A difference is a
/// verdict, not an error. Errors: the session is damaged, or the range is empty.
Result<Verdict> verify_session(SessionReader& reader, const VerifyOptions& options = {});

}  // namespace ctpm::recordings
