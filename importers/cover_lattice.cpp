#include "importers/cover_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "importers/scan_rows.h"

namespace ctpm::importers {
namespace {

constexpr double kSliver = 0.02;    // of a cell: less tissue is left out
constexpr double kFull = 1 - 1e-9;  // of a cell: more is a full cell
constexpr double kMostRows = 1e7;   // sampled lines; bounds memory
constexpr double kPlausible = 2;    // factor by which cut cells are scaled at most

/// Lines through a cell along y, and along z. Each row of lines is shifted by a permutation of the other's number, so
/// that a flat face at any height is resolved to 1 / n^2. Neither permutation correlates y with z.
constexpr int kFine = 8, kCoarse = 4;
constexpr std::array<int, kFine> kFinePermutation{3, 6, 0, 5, 2, 7, 1, 4};
constexpr std::array<int, kCoarse> kCoarsePermutation{1, 3, 0, 2};

template <int n, const std::array<int, std::size_t(n)>& permutation>
std::array<double, 2> shift_of(std::int32_t j, std::int32_t k) {
  const auto part = [](std::int32_t other) { return (permutation[std::size_t(other % n)] + 0.5) / n - 0.5; };
  return {part(k), part(j)};
}

/// What one cell gives to its twelve axis elements: `along[axis][p + 2 q]`, where p and q are the corner's coordinates
/// (0 or 1) along the next two axes in cyclic order. Diagonals and volumes follow from these by sums.
struct CellShares {
  std::array<std::array<double, 4>, 3> along{};

  double volume() const { return along[0][0] + along[0][1] + along[0][2] + along[0][3]; }

  static CellShares full() {
    CellShares shares;
    for (auto& four : shares.along) four.fill(0.25);
    return shares;
  }

