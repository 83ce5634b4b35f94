#include "studio/session/depth_along_blade.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ctpm::session {
namespace {

/// Tissue that is thinner than this, or a gap in it, may be missed [m].
constexpr double kStep = 0.5e-3;
/// Tissue holds places of an edge this far behind a straight line, as far as Tool::trail_distance by default [m].
constexpr double kHeldBehind = 0.2e-3;

class Organ {
 public:
  Organ(const cutting::TissueDepth& tissue, std::size_t organ) : tissue_(tissue), organ_(organ) {}

  bool holds(Vec3 place) const { return tissue_.at(organ_, place) > 0; }

  /// The first place in the organ on a line.
  std::optional<Vec3> enter(Vec3 from, Vec3 to) const {
    const double steps = std::max(1.0, std::ceil(norm(to - from) / kStep));
    for (double i = 0; i <= steps; ++i)
      if (const Vec3 at = from + i / steps * (to - from); holds(at))
        return i > 0 ? skin(at, at - 1 / steps * (to - from)) : at;
    return std::nullopt;
  }

  /// Where a line of unit direction `way` leaves the organ.
  Vec3 leave(Vec3 inside, Vec3 way) const {
    Vec3 next = inside + kStep * way;
    for (; holds(next); next += kStep * way) inside = next;
    return skin(inside, next);
  }

 private:
  Vec3 skin(Vec3 inside, Vec3 outside) const {
    constexpr int kHalvings = 8;
    for (int i = 0; i < kHalvings; ++i) {
      const Vec3 middle = 0.5 * (inside + outside);
      (holds(middle) ? inside : outside) = middle;
    }
    return 0.5 * (inside + outside);
  }

  const cutting::TissueDepth& tissue_;
  std::size_t organ_;
};

/// The first place in the organ along places that follow each other.
template <class Iterator>
std::optional<Vec3> enter(const Organ& organ, Iterator from, Iterator end) {
  for (; from != end; ++from)
    if (const std::optional<Vec3> at = organ.enter(*from, from + 1 == end ? *from : *(from + 1))) return at;
  return std::nullopt;
}

}  // namespace

double depth_along_blade(const cutting::TissueDepth& tissue, std::size_t of_organ, const EdgePlaces& edge, Vec3& way) {
  const Organ organ(tissue, of_organ);
  std::vector<Vec3> place = edge.place;
  // As far below the first place as the next one is above it the edge goes on, in tissue that was cut before or
  // outside.
  if (!edge.from_tip && place.size() > 1)
    if (const Vec3 below = 2 * place[0] - place[1]; !organ.holds(below)) place.insert(place.begin(), below);
  const std::optional<Vec3> deepest = enter(organ, place.begin(), place.end());
  if (!deepest) return 0;
  // A single place that is inside by rounding may not be found again.
  const Vec3 highest = enter(organ, place.rbegin(), place.rend()).value_or(*deepest);
  const Vec3 own = highest - *deepest;
  const bool is_along_earlier = dot(own, way) >= 0 && norm(cross(own, way)) <= kHeldBehind * norm(way);
  if (norm(own) >= norm(way) || !is_along_earlier) way = own;
  if (!organ.holds(place.back()) || norm(way) == 0) return norm(own);
  return norm(organ.leave(highest, 1 / norm(way) * way) - *deepest);
}

}  // namespace ctpm::session
