#pragma once

#include "core/model/box.h"
#include "core/model/model.h"
#include "core/model/vec3.h"
#include "core/surface/near_surface.h"
#include "core/surface/rigid_mesh.h"

namespace ctpm::surface {

/// The space that an obstacle fills.
class ObstacleShape {
 public:
  explicit ObstacleShape(const Obstacle& obstacle);

  /// How far inside the obstacle a point is.
  Inside inside(Vec3 point) const;

  /// Whether something in `box` may be inside; false only if nothing is.
  bool meets(const Box& box) const;
  /// No point of `box` is nearer to the obstacle than this [m]; 0 or less: one may be inside.
  double clearance(const Box& box) const;
  /// The only direction along which anything comes nearer to it, as to a plane; null: all are.
  const Vec3* only_way() const { return kind_ == ObstacleKind::plane ? &half_space_.normal : nullptr; }

 private:
  Inside inside_box(Vec3 point) const;

  ObstacleKind kind_;
  Vec3 position_;
  Quat world_from_obstacle_;
  Vec3 half_size_;
  HalfSpace half_space_;
  Box bounds_;  ///< of a box or a mesh [m]
  RigidMesh mesh_;
};

}  // namespace ctpm::surface
