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

OneWay distances(std::span<const Path> from, std::span<const Path> to, double spacing) {
  OneWay result;
  for (const Path& path : from)
    for (const Vec3& point : with_points_every(path, spacing)) {
      const double distance = distance_from(point, to);
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
