#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/result.h"

namespace ctpm::sources {

/// One row of a motion.
struct MotionSample {
  double time = 0;       ///< [s], rising from sample to sample; any origin
  Inputs inputs;         ///< the orientation has unit length
  std::size_t line = 0;  ///< of its file
};

/// A measured motion of the hand, at any sampling rate.
struct Motion {
  std::vector<MotionSample> samples;        ///< at least one
  std::vector<std::string> unused_columns;  ///< names of columns that are ignored
};

/// Reads a motion from CSV: values separated by commas, column names in the first row, in any order. The names are
/// those that `ctpm replay --csv` writes:
///   time_s                               required, rising
///   tool_x_mm, tool_y_mm, tool_z_mm      required: the tool frame's origin in the scene
///   tool_qw, tool_qx, tool_qy, tool_qz   its orientation, of length 1 to 10 %; all four or none: upright
///   buttons                              bit set as a whole number; none pressed if left out
///   tool                                 name of a tool of the scene, empty: none; the first tool if left out
/// Errors, all at once as `file:line:column`: columns missing or twice, rows of another length, values that are
/// no finite number or out of range, time that does not rise, tools that the scene does not have.
Result<Motion> read_motion(std::string_view text, const std::string& file_name, const std::vector<Tool>& tools);

/// The motion at `time` after its first sample [s]. Positions are interpolated linearly, orientations along the
/// shortest rotation; tool and buttons are those of the earlier sample. Constant before the first and after the last
/// sample.
Inputs motion_at(const Motion& motion, double time);

/// Ticks of length `tick` [s] from the first to the last sample, both included.
std::int64_t motion_tick_count(const Motion& motion, double tick);

}  // namespace ctpm::sources
