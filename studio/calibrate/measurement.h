#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"

namespace ctpm::calibrate {

/// How a ball was pressed into tissue.
enum class Kind {
  indentation,  ///< to depths, so slowly that the tissue had crept at each; depth_mm, force_n
  relaxation,   ///< along a depth over time, the force was measured; time_s, depth_mm, force_n
  creep         ///< under a load, the depth was measured; time_s, load_n, depth_mm
};
/// "indentation", ...
const char* to_word(Kind kind);

struct Row {
  double time = 0;      ///< [s]
  double imposed = 0;   ///< depth [mm] or load [N]
  double measured = 0;  ///< force [N] or depth [mm]
};

/// One specimen of one file.
struct Measurement {
  std::string name;      ///< file and specimen
  std::string specimen;  ///< as its column says, the same in several files; files without one are of one specimen
  Kind kind = Kind::indentation;
  std::vector<Row> rows;

  const char* measured_unit() const { return kind == Kind::creep ? "mm" : "N"; }
};

/// Reads measurements from CSV: the columns of one Kind in the first row, in any order, and `specimen` if there are
/// several. Creep begins at 0 N, at time 0; the load may rise to its last value and stays there. Errors, all at once as
/// `file:line:column`: columns that are missing, twice or unknown; values that are no finite numbers or out of range;
/// time that does not rise; fewer than three rows of a specimen; forces that pull.
Result<std::vector<Measurement>> read_measurements(std::string_view text, const std::string& file_name);

}  // namespace ctpm::calibrate
