#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "core/model/vec3.h"
#include "recordings/session_reader.h"
#include "studio/compare/motion.h"
#include "studio/compare/path_distance.h"

namespace ctpm::compare {

/// Places that the network's elements have in one list of all: axial elements, constraints, angle springs.
struct ElementPlaces {
  std::size_t constraints, angle_springs, count;  ///< where each kind begins; axial elements begin at 0
  explicit ElementPlaces(const Model& model);
};

/// What was done in a session, tick by tick, as it was recorded.
struct SessionTrack {
  std::string path, session_id, scene_name;
  double tick = 0;                       ///< [s]
  std::vector<std::int32_t> tool;        ///< in the hand; -1: none                              (tick_count)
  std::vector<Vec3> tip;                 ///< of the tool: a ball's centre, a blade's tip [m]     (tick_count)
  std::vector<double> force;             ///< of the tissue on the tool, its size [N]             (tick_count)
  std::vector<double> depth;             ///< [m]                                                (tick_count)
  std::vector<std::int32_t> severed;     ///< elements severed in the tick                       (tick_count)
  std::vector<Spell> strokes;            ///< ticks from taking a tool to putting it away
  std::vector<Spell> cuts;               ///< ticks from the first to the last severed element of each cut
  std::vector<std::int64_t> severed_at;  ///< tick in which each element was severed; -1: never  (ElementPlaces::count)
  std::uint64_t initial_state = 0;       ///< hash of the State before the first tick
  bool has_end = true;  ///< false: it was cut off, or is still being recorded, and this is what is there
  bool replays = true;  ///< simulating the cuts again gave what was recorded; false: severed_at is what came out

  std::size_t tick_count() const { return tool.size(); }
  double seconds(std::size_t ticks) const { return double(ticks) * tick; }
};

/// Reads a whole session and simulates its cuts again, from the keyframe before each. Errors: those of
/// reading; a damaged block, named; no tool ever in the hand.
Result<SessionTrack> read_track(recordings::SessionReader& session);

/// An error with the reason if `trainee` is not of the scene of `expert`: another network, other tools, other
/// physics. What does not act on the tissue (cameras, colours) may differ.
Result<Done> check_same_scene(const recordings::SessionReader& expert, const recordings::SessionReader& trainee);

/// The tip's paths while it cuts, one for each cut [m].
std::vector<Path> cut_paths(const SessionTrack& track);

/// Where the middle of an element is at rest [m].
Vec3 rest_middle(const Model& model, std::size_t element);

/// How far below the organs' surfaces the deepest severed edge lay at rest [m]. Nothing if nothing was
/// severed or the session has no surfaces.
std::optional<double> cut_depth(const SessionTrack& track, const recordings::SessionStart& start);

}  // namespace ctpm::compare
