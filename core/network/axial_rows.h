#pragma once

#include <vector>

#include "core/model/model.h"

namespace ctpm::network {

/// One row of Model::axial and of Model::cut_resistance.
struct AxialRow {
  std::int32_t a, b;  ///< end spheres
  AxialLaw law;
  double rest_length;               ///< [m]
  double k, c, kelvin_k;            ///< [N/m], [N s/m], [N/m]; 0 where the law has none
  std::int32_t third;               ///< -1: none
  double cut_energy, cut_friction;  ///< [J], [N]
};

/// Appends a row to the table. All arrays of the table must have their full length; see bring_back_unused().
void append(Model& model, const AxialRow& row);

/// Removes the two-sphere TPMs from the end of the table and returns them, so that the springs of another organ can go
/// before them.
std::vector<AxialRow> take_tpms(Model& model);

/// Restores the full length of the arrays that leave_out_unused() emptied.
void bring_back_unused(Model& model);

/// Empties the arrays of the table that no element uses.
void leave_out_unused(Model& model);

}  // namespace ctpm::network
