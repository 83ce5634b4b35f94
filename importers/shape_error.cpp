#include "importers/shape_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "importers/in_pieces.h"
#include "importers/text.h"

namespace ctpm::importers {
namespace {

constexpr double kShare = 0.95;
constexpr double kStep = 0.25;  // between points of the surface, in spacings

/// A point of a boundary, how much it counts, and its distance from the other one.
struct Sample {
  Vec3 at;              ///< [m]
  double weight = 0;    ///< area [m^2], or tissue [spacings cubed]
  double distance = 0;  ///< [m]
};

/// Adds points of a triangle in rows along its longest edge, about `step` apart.
void add_points(Vec3 a, Vec3 b, Vec3 c, double step, std::vector<Sample>& samples) {
  if (norm(c - b) > norm(b - a)) std::swap(a, c);
  if (norm(c - a) > norm(b - a)) std::swap(b, c);
  const double base = norm(b - a), area = 0.5 * norm(cross(b - a, c - a));
  if (!(area > 0)) return;
  const double rows = std::max(1.0, std::ceil(2 * area / base / step));
  for (double row = 0; row < rows; ++row) {
    const double below = 1 - row / rows, above = 1 - (row + 1) / rows, middle = 0.5 * (below + above);
    const Vec3 left = c + middle * (a - c), right = c + middle * (b - c);
    const double points = std::max(1.0, std::ceil(middle * base / step));
    for (double point = 0; point < points; ++point)
      samples.push_back(
          {left + (point + 0.5) / points * (right - left), area * (below * below - above * above) / points, 0});
  }
}

/// Points spread evenly over the mesh: in a fine one some triangles stand for those before them, so that there are no
/// more points than the spheres need.
std::vector<Sample> points_of(const CheckedMesh& mesh, double step) {
  std::vector<Sample> samples;
  double small = 0;  // area of triangles that have no point yet
  for (const Triangle& t : mesh.triangle) {
    const Vec3 a = mesh.vertex[std::size_t(t[0])], b = mesh.vertex[std::size_t(t[1])],
               c = mesh.vertex[std::size_t(t[2])];
    const double area = 0.5 * norm(cross(b - a, c - a));
    if (area > step * step) {
      add_points(a, b, c, step, samples);
    } else if ((small += area) > step * step) {
      samples.push_back({(a + b + c) / 3, small, 0});
      small = 0;
    }
  }
  return samples;
}

/// Points of the surface, with their distances from the nearest sphere's boundary.
std::vector<Sample> from_surface(const CheckedMesh& mesh, const Cover& cover, double radius, int threads) {
  std::vector<Sample> samples = points_of(mesh, kStep * cover.lattice.spacing);
  const CellLookup lookup(cover.lattice, cover.cell);
  in_pieces(samples.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      samples[n].distance = std::abs(std::sqrt(lookup.nearest_squared_distance(samples[n].at)) - radius);
  });
  return samples;
}

/// The outermost points of the outer spheres, each with the tissue that it stands for, and their distances from the
/// surface. A sphere far outside, at the corner of a cell that the surface just meets, stands for little.
std::vector<Sample> from_spheres(const Cover& cover, const std::vector<double>& depth, double radius) {
  std::vector<Sample> samples;
  const CellLookup lookup(cover.lattice, cover.cell);
  for (std::size_t n = 0; n < cover.cell.size(); ++n) {
    bool is_outer = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Cell beside = cover.cell[n];
        beside[axis] += step;
        is_outer = is_outer || lookup.find(beside) < 0;
      }
    if (is_outer)
      samples.push_back({cover.lattice.at(cover.cell[n]), cover.shares.sphere[n], std::abs(radius - depth[n])});
  }
  return samples;
}

/// The distance within which so much of the weight lies, and the largest.
ShapeError figures_of(std::vector<Sample> samples) {
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.distance < b.distance; });
  double whole = 0, sum = 0;
  for (const Sample& sample : samples) whole += sample.weight;
  for (const Sample& sample : samples)
    if ((sum += sample.weight) >= kShare * whole) return {sample.distance, samples.back().distance};
  return {};
}

}  // namespace

ShapeError measure_shape(const CheckedMesh& mesh, const Cover& cover, const std::vector<double>& depth, double radius,
                         int threads) {
  const ShapeError surface = figures_of(from_surface(mesh, cover, radius, threads));
  const ShapeError spheres = figures_of(from_spheres(cover, depth, radius));
  return {std::max(surface.p95, spheres.p95), std::max(surface.largest, spheres.largest)};
}

std::string to_text(const ShapeError& error) {
  return "from the spheres' outer boundary to the surface: 95 % within " + mm_text(error.p95) + ", all within " +
         mm_text(error.largest);
}

}  // namespace ctpm::importers
