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

/// Everything that is known before the first tick. FORMAT.md section 4.
struct SessionStart {
  std::string scene_text;                            ///< the scene as it was read; opaque bytes here
  std::string look;                                  ///< organ colours and names for whoever draws; opaque bytes here
  Model model;                                       ///< the built network
  std::vector<Surface> surfaces;                     ///< one per organ of the model, or none at all
  State initial_state;                               ///< before tick 0
  std::string build_fingerprint;                     ///< names the build of the program that records
  std::int32_t physics_revision = kPhysicsRevision;  ///< of the program that records; 0 in a session from before
                                                     ///< revisions were stored
  std::map<std::string, std::string> metadata;       ///< free; see also parent_session_key
};

/// What a reader must know before a session of the physics revision `recorded` is replayed; empty if this build
/// computes the same revision, so that the replay has the same bits.
std::string physics_remark(std::int32_t recorded);

/// Metadata of a session that goes on from a moment of another one.
inline constexpr const char* parent_session_key = "parent_session";  ///< SessionReader::session_id of the parent
inline constexpr const char* parent_tick_key =
    "parent_tick";  ///< decimal: it starts from the State before this tick of the parent

/// One tick as it was lived. Tick n of a session is its n-th record, at n times Model::tick.
struct TickRecord {
  Inputs inputs;
  Vec3 tool_force;               ///< force of the tissue on the tool [N]
  double depth = 0;              ///< [m]
  std::int32_t status = 0;       ///< StepStatus
  std::int32_t iterations = 0;   ///< of all solves of the tick
  std::int32_t contacts = 0;     ///< spheres touched
  std::int32_t severed = 0;      ///< elements severed in this tick
  double tick_time = 0;          ///< how long the tick took [s], stored to 1 ns; 0: not measured
  double input_age = 0;          ///< of the device's sample behind the inputs when the tick began [s], stored
                                 ///< to 1 ns; 0: they come from no device
  std::uint64_t state_hash = 0;  ///< state_hash() of the State after the tick

  friend bool operator==(const TickRecord&, const TickRecord&) = default;
};

/// The record of a tick that was just done.
TickRecord make_record(const Inputs& inputs, const stepping::StepReport& report, double tick_time_s,
                       std::uint64_t state_hash, double input_age_s = 0);

/// The full State before tick `tick`.
struct Keyframe {
  std::int64_t tick = 0;
  State state;
};

using NamedValue = std::pair<std::string, double>;

/// What a session came to. Percentiles are over the ticks whose time was measured, or whose input has an age,
/// by nearest rank.
struct SessionStatistics {
  std::int64_t ticks = 0;
  std::int64_t keyframes = 0;
  std::int64_t events = 0;
  std::int64_t late_ticks = 0;     ///< events of kind late_tick
  std::int64_t severed = 0;        ///< elements, over all ticks
  double tick_time_p50 = 0;        ///< [s]
  double tick_time_p99 = 0;        ///< [s]
  double tick_time_p999 = 0;       ///< [s]
  double tick_time_max = 0;        ///< [s]
  double input_age_p50 = 0;        ///< [s]
  double input_age_p99 = 0;        ///< [s]
  double input_age_max = 0;        ///< [s]
  double max_force = 0;            ///< [N]
  double max_depth = 0;            ///< [m]
  std::vector<NamedValue> values;  ///< further numbers given to SessionWriter::finish, unit in the name
};

}  // namespace ctpm::recordings
