#pragma once

#include <cstddef>
#include <vector>

#include "core/cutbody/cut_points.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "core/model/vec3.h"
#include "core/surface/bodies.h"
#include "core/surface/body_overlaps.h"
#include "core/surface/obstacle_shape.h"

namespace ctpm::contact {

/// Where the surfaces of organs are seen and touched: where the lattice carries them, but dented by what presses them.
/// A ball's dent lies on the ball, an obstacle's on the obstacle. Two organs dent each other, each by the share of the
/// overlap that its stiffness gives it, so that their surfaces meet between. A cut surface spreads what stretch no
/// element carries (surface::spread_stretch()).
class DrawnSurfaces {
 public:
  /// `model` must outlive this.
  explicit DrawnSurfaces(const Model& model);
  DrawnSurfaces(const DrawnSurfaces&) = delete;
  DrawnSurfaces& operator=(const DrawnSurfaces&) = delete;

  /// Positions of the vertices [m] of `surface`, that of organ `organ`, which may be cut (vertex_count).
  void place(std::size_t organ, const Surface& surface, const State& state, std::vector<Vec3>& vertex);

 private:
  void put_between_organs(std::size_t organ, const Surface& surface, bool is_cut, const State& state,
                          std::vector<Vec3>& vertex);
  void put_on_ball(std::size_t hand, std::size_t organ, const Surface& surface, bool is_cut, const State& state,
                   std::vector<Vec3>& vertex) const;

  const Model& model_;
  std::vector<surface::Body> bodies_;
  std::vector<surface::ObstacleShape> obstacles_;
  surface::BodyOverlaps overlaps_;
  cutbody::CutPoints cut_points_;
  std::vector<surface::Overlap> found_;
};

}  // namespace ctpm::contact
