#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/cutting/bearing.h"
#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// How a place in the tissue moves with the spheres around it: the affine motion that fits theirs best (moving least
/// squares with a linear basis). It is smooth in the place, and exact for every affine motion.
struct Place {
  static constexpr std::size_t kMost = 96;

  std::int32_t count = 0;    ///< 0: no sphere is near
  bool spans_space = false;  ///< the spheres do; else the place only translates with them
  Vec3 offset;               ///< from the weighted spheres to the place at rest [m]; 0 where they span space
  std::array<std::int32_t, kMost> sphere;
  std::array<double, kMost> weight;  ///< sum to 1
  std::array<Vec3, kMost> slope;     ///< change of the weight per move of the place, by diffuse derivatives [1/m]

  /// Where the place is [m].
  Vec3 at(const Vec3Array& position) const;
  /// The move of the place at rest that moves it by `move` [m]; none where the tissue is inside out or flat, and at
  /// most 20 times as long.
  Vec3 at_rest(const Vec3Array& position, Vec3 move) const;
};

/// From places in the tissue at rest to the spheres that carry them, and back.
class RestMap {
 public:
  /// `model` must outlive the RestMap.
  explicit RestMap(const Model& model);

  std::size_t organ_count() const { return lattices_.size(); }

  /// The spheres within `reach` [m] that carry a place at rest [m] of an organ; at a blade, those that can bear it.
  void find(std::size_t organ, Vec3 rest, double reach, Place& place, const BladeAt* blade = nullptr) const;

  /// Calls `visit(sphere)` for the spheres within `reach` [m] of a place at rest [m] of an organ, and for some beyond
  /// it, cell by cell of the lattice.
  template <class Visit>
  void for_each_within(std::size_t organ, Vec3 rest, double reach, Visit&& visit) const {
    constexpr double kRounding = 1e-9;
    lattices_[organ].for_each_within(rest, reach / lattices_[organ].spacing * (1 + kRounding), visit);
  }

  /// The place at rest that spheres within `reach` [m] carry to `point` when they are at `position` [m]; where no
  /// sphere is near, the nearest one carries it. `bearing`: a blade is at `point`.
  Vec3 rest_of(std::size_t organ, const Vec3Array& position, Vec3 point, double reach,
               const Bearing* bearing = nullptr) const;

  /// Signed distance of a place at rest from the boundary of an organ's whole lattice cells, inside positive [m], up to
  /// half a spacing: the depth in an organ that has no surface.
  double depth_in_cells(std::size_t organ, Vec3 rest) const;

  /// Whether an organ has whole lattice cells: a sheet of spheres has none.
  bool has_cells(std::size_t organ) const;

  double spacing(std::size_t organ) const { return lattices_[organ].spacing; }

 private:
  struct Lattice {
    std::int32_t first = 0, count = 0;
    double spacing = 0, largest_mass = 0;
    Vec3 origin, axis[3];  ///< place of cell 0 0 0 [m]; unit vectors
    LatticeCell low{}, extent{};
    std::vector<std::int32_t> sphere_at;  ///< dense over the box of cells; -1: none

    std::int32_t at(std::int32_t i, std::int32_t j, std::int32_t k) const;
    Vec3 in_cells(Vec3 rest) const;
    std::pair<LatticeCell, LatticeCell> cells_within(Vec3 rest, double cells) const;
    /// Visits spheres whose cells are at most so many cells away along each axis.
    template <class Visit>
    void for_each_within(Vec3 rest, double cells, Visit&& visit) const {
      const auto [from, to] = cells_within(rest, cells);
      for (std::int32_t k = from[2]; k <= to[2]; ++k)
        for (std::int32_t j = from[1]; j <= to[1]; ++j)
          for (std::int32_t i = from[0]; i <= to[0]; ++i)
            if (const std::int32_t sphere = at(i, j, k); sphere >= 0) visit(sphere);
    }
  };
  Lattice make_lattice(const OrganRange& organ) const;

  const Model& model_;
  std::vector<Lattice> lattices_;
};

}  // namespace ctpm::cutting
