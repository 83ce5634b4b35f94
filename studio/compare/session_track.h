#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "core/model/vec3.h"
#include "recordings/session_reader.h"
#include "studio/compare/motion.h"
#include "studio/compare/path_distance.h"
#include "studio/session/cut_measures.h"

namespace ctpm::compare {

/// Offsets of the kinds of element in one list of all elements: axial elements, constraints, angle springs.
struct ElementPlaces {
  std::size_t constraints, angle_springs, count;  ///< first index of each kind; axial elements begin at 0
  explicit ElementPlaces(const Model& model);
};

/// How far a probe of the scene is from where it was before the first tick.
struct ProbeWay {
  std::string name;
  std::vector<double> way;  ///< [m]   (tick_count)
};

/// The recorded actions and measurements of a session, tick by tick, of the hand that works: with two hands the one
/// that cuts, or if none does the one that holds a tool for longer.
struct SessionTrack {
  std::string path, session_id, scene_name;
  double tick = 0;                  ///< [s]
  std::size_t hand = 0;             ///< that works, in Inputs
  std::vector<std::int32_t> tool;   ///< held; -1: none                                      (tick_count)
  std::vector<Vec3> tip;            ///< of the tool: a ball's centre, a blade's tip [m]     (tick_count)
  std::vector<double> force;        ///< magnitude of the tissue's force on the tool [N]    (tick_count)
  std::vector<double> depth;        ///< [m]                                                (tick_count)
  std::vector<double> blade_depth;  ///< of a held blade in the tissue at rest, along the blade [m], where it was
                                    ///< replayed; empty: no blade (tick_count)
  std::vector<double> other_force;  ///< as `force`, on the tool in the other hand; empty: there is none (tick_count)
  std::vector<double> work;         ///< of the tool against that force [J]; empty: not known         (tick_count)
  std::vector<std::int32_t> organ;  ///< that the tool touches most, in Model::organs; -1: none; empty: not known, of a
                                    ///< session with several organs that was not replayed          (tick_count)
  std::vector<std::string> zones;   ///< forbidden ones of the scene
  std::vector<std::int32_t> zone;   ///< in which the tool is, of `zones`; -1: none; empty: no zones   (tick_count)
  std::vector<std::int32_t> severed;     ///< elements severed in the tick                       (tick_count)
  std::vector<Spell> strokes;            ///< ticks in which one tool is held without a break
  std::vector<Spell> cuts;               ///< ticks from the first to the last severed element of each cut
  std::vector<std::int64_t> severed_at;  ///< tick in which each element was severed; -1: never  (ElementPlaces::count)
  std::optional<session::CutSize> cut;   ///< none if nothing was cut, or without surfaces
  std::vector<ProbeWay> probes;          ///< where the session was replayed whole; else empty
  std::uint64_t initial_state = 0;       ///< hash of the State before the first tick
  bool has_end = true;                   ///< false: the session is incomplete, or still being recorded
  double slip = 0;                       ///< largest TickRecord::slip [s]: real time that the session lacks
  bool is_timed =
      true;  ///< its times are those of the hand: no hand moved it, or it lacks at most 1 % of the real time
  bool is_verified = false;  ///< every tick replays as recorded: force, depth and severed are those of the replay
  bool replays = true;       ///< replaying the cuts gave the recorded hashes; false: severed_at is that of the replay

  std::size_t tick_count() const { return tool.size(); }
  bool works(std::size_t i) const { return force[i] > 0 || severed[i] > 0; }  ///< in tick i the tool touches or cuts
  double seconds(std::size_t ticks) const { return double(ticks) * tick; }
};

/// Reads the ticks of a session without replaying any: severed_at stays empty. Errors: a damaged block, named.
Result<SessionTrack> read_recorded(recordings::SessionReader& session);

/// Which sessions are replayed whole before they are measured.
enum class Replaying {
  short_ones,  ///< those up to kShortSession
  all,
  none,  ///< of cuts alone
  ends,  ///< nothing but cuts after the last keyframe: what is severed in the end, and the size of the cuts
};
inline constexpr double kShortSession = 30;  ///< [s]

/// Hears in which tick a replay is; false ends it.
using ReplayWatch = std::function<bool(std::int64_t tick)>;

/// Reads a whole session and replays it, or each cut alone from the keyframe before it. `watch`, if given, hears each
/// replayed tick, and the last one when all is read. Errors: those of reading; a damaged block, named; no tool is ever
/// held; `watch` ended it.
Result<SessionTrack> read_track(recordings::SessionReader& session, Replaying replaying = Replaying::short_ones,
                                const ReplayWatch& watch = {});

/// Checks that both sessions have the same Model: network, tools and physics. Values that do not act on the tissue
/// (cameras, colours), or hardly (solver.velocity_enough), may differ, and names if one of the sessions is anonymised.
/// Errors: the first difference.
Result<Done> check_same_scene(const recordings::SessionReader& expert, const recordings::SessionReader& trainee);

/// Whether names of organs, tools and obstacles tell scenes apart. Anonymised sessions hold pseudonyms of them.
enum class Names { count, do_not_count };

/// What differs between two Models, in words; empty: nothing.
std::string scene_difference(const Model& expert, const Model& other, Names names = Names::count);

/// A number that two Models share where scene_difference() finds nothing, and else almost never.
std::uint64_t scene_hash(const Model& model, Names names = Names::count);

/// The paths of the tool's tip during each cut [m].
std::vector<Path> cut_paths(const SessionTrack& track);

/// Middle of an element at rest [m].
Vec3 rest_middle(const Model& model, std::size_t element);

}  // namespace ctpm::compare
