#include "core/cutting/rest_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/cutting/lattice_frame.h"

namespace ctpm::cutting {
namespace {

/// Most spacings within which spheres carry a place, so that they are not too many.
constexpr double kFarthest = 2.6;

/// Smallest pivot relative to 1 for which spheres count as spanning space.
constexpr double kSpansSpace = 1e-7;

/// C2 bump: 1 at the place, 0 at the reach.
double kernel(double squared_share) {
  const double bump = std::max(0.0, 1 - squared_share);
  return bump * bump * bump;
}

using Row = std::array<double, 4>;
using Matrix = std::array<Row, 4>;

/// Inverts a matrix by elimination with pivots; false if it is singular.
bool invert(Matrix m, Matrix& inverse) {
  inverse = {};
  for (std::size_t i = 0; i < 4; ++i) inverse[i][i] = 1;
  for (std::size_t column = 0; column < 4; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < 4; ++row)
      if (std::abs(m[row][column]) > std::abs(m[pivot][column])) pivot = row;
    if (!(std::abs(m[pivot][column]) > kSpansSpace)) return false;
    std::swap(m[pivot], m[column]), std::swap(inverse[pivot], inverse[column]);
    const double scale = 1 / m[column][column];
    for (std::size_t i = 0; i < 4; ++i) m[column][i] *= scale, inverse[column][i] *= scale;
    for (std::size_t row = 0; row < 4; ++row) {
      if (row == column) continue;
      const double factor = m[row][column];
      for (std::size_t i = 0; i < 4; ++i)
        m[row][i] -= factor * m[column][i], inverse[row][i] -= factor * inverse[column][i];
    }
  }
  return true;
}

}  // namespace

Vec3 Place::at(const Vec3Array& position) const {
  Vec3 sum = offset;
  for (std::size_t i = 0; i < std::size_t(count); ++i) sum += weight[i] * position[std::size_t(sphere[i])];
  return sum;
}

Vec3 Place::at_rest(const Vec3Array& position, Vec3 move) const {
  if (!spans_space) return move;
  // Columns of the deformation gradient.
  Vec3 x, y, z;
  for (std::size_t i = 0; i < std::size_t(count); ++i) {
    const Vec3 p = position[std::size_t(sphere[i])];
    x += slope[i].x * p, y += slope[i].y * p, z += slope[i].z * p;
  }
  const Vec3 yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const double volume = dot(x, yz);
  constexpr double kFlat = 0.05;  // volume ratio, and length ratio along the move
  if (!(volume > kFlat)) return {};
  const Vec3 rest = Vec3{dot(yz, move), dot(zx, move), dot(xy, move)} / volume;
  const double length = norm(rest), most = norm(move) / kFlat;
  return length > most ? most / length * rest : rest;
}

RestMap::RestMap(const Model& model) : model_(model) {
  for (const OrganRange& organ : model.organs) lattices_.push_back(make_lattice(organ));
}

RestMap::Lattice RestMap::make_lattice(const OrganRange& organ) const {
  Lattice lattice;
  lattice.first = organ.first, lattice.count = organ.count, lattice.spacing = organ.spacing;
  if (organ.count == 0 || !(organ.spacing > 0)) return lattice;
  const LatticeFrame frame = lattice_frame(model_, organ);
  lattice.origin = frame.origin;
  for (std::size_t a = 0; a < 3; ++a) lattice.axis[a] = frame.axis[a];
  const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
  LatticeCell high = lattice.low = model_.cell[first];
  for (std::size_t i = first; i < last; ++i) {
    lattice.largest_mass = std::max(lattice.largest_mass, model_.mass[i]);
    const LatticeCell cell = model_.cell[i];
    for (std::size_t a = 0; a < 3; ++a)
      lattice.low[a] = std::min(lattice.low[a], cell[a]), high[a] = std::max(high[a], cell[a]);
  }
  for (std::size_t a = 0; a < 3; ++a) lattice.extent[a] = high[a] - lattice.low[a] + 1;
  const LatticeCell e = lattice.extent;
  lattice.sphere_at.assign(std::size_t(e[0]) * std::size_t(e[1]) * std::size_t(e[2]), -1);
  for (std::size_t i = first; i < last; ++i) {
    const LatticeCell c = model_.cell[i];
    const auto at = std::size_t(c[0] - lattice.low[0]) +
                    std::size_t(e[0]) *
                        (std::size_t(c[1] - lattice.low[1]) + std::size_t(e[1]) * std::size_t(c[2] - lattice.low[2]));
    lattice.sphere_at[at] = std::int32_t(i);
  }
  return lattice;
}

