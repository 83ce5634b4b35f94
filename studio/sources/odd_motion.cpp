#include "studio/sources/odd_motion.h"

#include <algorithm>
#include <cstddef>

#include "studio/output/number_text.h"

namespace ctpm::sources {
namespace {

constexpr double kMostSpeed = 2;         ///< of a hand [m/s]
constexpr double kPause = 0.1;           ///< [s]; shorter ones are those of a slow logger
constexpr double kPauseInIntervals = 5;  ///< of the usual interval between rows
constexpr double kMovedInPause = 1e-3;   ///< [m]
constexpr double kSlowRows = 2;          ///< between rows [s]
constexpr std::size_t kFewRows = 10;     ///< fewer are written by hand
constexpr double kNear = 2e-3;           ///< of the scene's origin, where a hand that moves does not stay [m]
constexpr double kMoved = 1e-5;          ///< what a place of a file moves that is no rounding [m]

/// From one row to the next one, of one tool.
struct Interval {
  std::size_t line = 0;  ///< of the later row
  double seconds = 0, way = 0;
};

std::vector<Interval> intervals_of(const Motion& motion) {
  std::vector<Interval> all;
  for (std::size_t i = 1; i < motion.samples.size(); ++i) {
    const MotionSample &a = motion.samples[i - 1], &b = motion.samples[i];
    if (a.inputs.tool >= 0 && a.inputs.tool == b.inputs.tool)
      all.push_back({b.line, b.time - a.time, norm(b.inputs.position - a.inputs.position)});
  }
  return all;
}

bool seems_to_be_in_metres(const Motion& motion) {
  double farthest = 0, moved = 0;
  for (const MotionSample& sample : motion.samples) {
    if (sample.inputs.tool < 0) continue;
    farthest = std::max(farthest, norm(sample.inputs.position));
    moved = std::max(moved, norm(sample.inputs.position - motion.samples.front().inputs.position));
  }
  return motion.samples.size() >= kFewRows && farthest <= kNear && moved >= kMoved;
}

}  // namespace

Errors find_odd_motion(const Motion& motion, const std::string& file) {
  using output::short_number;
  Errors found;
  if (seems_to_be_in_metres(motion))
    found.push_back({file, "all its places lie within 2 mm of the scene's origin",
                     "tool_x_mm, tool_y_mm and tool_z_mm are in millimetres"});
  const std::vector<Interval> intervals = intervals_of(motion);
  if (intervals.empty()) return found;
  std::vector<double> times;
  for (const Interval& interval : intervals) times.push_back(interval.seconds);
  const auto middle = times.begin() + std::ptrdiff_t(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  const double usual = *middle;
  if (usual >= kSlowRows && intervals.size() >= kFewRows)
    found.push_back({file, "its rows are " + short_number(usual) + " s apart", "time_s is in seconds"});

  const auto line_of = [&](const Interval& interval) { return file + ":" + std::to_string(interval.line); };
  const auto is_fast = [](const Interval& i) { return i.way > kMostSpeed * i.seconds; };
  if (const auto fast = std::find_if(intervals.begin(), intervals.end(), is_fast); fast != intervals.end())
    found.push_back({line_of(*fast),
                     "the tool goes " + short_number(1e3 * fast->way, 3) + " mm in " +
                         short_number(1e3 * fast->seconds, 3) + " ms, " + short_number(fast->way / fast->seconds, 3) +
                         " m/s",
                     "no hand is so fast"});
  const auto is_pause = [&](const Interval& i) {
    return i.seconds > std::max(kPause, kPauseInIntervals * usual) && i.way > kMovedInPause;
  };
  const auto pauses = std::count_if(intervals.begin(), intervals.end(), is_pause);
  if (pauses == 0) return found;
  const Interval first = *std::find_if(intervals.begin(), intervals.end(), is_pause);
  found.push_back({line_of(first),
                   "nothing was written for " + short_number(first.seconds, 3) + " s, in which the tool went " +
                       short_number(1e3 * first.way, 3) + " mm" +
                       (pauses > 1 ? ", the first of " + std::to_string(pauses) + " such pauses" : std::string()),
                   "it is taken to have gone straight"});
  return found;
}

}  // namespace ctpm::sources