  void scale(double factor) {
    for (auto& four : along)
      for (double& share : four) share *= factor;
  }
};

/// Adds the tissue on the part [begin, end] of a line at y, z, all in [0, 1] of the cell; `weight`: of the line.
void add_line(CellShares& cell, double begin, double end, double y, double z, double weight) {
  const double length = weight * (end - begin), upper = weight * 0.5 * (end * end - begin * begin);
  const std::array<double, 2> x_part{length - upper, upper}, y_hat{1 - y, y}, z_hat{1 - z, z};
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t q = 0; q < 2; ++q) {
      cell.along[0][p + 2 * q] += length * y_hat[p] * z_hat[q];
      cell.along[1][p + 2 * q] += z_hat[p] * x_part[q];
      cell.along[2][p + 2 * q] += x_part[p] * y_hat[q];
    }
}

/// Shares of all cells, by cell number i + nx (j + ny k), and their volume as it should be, in cells.
struct Integrals {
  std::vector<CellShares> shares;
  double volume = 0;
};

Integrals integrate(const CheckedMesh& mesh, const Lattice& cells) {
  const bool is_fine = double(cells.row_count()) * kFine * kFine <= kMostRows;
  const int n = is_fine ? kFine : kCoarse;
  const Lattice fine{cells.centre, cells.spacing / n, {cells.count[0] * n, cells.count[1] * n, cells.count[2] * n}};
  const RowLines lines{fine, is_fine ? shift_of<kFine, kFinePermutation> : shift_of<kCoarse, kCoarsePermutation>};
  const Vec3 origin = cells.at({0, 0, 0}) - 0.5 * cells.spacing * Vec3{1, 1, 1};
  std::vector<CellShares> shares(std::size_t(cells.count[0]) * std::size_t(cells.row_count()));
  const bool overlaps = spans_inside(
      mesh.vertex, mesh.triangle, lines, [&](std::int32_t j, std::int32_t k, const std::vector<Span>& spans) {
        const Vec3 line = (lines.at(j, k) - origin) / cells.spacing;
        const Cell row{0, j / n, k / n};
        const double y = line.y - row[1], z = line.z - row[2];
        CellShares* of_row = &shares[std::size_t(cells.row_of(row)) * std::size_t(cells.count[0])];
        for (const Span& span : spans) {
          const double begin = std::clamp((span.begin - origin.x) / cells.spacing, 0.0, double(cells.count[0]));
          const double end = std::clamp((span.end - origin.x) / cells.spacing, 0.0, double(cells.count[0]));
          for (auto i = std::int32_t(begin); i < end && i < cells.count[0]; ++i)
            add_line(of_row[i], std::max(begin - i, 0.0), std::min(end - i, 1.0), y, z, 1.0 / (n * n));
        }
      });
  // Parts that overlap count twice in the mesh's volume, but once in the cells.
  double volume = mesh.volume / (cells.spacing * cells.spacing * cells.spacing);
  if (overlaps) {
    volume = 0;
    for (const CellShares& cell : shares) volume += cell.volume();
  }
  return {std::move(shares), volume};
}

/// Leaves out slivers, makes full cells exact, and scales cut cells so that the volume is the mesh's.
void balance(std::vector<CellShares>& shares, double volume_in_cells) {
  double full = 0, cut = 0;
  for (CellShares& cell : shares) {
    const double volume = cell.volume();
    if (volume < kSliver)
      cell = {};
    else if (volume > kFull)
      cell = CellShares::full(), full += 1;
    else
      cut += volume;
  }
  if (cut <= 0) return;
  const double factor = (volume_in_cells - full) / cut;
  if (!(factor > 1 / kPlausible && factor < kPlausible)) return;  // the surface turns inside out somewhere
  for (CellShares& cell : shares)
    if (cell.volume() < kFull) cell.scale(factor);
}

/// Adds what a cell gives to the elements between its corners. `number(p, q, r)`: sphere at corner p, q, r.
template <class Number>
void give(const CellShares& cell, TissueShares& shares, const Number& number) {
  const auto& along = cell.along;
  const auto add = [&](std::size_t direction, int p, int q, int r, double share) {
    shares.element[direction][number(p, q, r)] += share;
  };
  for (int p = 0; p < 2; ++p)
    for (int q = 0; q < 2; ++q) {
      add(0, 0, p, q, along[0][std::size_t(p + 2 * q)]);
      add(1, q, 0, p, along[1][std::size_t(p + 2 * q)]);
      add(2, p, q, 0, along[2][std::size_t(p + 2 * q)]);
    }
  // Diagonals of the faces across z, y and x, by the position of the face.
  for (int face = 0; face < 2; ++face) {
    const auto f = std::size_t(face);
    const double z = along[0][2 * f] + along[0][2 * f + 1], y = along[0][f] + along[0][f + 2],
                 x = along[1][2 * f] + along[1][2 * f + 1];
    add(3, 0, 0, face, z), add(4, 1, 0, face, z);
    add(5, 0, face, 0, y), add(6, 1, face, 0, y);
    add(7, face, 0, 0, x), add(8, face, 1, 0, x);
  }
  shares.cell[number(0, 0, 0)] = cell.volume();
}

/// Moves material from the ends of a line of elements inwards. `share`: of each element of the line; `moved`: what it
/// gets. Hat functions reproduce constant and linear fields but count quadratic ones, such as bending, too high: the
/// error is that of the trapezoidal rule, s^2 / 12 times the gradient at either end. Antidiffusion with 1 / 12 cancels
/// it; what it would take from beyond an end, it takes from the end instead, as Gregory's rule does.
void sharpen_line(const std::vector<double>& share, std::vector<double>& moved) {
  constexpr double kRate = 1.0 / 12, kMostGiven = 0.45;
  const std::size_t n = share.size();
  moved.assign(n, 0);
  std::vector<double> given(n, 0);
  const auto move = [&](std::size_t from, std::size_t to, double wanted) {
    const double amount = std::min(wanted, kMostGiven * share[from] - given[from]);
    given[from] += amount, moved[from] -= amount, moved[to] += amount;
    return wanted - amount;
  };
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double rise = kRate * (share[k + 1] - share[k]);
    if (rise > 0) move(k, k + 1, rise);
    if (rise < 0) move(k + 1, k, -rise);
  }
  double carried = kRate * share[0];
  for (std::size_t k = 0; k + 1 < n && carried > 0; ++k) carried = move(k, k + 1, carried);
  carried = kRate * share[n - 1];
  for (std::size_t k = n - 1; k > 0 && carried > 0; --k) carried = move(k, k - 1, carried);
}