std::int32_t RestMap::Lattice::at(std::int32_t i, std::int32_t j, std::int32_t k) const {
  i -= low[0], j -= low[1], k -= low[2];
  if (i < 0 || j < 0 || k < 0 || i >= extent[0] || j >= extent[1] || k >= extent[2]) return -1;
  return sphere_at[std::size_t(i) +
                   std::size_t(extent[0]) * (std::size_t(j) + std::size_t(extent[1]) * std::size_t(k))];
}

Vec3 RestMap::Lattice::in_cells(Vec3 rest) const {
  const Vec3 d = (rest - origin) / spacing;
  return {dot(d, axis[0]), dot(d, axis[1]), dot(d, axis[2])};
}

/// The lowest and the highest cell at most so many cells away along each axis; there is none if low > high.
std::pair<LatticeCell, LatticeCell> RestMap::Lattice::cells_within(Vec3 rest, double cells) const {
  const Vec3 c = in_cells(rest);
  LatticeCell from{}, to{-1, -1, -1};
  if (sphere_at.empty() || !std::isfinite(c.x + c.y + c.z)) return {from, to};
  const auto along = [&](std::size_t a, double x) {
    const double first = low[a], last = first + extent[a] - 1;
    from[a] = std::int32_t(std::clamp(std::ceil(x - cells), first, last + 1));
    to[a] = std::int32_t(std::clamp(std::floor(x + cells), first - 1, last));
  };
  along(0, c.x), along(1, c.y), along(2, c.z);
  return {from, to};
}

void RestMap::find(std::size_t organ, Vec3 rest, double reach, Place& place, const BladeAt* blade) const {
  place.count = 0;
  const Lattice& lattice = lattices_[organ];
  const double cells = std::min(reach / lattice.spacing, kFarthest);
  reach = cells * lattice.spacing;
  std::array<double, Place::kMost> kernels;
  std::array<Vec3, Place::kMost> apart;
  std::size_t count = 0;
  double total = 0;
  lattice.for_each_within(rest, cells, [&](std::int32_t sphere) {
    if (count == Place::kMost) return;
    const Vec3 d = (model_.rest_position[std::size_t(sphere)] - rest) / reach;
    double value = kernel(dot(d, d)) * model_.mass[std::size_t(sphere)] / lattice.largest_mass;
    if (!(value > 0)) return;
    if (blade != nullptr) value *= blade->share(sphere, reach * norm(d), lattice.spacing);
    if (!(value > 0)) return;
    place.sphere[count] = sphere, kernels[count] = value, apart[count] = d, ++count, total += value;
  });
  if (count == 0) return;
  Matrix moments{}, inverse;
  for (std::size_t i = 0; i < count; ++i) {
    const double w = kernels[i] / total;
    const Row basis{1, apart[i].x, apart[i].y, apart[i].z};
    for (std::size_t p = 0; p < 4; ++p)
      for (std::size_t q = 0; q < 4; ++q) moments[p][q] += w * basis[p] * basis[q];
  }
  place.count = std::int32_t(count);
  place.spans_space = invert(moments, inverse);
  place.offset = {};
  for (std::size_t i = 0; i < count; ++i) {
    const double w = kernels[i] / total;
    if (!place.spans_space) {
      place.weight[i] = w, place.slope[i] = {}, place.offset -= w * reach * apart[i];
      continue;
    }
    Row share{};
    for (std::size_t p = 0; p < 4; ++p)
      share[p] =
          w * (inverse[p][0] + inverse[p][1] * apart[i].x + inverse[p][2] * apart[i].y + inverse[p][3] * apart[i].z);
    place.weight[i] = share[0], place.slope[i] = Vec3{share[1], share[2], share[3]} / reach;
  }
}

