#include "core/surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

#include "core/result.h"

namespace ctpm {
namespace {

constexpr double kReachInSpacings = 2.2;
constexpr std::size_t kFewestFollowed = 8;

/// C1 bump that falls from 1 at the point to 0 at the reach.
double kernel(double distance, double reach) {
  const double q = distance / reach;
  return q >= 1 ? 0.0 : (1 - q * q) * (1 - q * q);
}

/// Buckets of spheres by lattice cell, so that neighbours of a point are found without looking at all spheres.
class CellIndex {
 public:
  explicit CellIndex(const FilledOrgan& organ) : organ_(organ) {
    origin_ = organ.centre[0] - organ.spacing * Vec3{double(organ.cell[0][0]), double(organ.cell[0][1]), double(organ.cell[0][2])};
    for (std::size_t i = 0; i < organ.cell.size(); ++i) sphere_at_.emplace(organ.cell[i], std::int32_t(i));
  }

  /// Spheres within `rings` lattice cells of the point, in the order of their index.
  std::vector<std::int32_t> near(Vec3 point, int rings) const {
    const Vec3 q = (point - origin_) / organ_.spacing;
    const std::array<int, 3> centre{int(std::floor(q.x + 0.5)), int(std::floor(q.y + 0.5)), int(std::floor(q.z + 0.5))};
    std::vector<std::int32_t> found;
    for (int k = -rings; k <= rings; ++k)
      for (int j = -rings; j <= rings; ++j)
        for (int i = -rings; i <= rings; ++i) {
          const auto it = sphere_at_.find({centre[0] + i, centre[1] + j, centre[2] + k});
          if (it != sphere_at_.end()) found.push_back(it->second);
        }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  const FilledOrgan& organ_;
  Vec3 origin_;
  std::map<std::array<std::int32_t, 3>, std::int32_t> sphere_at_;
};

/// The spheres that a vertex follows: all within reach, or the nearest few where the reach catches too few.
std::vector<std::int32_t> followed_spheres(const FilledOrgan& organ, const CellIndex& index, Vec3 point, double& reach) {
  const int sphere_count = int(organ.centre.size());
  std::vector<std::int32_t> found;
  int rings = int(std::ceil(kReachInSpacings)) + 1;
  for (; int(found.size()) < std::min<int>(sphere_count, kFewestFollowed); rings *= 2) found = index.near(point, rings);
  const auto distance = [&](std::int32_t i) { return norm(organ.centre[std::size_t(i)] - point); };
  std::stable_sort(found.begin(), found.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
  const std::size_t least = std::min(found.size(), kFewestFollowed);
  reach = std::max(kReachInSpacings * organ.spacing, 1.05 * distance(found[least - 1]));
  std::size_t count = least;
  while (count < found.size() && distance(found[count]) < reach) ++count;
  found.resize(count);
  return found;
}

}  // namespace

std::vector<double> follow_weights(Vec3 point, std::span<const Vec3> candidates, double radius) {
  CTPM_CHECK(!candidates.empty() && radius > 0, "a point needs something to follow");
  std::vector<double> weight(candidates.size());
  double total = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    total += weight[i] = kernel(norm(candidates[i] - point), radius);
  if (total <= 0) {
    // Nothing in reach: follow the nearest alone.
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i)
      if (norm(candidates[i] - point) < norm(candidates[nearest] - point)) nearest = i;
    std::fill(weight.begin(), weight.end(), 0.0);
    weight[nearest] = 1;
    return weight;
  }
  // Moments of the kernel in the basis (1, p - point), lengths in units of the radius.
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  const auto basis = [&](std::size_t i) {
    const Vec3 d = (candidates[i] - point) / radius;
    return Eigen::Vector4d(1, d.x, d.y, d.z);
  };
  for (std::size_t i = 0; i < candidates.size(); ++i) moments += weight[i] / total * basis(i) * basis(i).transpose();
  const Eigen::FullPivLU<Eigen::Matrix4d> lu(moments);
  constexpr double kSpansSpace = 1e-4;  // smallest pivot against the largest; below it the weights would explode
  const bool spans_space = std::abs(lu.matrixLU()(3, 3)) > kSpansSpace * std::abs(lu.matrixLU()(0, 0));
  const Eigen::Vector4d correction = spans_space ? Eigen::Vector4d(lu.solve(Eigen::Vector4d::UnitX())) : Eigen::Vector4d::UnitX();
  for (std::size_t i = 0; i < candidates.size(); ++i) weight[i] *= correction.dot(basis(i)) / total;
  return weight;
}

void bind_surface(FilledOrgan& organ) {
  CTPM_CHECK(!organ.centre.empty(), "binding needs spheres");
  const CellIndex index(organ);
  SurfaceBinding& binding = organ.surface.binding;
  binding = {};
  binding.first.push_back(0);
  std::vector<Vec3> centres;
  for (const Vec3& vertex : organ.surface.vertex) {
    double reach = 0;
    const std::vector<std::int32_t> spheres = followed_spheres(organ, index, vertex, reach);
    centres.clear();
    for (const std::int32_t i : spheres) centres.push_back(organ.centre[std::size_t(i)]);
    const std::vector<double> weights = follow_weights(vertex, centres, reach);
    binding.sphere.insert(binding.sphere.end(), spheres.begin(), spheres.end());
    binding.weight.insert(binding.weight.end(), weights.begin(), weights.end());
    binding.first.push_back(std::int32_t(binding.sphere.size()));
  }
}

void deform_surface(const Surface& surface, const Vec3Array& position, std::int32_t first_sphere,
                    std::vector<Vec3>& vertex) {
  const SurfaceBinding& binding = surface.binding;
  vertex.assign(surface.vertex.size(), Vec3{});
  for (std::size_t v = 0; v < vertex.size(); ++v)
    for (std::int32_t entry = binding.first[v]; entry < binding.first[v + 1]; ++entry)
      vertex[v] += binding.weight[std::size_t(entry)] * position[std::size_t(first_sphere + binding.sphere[std::size_t(entry)])];
}

}  // namespace ctpm
