#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "core/model/vec3.h"
#include "recordings/session_reader.h"
#include "studio/compare/alignment.h"
#include "studio/compare/session_track.h"

namespace ctpm::compare {

/// The way of a session's tool in all its strokes, as it is aligned: 50 points a second, fewer in a long session.
struct TimedPath {
  std::vector<Vec3> place;   ///< [m]
  std::vector<double> time;  ///< [s]
};
TimedPath tool_path(const SessionTrack& track);

/// Seconds of two sessions that belong together, neither ever decreasing.
using MatchedMoments = std::vector<std::array<double, 2>>;

/// The least pace of either of two sessions along a path, beside that of the other: none crawls or repeats itself while
/// the other goes on, and what one is behind it makes up for later. It is a share of the pace at which the shorter one
/// would take as long as the longer one [s].
inline constexpr double kLeastPace = 0.4;
double least_pace(double a_s, double b_s);

/// Those along an alignment of two tools' ways, about `least_s` [s] apart in one of them, smoothed over some of them
/// and no slower than least_pace() from one to the next.
MatchedMoments along_path(const Alignment& alignment, const std::vector<double>& time_a,
                          const std::vector<double>& time_b, double least_s);

/// What two sessions are brought together by: `path` of the tool, first `contact`, first `cut`, `clock`, which needs no
/// moments, or by hand: a number, the seconds that the clock of the second session shows more. Empty: the first of
/// path, contact and clock that both have. Errors: another word; seconds by which they have no moment in common; a
/// session that has no such event, or no tool's way in the scene of the other; a damaged session.
Result<MatchedMoments> match_sessions(recordings::SessionReader& a, recordings::SessionReader& b,
                                      const std::string& by);

}  // namespace ctpm::compare
