#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "recordings/session_reader.h"

namespace ctpm::recordings {

/// Walks through a session by simulating it again from keyframes. Positions come from the simulation, never
/// from the file.
class ReplayCursor {
 public:
  /// `reader` must outlive the cursor. Stands before tick 0.
  static Result<ReplayCursor> create(SessionReader& reader);
  ReplayCursor(ReplayCursor&&) noexcept;
  ReplayCursor& operator=(ReplayCursor&&) noexcept;
  ~ReplayCursor();

  /// Goes to the State before `tick`, in [0, tick_count]; from where it stands if that is nearer than a
  /// keyframe.
  Result<Done> seek(std::int64_t tick);

  /// Simulates one tick. False at the end of the session. Errors: the tick's chunk is damaged.
  Result<bool> step();

  std::int64_t tick() const;  ///< ticks done: state() is the State before this tick
  const State& state() const;
  const TickRecord& record() const;            ///< as recorded, of the tick done last
  const stepping::StepReport& report() const;  ///< as simulated now, of the tick done last
  bool same_so_far() const;                    ///< every tick since the last keyframe used had the recorded hash

 private:
  struct Impl;
  explicit ReplayCursor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The start of a session that goes on from the State before `tick` of `parent`: its scene, network and look,
/// with the parent named in the metadata. The State is simulated, not taken from the file. Errors: no such
/// tick, or the session is damaged or does not replay.
Result<SessionStart> continue_session(SessionReader& parent, std::int64_t tick);

struct VerifyOptions {
  std::int64_t from = 0;  ///< first tick that is compared; simulation begins at the keyframe at or before it
  std::int64_t to = -1;   ///< tick after the last one; -1: the end
  int threads = 1;        ///< >= 1; the verdict does not depend on it
  std::function<void(std::int64_t done, std::int64_t total)> progress = {};  ///< called now and then; may be empty
};

/// Whether simulating again gives what was recorded.
struct Verdict {
  bool same = true;
  std::int32_t physics_revision = 0;  ///< that the session was recorded with; 0: from before revisions were stored
  std::int64_t ticks_compared = 0;
  std::int64_t ticks_different = 0;
  std::int64_t first_tick = -1;       ///< first tick whose outcome differs; -1: none
  std::string first_quantity;         ///< what differed there: `state_hash`, `tool_force.x`, `depth`, `status` ...
  std::int64_t located_tick = -1;     ///< where `quantity` was compared: the first keyframe at or after the
                                      ///< difference; -1: there is none
  std::string quantity;               ///< field of the State, or as first_quantity if there is no later keyframe
  std::int32_t index = -1;            ///< sphere or element of it with the largest difference; -1: a single value
  double recorded = 0, replayed = 0;  ///< the two values, in the quantity's unit
  double difference = 0;              ///< |replayed - recorded|
};

/// One sentence for people.
std::string to_string(const Verdict& verdict);

/// Simulates the session again from its inputs and compares every state hash, force and report. A difference
/// is a verdict, not an error. Errors: the session is damaged, or the range is empty.
Result<Verdict> verify_session(SessionReader& reader, const VerifyOptions& options = {});

}  // namespace ctpm::recordings
