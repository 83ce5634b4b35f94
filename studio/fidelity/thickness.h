#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/organ.h"

// Where an organ is too thin for its spheres.
namespace ctpm::fidelity {

/// Tissue needs two spacings across to resist bending: one sheet of spheres folds like cloth.
inline constexpr double kLeastSpacingsAcross = 2;

/// Error of local_thickness(), in spacings: that of a lattice line which misses the thinnest place.
inline constexpr double kThicknessError = 0.5;

/// Thickness of the tissue at each sphere [m], from the depths of the spheres: along the lattice line that follows the
/// steepest growth of depth, its run of spheres and the depths of its two ends. In the middle of a sheet and at corners
/// depth does not grow, and the shortest of the three axis lines counts. Known to about kThicknessError; 0 or more
/// (sphere_count).
std::vector<double> local_thickness(const FilledOrgan& organ);

/// Spheres in tissue that is thinner than kLeastSpacingsAcross.
struct ThinParts {
  std::int64_t spheres = 0;
  double share = 0;     ///< of all spheres of the organ
  double thinnest = 0;  ///< [m]; 0 if there are none
  Vec3 place;           ///< of the thinnest [m]
};
ThinParts find_thin_parts(const FilledOrgan& organ);

/// What is told of an organ's thin parts; empty: it has none.
std::string thin_parts_text(const FilledOrgan& organ);

}  // namespace ctpm::fidelity
