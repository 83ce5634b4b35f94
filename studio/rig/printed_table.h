#pragma once

#include <string>
#include <vector>

namespace ctpm::rig {

/// What the paper prints in its Table 1.
struct PrintedRow {
  double depth;              ///< [mm]
  double lambda, tpm, ctpm;  ///< [kPa/mm], [N], [N]
};
/// The six rows of an organ: "skin", "kidney" or "liver".
const std::vector<PrintedRow>& printed_table(const std::string& organ);

}  // namespace ctpm::rig
