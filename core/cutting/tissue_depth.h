#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/cutting/rest_map.h"
#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// How deep places at rest are below an organ's drawn surface; in an organ without one, below the boundary of
/// its whole lattice cells.
class TissueDepth {
 public:
  /// Distance beyond which depths are cut off [m]. The far parts of a grid know only their side.
  static constexpr double kBand = 2.2e-3;

  /// `model` and `map` must outlive the TissueDepth. `only`: the one organ that it will be asked about.
  TissueDepth(const Model& model, const RestMap& map, std::optional<std::size_t> only = {});

  /// Signed distance of a place at rest from the surface of an organ [m]: positive inside, in [-kBand, kBand].
  double at(std::size_t organ, Vec3 rest) const;

  /// The triangle of an organ's surface that is nearest to a place at rest; -1: none is within kBand of it.
  std::int32_t nearest_triangle(std::size_t organ, Vec3 rest) const;

  /// The place on the surface of an organ that is nearest to a place at rest, however far [m].
  Vec3 nearest_on_surface(std::size_t organ, Vec3 rest) const;

 private:
  /// What shows fast that a triangle is far: a sphere around it, and its plane.
  struct Bound {
    Vec3 middle;            ///< [m]
    double radius;          ///< [m]
    Vec3 normal;            ///< its size is twice the triangle's area [m^2]
    double normal_squared;  ///< [m^4]

    /// Whether every point of the triangle is farther from a place than `distance` [m], but for rounding.
    bool is_beyond(Vec3 place, double distance) const {
      const Vec3 apart = place - middle;
      const double most = distance + radius, above = dot(apart, normal);
      return dot(apart, apart) > most * most || above * above > distance * distance * normal_squared;
    }
  };
  struct Ball {
    Vec3 middle;    ///< [m]
    double radius;  ///< [m]
  };
  /// Buckets of a cubic grid over the organ, each with the triangles that come within kBand of it.
  struct Grid {
    const Surface* surface = nullptr;
    Vec3 low;
    std::array<std::int32_t, 3> extent{};
    std::vector<std::int32_t> row;              ///< of each bucket in what follows; -1: no triangle is near it
    std::vector<std::int32_t> first, triangle;  ///< CSR by row
    std::vector<double> near_middle;            ///< distance of its middle from the surface, or infinite (rows) [m]
    std::vector<Bound> bound;                   ///< of each triangle of the surface
    std::vector<Ball> block;                    ///< around each kBlock triangles that follow each other, ascending
    std::vector<std::int8_t> side;              ///< of each bucket's middle: 1 inside, -1 outside
  };
  struct Window;
  static Grid make_grid(const Surface& surface);
  static Window window_of(const Grid& grid, std::size_t triangle);
  template <class Visit>
  static void for_each_near(const Grid& grid, std::size_t triangle, const Window& window, const Visit& visit);
  static void find_near(Grid& grid);
  static void find_sides(Grid& grid);
  static constexpr std::size_t kBlock = 64;
  static Ball ball_around(const Bound* begin, const Bound* end);
  static Bound bound_of(const Surface& surface, const std::array<std::int32_t, 3>& triangle);
  static Vec3 middle_of(const Grid& grid, std::size_t i, std::size_t j, std::size_t k);
  static Vec3 middle_of(const Grid& grid, std::size_t bucket);
  static std::int64_t bucket_of(const Grid& grid, Vec3 rest);
  struct Near {
    double depth;  ///< [m]; infinite: there is none
    std::int32_t triangle = -1;
  };
  static Near near(const Grid& grid, std::size_t bucket, Vec3 rest);

  const RestMap& map_;
  std::vector<Grid> grids_;  ///< (organ_count)
};

}  // namespace ctpm::cutting
