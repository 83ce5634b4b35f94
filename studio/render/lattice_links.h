#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::render {

/// The lattice of one organ: which neighbours are linked, and which links are severed. Sphere indices count from 0
/// within the organ.
class LatticeLinks {
 public:
  /// Steps to the 18 neighbours: 6 along the axes first, then 12 along face diagonals.
  static constexpr int kSteps = 18;
  using Cell = LatticeCell;
  static const std::array<Cell, kSteps>& steps();

  /// The lattice of organ `organ` of the model. An organ may be rotated in its scene.
  LatticeLinks(const Model& model, std::size_t organ);

  /// Takes over the severed links of `state`. Returns whether anything changed since the last call.
  bool update(const State& state);

  std::int32_t count() const { return std::int32_t(rest_.size()); }
  std::int32_t first() const { return first_; }
  double spacing() const { return spacing_; }
  Vec3 rest(std::int32_t sphere) const { return rest_[std::size_t(sphere)]; }
  double mass(std::int32_t sphere) const { return mass_[std::size_t(sphere)]; }  ///< [kg]
  /// Whether the sphere lies in the tissue: the lattice reaches beyond the surface, where spheres stand for little.
  bool is_inside(std::int32_t sphere) const { return mass(sphere) >= inside_mass_; }
  Cell cell(std::int32_t sphere) const { return cell_[std::size_t(sphere)]; }

  /// Rest position [m] of a point in cell coordinates, which need not be integers.
  Vec3 place(double i, double j, double k) const { return origin_ + i * axis_[0] + j * axis_[1] + k * axis_[2]; }

  /// Sphere in a cell, or -1.
  std::int32_t at(Cell cell) const;

  /// Neighbour by step, or -1 where there is no sphere.
  std::int32_t neighbour(std::int32_t sphere, int step) const { return neighbour_[index(sphere, step)]; }
  bool is_joined(std::int32_t sphere, int step) const { return link_[index(sphere, step)] == Link::joined; }
  bool is_severed(std::int32_t sphere, int step) const { return link_[index(sphere, step)] == Link::severed; }

  /// Crossing of the severed link from a sphere along `step`: rest position [m].
  Vec3 crossing(std::int32_t sphere, int step) const {
    const double t = crossing_[index(sphere, step)];
    return (1 - t) * rest(sphere) + t * rest(neighbour(sphere, step));
  }

  /// Whether any link at the sphere is severed.
  bool is_cut(std::int32_t sphere) const { return cut_[std::size_t(sphere)]; }
  bool anything_cut() const { return anything_cut_; }

  /// The part of its neighbourhood that a sphere sees, in ascending order of index.
  struct Sight {
    std::vector<std::int32_t> seen;  ///< reached over joined links in as few hops as when uncut
    std::vector<std::int32_t> lost;  ///< reached when uncut, now not at all or only by a detour around a cut's end
  };

  /// What `home` sees, itself included. The two sides of a cut do not see each other, although they are joined beyond
  /// its end.
  Sight sight_from(std::int32_t home) const;

 private:
  enum class Link : std::uint8_t { none, joined, severed };
  struct Element {
    std::int32_t sphere;  ///< one end
    std::int32_t step;    ///< towards the other end
    std::int32_t source;  ///< row of Model::axial
  };

  std::size_t index(std::int32_t sphere, int step) const { return std::size_t(sphere) * kSteps + std::size_t(step); }
  void build_table();
  void find_axes();
  void add_element(std::int32_t a, std::int32_t b, std::int32_t source);
  std::vector<std::array<std::int32_t, 2>> hops_from(std::int32_t home, bool over_severed) const;

  std::int32_t first_ = 0;
  double spacing_ = 0;
  Vec3 origin_;
  Vec3 axis_[3];  ///< one cell along each axis [m], from spheres in neighbouring cells
  std::vector<Vec3> rest_;
  std::vector<double> mass_;
  double inside_mass_ = 0;
  std::vector<Cell> cell_;
  Cell low_{}, extent_{};
  std::vector<std::int32_t> sphere_at_;  ///< dense over the box of cells
  std::vector<std::int32_t> neighbour_;
  std::vector<Link> link_;
  std::vector<float> crossing_;  ///< of a severed link, from 0 at this sphere to 1 at its neighbour
  std::vector<Element> elements_;
  std::vector<std::uint8_t> severed_;  ///< of elements_, at the last update()
  std::vector<std::uint8_t> passed_;   ///< crossings of elements_ as State stores them, at the last update()
  std::vector<std::uint8_t> cut_;
  bool anything_cut_ = false;
  bool has_diagonals_ = false;
};

}  // namespace ctpm::render