Vec3 RestMap::rest_of(std::size_t organ, const Vec3Array& position, Vec3 point, double reach,
                      const Bearing* bearing) const {
  const Lattice& lattice = lattices_[organ];
  const auto first = std::size_t(lattice.first), last = first + std::size_t(lattice.count);
  std::size_t nearest = first;
  double least = INFINITY;
  for (std::size_t i = first; i < last; ++i) {
    const Vec3 d = position[i] - point;
    if (dot(d, d) < least) least = dot(d, d), nearest = i;
  }
  Vec3 rest = model_.rest_position[nearest] + (point - position[nearest]);
  constexpr int kMostSteps = 8;
  const auto blade = bearing == nullptr ? std::nullopt : std::optional(BladeAt{*bearing, position, point});
  Place place;
  for (int step = 0; step < kMostSteps; ++step) {
    find(organ, rest, reach, place, blade ? &*blade : nullptr);
    if (place.count == 0) break;
    Vec3 move = place.at_rest(position, point - place.at(position));
    const double length = norm(move), most = 0.5 * lattice.spacing;
    if (length > most) move = most / length * move;
    rest += move;
    if (length < 1e-7 * lattice.spacing) break;
  }
  return rest;
}

bool RestMap::has_cells(std::size_t organ) const {
  const Lattice& lattice = lattices_[organ];
  if (lattice.sphere_at.empty()) return false;
  for (std::int32_t k = 0; k + 1 < lattice.extent[2]; ++k)
    for (std::int32_t j = 0; j + 1 < lattice.extent[1]; ++j)
      for (std::int32_t i = 0; i + 1 < lattice.extent[0]; ++i) {
        std::int32_t n = 0;
        while (n < 8 && lattice.at(lattice.low[0] + i + (n & 1), lattice.low[1] + j + (n >> 1 & 1),
                                   lattice.low[2] + k + (n >> 2)) >= 0)
          ++n;
        if (n == 8) return true;
      }
  return false;
}

double RestMap::depth_in_cells(std::size_t organ, Vec3 rest) const {
  const Lattice& lattice = lattices_[organ];
  if (lattice.sphere_at.empty()) return -INFINITY;
  const Vec3 c = lattice.in_cells(rest);
  const double farthest = 1e6;
  if (!(std::abs(c.x) < farthest && std::abs(c.y) < farthest && std::abs(c.z) < farthest)) return -INFINITY;
  const std::int32_t i = std::int32_t(std::floor(c.x)), j = std::int32_t(std::floor(c.y)),
                     k = std::int32_t(std::floor(c.z));
  const auto is_cell = [&](std::int32_t di, std::int32_t dj, std::int32_t dk) {
    for (std::int32_t n = 0; n < 8; ++n)
      if (lattice.at(i + di + (n & 1), j + dj + (n >> 1 & 1), k + dk + (n >> 2)) < 0) return false;
    return true;
  };
  const bool is_inside = is_cell(0, 0, 0);
  double nearest2 = 0.25;  // to a cell of the other kind, in spacings squared
  for (std::int32_t dk = -1; dk <= 1; ++dk)
    for (std::int32_t dj = -1; dj <= 1; ++dj)
      for (std::int32_t di = -1; di <= 1; ++di) {
        if (is_cell(di, dj, dk) == is_inside) continue;
        const auto beyond = [](double x, std::int32_t cell) { return std::max({0.0, cell - x, x - cell - 1}); };
        const double x = beyond(c.x, i + di), y = beyond(c.y, j + dj), z = beyond(c.z, k + dk);
        nearest2 = std::min(nearest2, x * x + y * y + z * z);
      }
  return (is_inside ? 1 : -1) * lattice.spacing * std::sqrt(nearest2);
}

}  // namespace ctpm::cutting
