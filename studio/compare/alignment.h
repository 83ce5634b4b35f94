#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::compare {

/// Points of two paths that time warping matches.
struct AlignedPair {
  std::size_t a = 0, b = 0;  ///< indices into the two paths
  double distance = 0;       ///< between the two points, in the paths' unit
};

struct Alignment {
  /// From both starts to both ends; each step advances in one path or in both.
  std::vector<AlignedPair> pairs;
  double mean = 0;  ///< of the pairs' distances; a step in both paths has weight 2
  double largest = 0;
};

/// Half-width of the band: the largest offset of a pair from the diagonal, as a share of the longer path.
inline constexpr double kAlignmentBand = 0.25;

/// Dynamic time warping with the symmetric weights and the band of Sakoe and Chiba 1978. The band follows the diagonal
/// if the paths differ in length. The mean is the least possible; the weights prevent a bias towards short alignments.
/// Neither path may be empty. Time and memory grow with the band's share of a.size() * b.size().
Alignment align_paths(std::span<const Vec3> a, std::span<const Vec3> b, double band = kAlignmentBand);

}  // namespace ctpm::compare
