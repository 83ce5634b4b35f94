#include "studio/compare/path_distance.h"

#include <algorithm>
#include <cmath>

#include "core/model/result.h"

namespace ctpm::compare {
namespace {

double distance_from_segment(Vec3 point, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const double length2 = dot(along, along);
  const double share = length2 > 0 ? std::clamp(dot(point - a, along) / length2, 0.0, 1.0) : 0.0;
  return norm(point - (a + share * along));
}

/// Sum and maximum of the distances to `to` of points every `spacing` along `from`.
struct OneWay {
  double sum = 0, largest = 0;
  std::size_t count = 0;
};

/// A path whose distance from points is asked for often, each near the one before.
class Way {
 public:
  explicit Way(const Path& path) : path_(path), along_(path.size(), 0.0) {
    for (std::size_t i = 1; i < path.size(); ++i) along_[i] = along_[i - 1] + norm(path[i] - path[i - 1]);
  }

  /// As distance_from(). A place on the path is at least as far as another one less the way between the two: most
  /// pieces need no look.
  double distance_to(Vec3 point) {
    constexpr double kSlack = 1e-9;  // more than rounding, as a share
    if (path_.size() == 1) return norm(point - path_.front());
    double nearest = distance_from_segment(point, path_[last_ - 1], path_[last_]);
    for (std::size_t i = 1; i < path_.size();) {
      if (const double here = distance_from_segment(point, path_[i - 1], path_[i]); here < nearest)
        nearest = here, last_ = i;
      const double reach = along_[i] + (1 - kSlack) * norm(point - path_[i]) - nearest - kSlack * along_.back();
      i = std::size_t(std::lower_bound(along_.begin() + std::ptrdiff_t(i) + 1, along_.end(), reach) - along_.begin());
    }
    return nearest;
  }

 private:
  const Path& path_;
  std::vector<double> along_;  ///< length of the way to each point
  std::size_t last_ = 1;       ///< end of the piece that was the nearest one
};

OneWay distances(std::span<const Path> from, std::span<const Path> to, double spacing) {
  std::vector<Way> ways(to.begin(), to.end());
  OneWay result;
  for (const Path& path : from)
    for (const Vec3& point : with_points_every(path, spacing)) {
      double distance = INFINITY;
      for (Way& way : ways) distance = std::min(distance, way.distance_to(point));
      result.sum += distance, result.largest = std::max(result.largest, distance), ++result.count;
    }
  return result;
}

}  // namespace

Path with_points_every(std::span<const Vec3> path, double spacing) {
  Path points;
  if (!path.empty()) points.push_back(path.front());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int pieces = std::max(1, int(std::ceil(norm(path[i] - path[i - 1]) / spacing - 1e-9)));
    for (int piece = 1; piece <= pieces; ++piece)
      points.push_back(path[i - 1] + (double(piece) / pieces) * (path[i] - path[i - 1]));
  }
  return points;
}

double distance_from(Vec3 point, std::span<const Path> paths) {
  double nearest = INFINITY;
  for (const Path& path : paths) {
    if (path.size() == 1) nearest = std::min(nearest, norm(point - path.front()));
    for (std::size_t i = 1; i < path.size(); ++i)
      nearest = std::min(nearest, distance_from_segment(point, path[i - 1], path[i]));
  }
  return nearest;
}

PathDistance distance_between(std::span<const Path> a, std::span<const Path> b, double spacing) {
  const OneWay there = distances(a, b, spacing), back = distances(b, a, spacing);
  CTPM_CHECK(there.count > 0 && back.count > 0, "paths that are compared have points");
  return {(there.sum + back.sum) / double(there.count + back.count), std::max(there.largest, back.largest)};
}

}  // namespace ctpm::compare
