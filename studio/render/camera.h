#pragma once

#include <array>
#include <span>

#include "core/model/vec3.h"

namespace ctpm::render {

/// A pinhole camera.
struct Camera {
  Vec3 eye{0, -1, 0.5};  ///< [m]
  Vec3 target;           ///< point in the centre of the picture [m], not equal to the eye
  Vec3 up{0, 0, 1};      ///< points up in the picture, not parallel to the line of sight
  double fov_deg = 32;   ///< vertical field of view, in (0, 170)
};

/// A box around points.
struct Bounds {
  Vec3 min, max;  ///< [m], min <= max in each coordinate

  Vec3 centre() const { return 0.5 * (min + max); }
  double diagonal() const { return norm(max - min); }
};

/// The smallest box around the points; a point at the origin if there are none.
Bounds bounds_of(std::span<const Vec3> points);

/// A camera that looks along `direction` and frames the whole box with a margin. `aspect` = width / height.
Camera fit_camera(const Bounds& bounds, Vec3 direction, Vec3 up, double fov_deg = 32, double aspect = 16.0 / 9);

/// As above for points: the camera stands closer than it would for their box.
Camera fit_camera(std::span<const Vec3> points, Vec3 direction, Vec3 up, double fov_deg = 32, double aspect = 16.0 / 9);

/// Column-major 4 x 4 matrix.
using Mat4 = std::array<double, 16>;

/// Product a b: b is applied first.
Mat4 product(const Mat4& a, const Mat4& b);

/// eye_from_world of the camera: x right, y up, the camera looks along -z.
Mat4 view_matrix(const Camera& camera);

/// clip_from_eye with the given near and far planes [m], 0 < near < far.
Mat4 projection_matrix(const Camera& camera, double aspect, double near, double far);

/// A point in the picture.
struct Pixel {
  double x = 0, y = 0;  ///< [pixels] from the top left corner
  double depth = 0;     ///< distance in front of the camera [m]; <= 0: behind it
};

/// Projects a world point into a picture of the given size.
Pixel project(const Camera& camera, int width, int height, Vec3 point);

}  // namespace ctpm::render