/// Sharpens all elements across their direction.
void sharpen(const CellLookup& lookup, const std::vector<Cell>& cell, TissueShares& shares) {
  std::vector<std::int32_t> line;
  std::vector<double> share, moved;
  for (std::size_t d = 0; d < kLatticeDirections.size(); ++d) {
    const std::vector<double> before = shares.element[d];
    const auto has = [&](std::int32_t n) { return n >= 0 && before[std::size_t(n)] > 0; };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (kLatticeDirections[d][axis] != 0) continue;
      const auto next = [&](std::int32_t n, int sign) {
        Cell at = cell[std::size_t(n)];
        at[axis] += sign;
        return lookup.find(at);
      };
      for (std::int32_t start = 0; start < std::int32_t(cell.size()); ++start) {
        if (!has(start) || has(next(start, -1))) continue;
        line.clear(), share.clear();
        for (std::int32_t n = start; has(n); n = next(n, 1)) line.push_back(n), share.push_back(before[std::size_t(n)]);
        sharpen_line(share, moved);
        for (std::size_t k = 0; k < line.size(); ++k) shares.element[d][std::size_t(line[k])] += moved[k];
      }
    }
  }
}

/// Half of the part of each element, over the 18 elements of a full sphere.
void share_volume(const CellLookup& lookup, const std::vector<Cell>& cell, TissueShares& shares) {
  shares.sphere.assign(cell.size(), 0);
  for (std::size_t n = 0; n < cell.size(); ++n)
    for (std::size_t d = 0; d < kLatticeDirections.size(); ++d) {
      const double share = shares.element[d][n] / 18;
      if (share == 0) continue;
      const Cell step = kLatticeDirections[d];
      shares.sphere[n] += share;
      shares.sphere[std::size_t(lookup.find({cell[n][0] + step[0], cell[n][1] + step[1], cell[n][2] + step[2]}))] +=
          share;
    }
}

}  // namespace

Cover cover_with_cells(const CheckedMesh& mesh, const Lattice& cells) {
  auto [of_cell, volume] = integrate(mesh, cells);
  balance(of_cell, volume);

  Cover cover;
  cover.lattice = {cells.centre, cells.spacing, {cells.count[0] + 1, cells.count[1] + 1, cells.count[2] + 1}};
  const Cell count = cover.lattice.count;
  const auto corner = [&](const Cell& at, int p, int q, int r) {
    return std::size_t(cover.lattice.row_of({0, at[1] + q, at[2] + r})) * std::size_t(count[0]) +
           std::size_t(at[0] + p);
  };
  const auto for_each_cell = [&](const auto& visit) {
    std::size_t n = 0;
    for (std::int32_t k = 0; k < cells.count[2]; ++k)
      for (std::int32_t j = 0; j < cells.count[1]; ++j)
        for (std::int32_t i = 0; i < cells.count[0]; ++i, ++n)
          if (of_cell[n].volume() > 0) visit(Cell{i, j, k}, of_cell[n]);
  };
  std::vector<std::int32_t> number(std::size_t(count[0]) * std::size_t(cover.lattice.row_count()), -1);
  for_each_cell([&](const Cell& at, const CellShares&) {
    for (int c = 0; c < 8; ++c) number[corner(at, c & 1, c >> 1 & 1, c >> 2)] = 0;
  });
  std::size_t place = 0;
  for (std::int32_t k = 0; k < count[2]; ++k)
    for (std::int32_t j = 0; j < count[1]; ++j)
      for (std::int32_t i = 0; i < count[0]; ++i, ++place)
        if (number[place] == 0) number[place] = std::int32_t(cover.cell.size()), cover.cell.push_back({i, j, k});

  TissueShares& shares = cover.shares;
  shares.cell.assign(cover.cell.size(), 0);
  for (auto& direction : shares.element) direction.assign(cover.cell.size(), 0);
  for_each_cell([&](const Cell& at, const CellShares& cell) {
    give(cell, shares, [&](int p, int q, int r) { return std::size_t(number[corner(at, p, q, r)]); });
  });
  const CellLookup lookup(cover.lattice, cover.cell);
  sharpen(lookup, cover.cell, shares);
  share_volume(lookup, cover.cell, shares);
  return cover;
}

void keep_only(Cover& cover, const std::vector<char>& keep) {
  std::size_t next = 0;
  for (std::size_t n = 0; n < cover.cell.size(); ++n) {
    if (!keep[n]) continue;
    cover.cell[next] = cover.cell[n], cover.shares.cell[next] = cover.shares.cell[n];
    for (auto& direction : cover.shares.element) direction[next] = direction[n];
    cover.shares.sphere[next] = cover.shares.sphere[n];
    ++next;
  }
  cover.cell.resize(next), cover.shares.cell.resize(next), cover.shares.sphere.resize(next);
  for (auto& direction : cover.shares.element) direction.resize(next);
}

}  // namespace ctpm::importers
