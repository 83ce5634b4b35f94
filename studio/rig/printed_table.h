#pragma once

#include <string>
#include <vector>

namespace ctpm::rig {

/// One row of the paper's Table 1 as printed.
struct PrintedRow {
  double depth;              ///< [mm]
  double lambda, tpm, ctpm;  ///< [kPa/mm], [N], [N]
};
/// The six rows of an organ: "skin", "kidney" or "liver".
const std::vector<PrintedRow>& printed_table(const std::string& organ);

}  // namespace ctpm::rig
