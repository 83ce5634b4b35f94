#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cutting/rest_map.h"
#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// How far the two faces of a cut are apart at a place, as the spheres on both sides of it tell: the jump that, with
/// slopes along the cut that both sides share, fits theirs best. Tissue beside a cut is free across it, so that its
/// spheres are as far from its face as at rest. The weights sum to 0: forces by them on the two sides are opposite.
struct Opening {
  static constexpr std::size_t kMost = 64;

  /// How much tissue both sides have near the place: 1 where it is enough; 0: none on one of them, and nothing below is
  /// set.
  double whole = 0;
  std::int32_t count = 0;
  std::array<std::int32_t, kMost> sphere;
  std::array<double, kMost> weight;

  /// Width [m] across the cut, along the unit vector `across` in the world from its one face to the other. Negative
  /// where the faces overlap.
  double width(const Vec3Array& position, Vec3 across) const;
  /// Change of the width per move of the place along the cut at rest, with the tissue as it is [1].
  Vec3 change(const Vec3Array& position, Vec3 across) const;

 private:
  friend class Openings;
  struct Pair {
    double first = 0, second = 0;
  };
  std::array<double, kMost> apart_;   ///< of the spheres from the cut at rest, positive on its second side [m]
  std::array<double, kMost> kernel_;  ///< their weights in the fit
  std::array<double, kMost> pull_;    ///< change of the kernel per move towards the sphere [1/m^2]
  std::array<Pair, kMost> along_;     ///< their places along the cut, from the mean of their side [m]
  std::array<Pair, 2> mean_;          ///< of both sides, from the place [m]
  std::array<double, 2> total_;       ///< of the kernels of both sides
  Vec3 axis_[2];                      ///< along the cut at rest, unit length
  double xx_ = 0, xy_ = 0, yy_ = 0;   ///< inverse of the spheres' moments along the cut [1/m^2]
};

/// Finds openings in the organs of a Model.
class Openings {
 public:
  /// `model` and `map` must outlive the Openings.
  Openings(const Model& model, const RestMap& map);

  /// The opening at a place at rest [m] of an organ. `normal`: of the cut there at rest, from its first to its second
  /// side, unit length.
  void find(std::size_t organ, Vec3 rest, Vec3 normal, Opening& opening) const;

 private:
  const Model& model_;
  const RestMap& map_;
  std::vector<double> heaviest_;  ///< mass of the heaviest sphere of each organ [kg]
};

}  // namespace ctpm::cutting
