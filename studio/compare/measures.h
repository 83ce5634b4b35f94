#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/compare/alignment.h"
#include "studio/compare/session_track.h"

namespace ctpm::compare {

/// Which value of a measure indicates more skill.
enum class Direction {
  lower,   ///< the lower one
  higher,  ///< the higher one
  nearer,  ///< the one nearer to the expert's
};

/// "lower", "higher", "as the expert".
const char* to_word(Direction direction);

/// One measure of skill.
struct Measure {
  const char* key;    ///< name in JSON, contains the unit
  const char* title;  ///< name for people
  const char* unit;   ///< "1" if it has none
  Direction direction;
  const char* meaning;  ///< one sentence
  const char* source;   ///< who published it
  double rounding = 0;  ///< differences up to this are none, in `unit`
  /// It grows with how deep and how long a tool works: where less was done, lower says nothing of skill.
  bool grows_with_work = false;
};

/// The values of a measure for both sessions, or one value for the pair.
struct MeasuredValue {
  const Measure* measure = nullptr;
  std::optional<double> expert = {}, trainee = {};  ///< in the measure's unit; expert unset for measures of the pair
  std::string note = {};                            ///< why there is no value; empty if there is one
  bool less_done = false;  ///< the trainee reached less than the expert, with which the measure grows
};

enum class MomentKind { zone, stray_cut, force, depth, deviation, pause };

/// "force above the limit", "deeper than the damage limit" ...
const char* to_word(MomentKind kind);

/// An interval of the trainee's session that a teacher would show.
struct Moment {
  MomentKind kind = MomentKind::force;
  double from_s = 0, to_s = 0, worst_s = 0;
  double value = 0, limit = 0;  ///< the worst value, and its limit, in `unit`; 0: it has none
  const char* unit = "";
  /// (value / limit - 1) T / (T + 0.1 s) for what lasts for T, so that a tick beyond a limit is next to nothing; of a
  /// stray cut its elements over those that the expert severed; of a forbidden zone the seconds in it. It tells
  /// moments of one Concern apart.
  double severity = 0;
};

struct CompareOptions {
  /// [N], > 0; unset: the scene's limit, or else 1 % above the expert's peak force.
  std::optional<double> force_limit = {};
  double damage_force = 0;  ///< the scene's limit [N]; 0: it has none
};

/// How the way of the trainee's tool in the tissue runs beside the expert's.
enum class Way { same, backwards, mirrored_x, mirrored_y };

/// Values that differ by a smaller share are the same.
inline constexpr double kSameShare = 0.01;

/// Of the worst moments, those that a page shows in pictures and marks in its plots.
inline constexpr std::size_t kShownMoments = 4;

/// The whole result of comparing a trainee's session with an expert's.
struct Comparison {
  std::optional<double> force_limit;  ///< [N]; unset: no limit, and the expert never touched the tissue
  const char* force_limit_from = "";  ///< "given", "the scene", "1 % above the expert's peak"
  double damage_depth = 0;            ///< smallest limit of the scene's organs [m]; 0: no limit
  double path_limit = 0;              ///< half of the smallest sphere spacing: beyond it other spheres are nearer [m]
  std::vector<MeasuredValue> values;  ///< in the order of a report
  std::vector<Moment> moments;        ///< in the order of worst_moments()
  Alignment alignment;                ///< of the paths below; a: the expert's
  Way way = Way::same;
  std::vector<Vec3> expert_path, trainee_path;    ///< of the tool, as aligned [m]
  std::vector<double> expert_time, trainee_time;  ///< of the points of these paths [s]
};

/// Compares a trainee's session with an expert's of the same scene (check_same_scene).
Comparison compare_sessions(const SessionTrack& expert, const SessionTrack& trainee,
                            const recordings::SessionStart& scene, const CompareOptions& options = {});

}  // namespace ctpm::compare
