#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cutting/rest_map.h"
#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// The jump across a cut at a place, of a value that spheres on both sides of it have: the one that, with slopes along
/// the cut that both sides share, fits their values best. The weights sum to 0: forces by them on the two sides are
/// opposite.
struct Opening {
  static constexpr std::size_t kMost = 64;
  using Values = std::array<double, kMost>;

  /// How much tissue both sides have near the place: 1 where it is enough; 0: none on one of them, and nothing below is
  /// set.
  double whole = 0;
  std::int32_t count = 0;
  std::array<std::int32_t, kMost> sphere;
  Values weight;
  Values apart;  ///< of the spheres from the cut at rest, positive on its second side, never 0 [m]

  double jump(const Values& value) const;
  /// Change of the jump per move of the place along the cut at rest, with the values as they are [1/m].
  Vec3 change(const Values& value) const;

 private:
  friend class Openings;
  struct Pair {
    double first = 0, second = 0;
  };
  Values kernel_;                    ///< weights of the spheres in the fit
  Values pull_;                      ///< change of the kernel per move towards the sphere [1/m^2]
  std::array<Pair, kMost> along_;    ///< their places along the cut, from the mean of their side [m]
  std::array<Pair, 2> mean_;         ///< of both sides, from the place [m]
  std::array<double, 2> total_;      ///< of the kernels of both sides
  Vec3 axis_[2];                     ///< along the cut at rest, unit length
  double xx_ = 0, xy_ = 0, yy_ = 0;  ///< inverse of the spheres' moments along the cut [1/m^2]
};

/// Finds openings in the organs of a Model.
class Openings {
 public:
  /// `model` and `map` must outlive the Openings.
  Openings(const Model& model, const RestMap& map);

  /// The opening at a place at rest [m] of an organ. `normal`: of the cut there at rest, from its first to its second
  /// side, unit length. `blade`: which is there; its spheres are those that can bear it.
  void find(std::size_t organ, Vec3 rest, Vec3 normal, Opening& opening, const BladeAt* blade = nullptr) const;

 private:
  const Model& model_;
  const RestMap& map_;
  std::vector<double> heaviest_;  ///< mass of the heaviest sphere of each organ [kg]
};

}  // namespace ctpm::cutting
