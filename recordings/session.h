#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/physics_revision.h"
#include "core/model/state.h"
#include "core/model/vec3.h"
#include "core/stepping/step.h"
#include "recordings/event.h"

namespace ctpm::recordings {

/// Everything known before the first tick. FORMAT.md section 4.
struct SessionStart {
  std::string scene_text;                            ///< scene text as read; opaque to this folder
  std::string look;                                  ///< organ colours and names for rendering; opaque to this folder
  Model model;                                       ///< the built network and its surfaces
  State initial_state;                               ///< State before tick 0
  std::string build_fingerprint;                     ///< identifies the build of the recording program
  std::int32_t physics_revision = kPhysicsRevision;  ///< of the recording program; 0: not stored, an old session
  std::map<std::string, std::string> metadata;       ///< free key/value pairs; see parent_session_key
};

/// Warning to show before replaying a session of physics revision `recorded`. Empty if this build computes the same
/// revision, so that replay is bit-equal.
std::string physics_remark(std::int32_t recorded);

/// Metadata keys of a session that continues another one.
inline constexpr const char* parent_session_key = "parent_session";  ///< SessionReader::session_id of the parent
inline constexpr const char* parent_tick_key =
    "parent_tick";  ///< decimal; the session starts from the State before this tick of the parent

/// One recorded tick. Tick n of a session is its n-th record, at time n * Model::tick.
struct TickRecord {
  Inputs inputs;
  Vec3 tool_force;              ///< force of the tissue on the tool [N]
  double depth = 0;             ///< [m]
  std::int32_t status = 0;      ///< StepStatus
  std::int32_t iterations = 0;  ///< solver iterations, summed over all solves of the tick
  std::int32_t contacts = 0;    ///< spheres touched
  std::int32_t severed = 0;     ///< elements severed in this tick
  double tick_time = 0;         ///< computing time of the tick [s], stored to 1 ns; 0: not measured
  double input_age = 0;         ///< age of the device sample used for the inputs when the tick began, the oldest of all
                                ///< devices [s], stored to 1 ns; 0: inputs come from no device
  double slip = 0;  ///< real time since the start of recording, less the time of the session, when the tick began
                    ///< [s], stored to 1 ms; 0: on time, or not recorded in real time
  std::uint64_t state_hash = 0;  ///< state_hash() of the State after the tick
  stepping::HandReport second;   ///< of the second hand; the numbers above are of the first one

  /// The numbers of one hand.
  stepping::HandReport of_hand(std::size_t hand) const {
    return hand == 0 ? stepping::HandReport{tool_force, depth, contacts} : second;
  }

  friend bool operator==(const TickRecord&, const TickRecord&) = default;
};

/// Makes the record of the tick just done.
TickRecord make_record(const Inputs& inputs, const stepping::StepReport& report, double tick_time_s,
                       std::uint64_t state_hash, double input_age_s = 0, double slip_s = 0);

/// The full State before tick `tick`.
struct Keyframe {
  std::int64_t tick = 0;
  State state;
};

using NamedValue = std::pair<std::string, double>;

/// Summary of a session. Percentiles use nearest rank over the ticks with a measured time (or an input age).
struct SessionStatistics {
  std::int64_t ticks = 0;
  std::int64_t keyframes = 0;
  std::int64_t events = 0;
  std::int64_t late_ticks = 0;     ///< number of late_tick events
  std::int64_t severed = 0;        ///< elements severed over all ticks
  double tick_time_p50 = 0;        ///< [s]
  double tick_time_p99 = 0;        ///< [s]
  double tick_time_p999 = 0;       ///< [s]
  double tick_time_max = 0;        ///< [s]
  double input_age_p50 = 0;        ///< [s]
  double input_age_p99 = 0;        ///< [s]
  double input_age_max = 0;        ///< [s]
  double slip = 0;                 ///< TickRecord::slip of the last tick [s]
  double slip_max = 0;             ///< [s]
  double max_force = 0;            ///< of all hands [N]
  double max_depth = 0;            ///< of all hands [m]
  std::vector<NamedValue> values;  ///< further numbers passed to SessionWriter::finish; the name contains the unit
};

}  // namespace ctpm::recordings
