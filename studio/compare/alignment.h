#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::compare {

/// Points of two paths that belong together once differences of pace are taken out.
struct AlignedPair {
  std::size_t a = 0, b = 0;  ///< indices into the two paths
  double distance = 0;       ///< between the two points
};

struct Alignment {
  /// From both beginnings to both ends; each step goes on in one path or in both.
  std::vector<AlignedPair> pairs;
  double mean = 0;  ///< of the pairs' distances; a step in both paths counts twice, as two steps would
  double largest = 0;
};

/// Width of the band: pairs may be out of step by this share of the longer path.
inline constexpr double kAlignmentBand = 0.25;

/// Dynamic time warping with the symmetric weights and the band of Sakoe and Chiba 1978, laid along the
/// diagonal of paths of different length. The mean is the least possible, and no way is preferred for being
/// short. Neither path may be empty. Time and memory grow with the band's share of a.size() * b.size().
Alignment align_paths(std::span<const Vec3> a, std::span<const Vec3> b, double band = kAlignmentBand);

}  // namespace ctpm::compare
