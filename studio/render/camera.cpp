#include "studio/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ctpm::render {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

struct Axes {
  Vec3 right, up, back;
};

Vec3 unit(Vec3 v) { return v / norm(v); }

/// The camera's axes; uses another up if the given one is parallel to the line of sight.
Axes axes_of(Vec3 look, Vec3 up) {
  const Vec3 back = -unit(look);
  Vec3 right = cross(up, back);
  if (norm(right) < 1e-9 * std::max(1.0, norm(up)))
    right = cross(std::abs(back.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, back);
  right = unit(right);
  return {right, cross(back, right), back};
}

}  // namespace

Bounds bounds_of(std::span<const Vec3> points) {
  if (points.empty()) return {};
  Bounds box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  return box;
}

Camera fit_camera(std::span<const Vec3> points, Vec3 direction, Vec3 up, double fov_deg, double aspect) {
  constexpr double kMargin = 1.25;  // the overlay needs room at the edges
  Camera camera;
  camera.fov_deg = fov_deg, camera.up = up, camera.target = bounds_of(points).centre();
  const Axes axes = axes_of(direction, up);
  const double tan_up = std::tan(fov_deg / 2 * kRadiansPerDegree) / kMargin, tan_right = tan_up * aspect;
  double distance = 1e-6;
  // Step back until each point is inside the view frustum.
  for (const Vec3& point : points) {
    const Vec3 p = point - camera.target;
    const double towards = dot(p, axes.back);
    distance = std::max(
        {distance, towards + std::abs(dot(p, axes.right)) / tan_right, towards + std::abs(dot(p, axes.up)) / tan_up});
  }
  camera.eye = camera.target + distance * axes.back;
  return camera;
}

Camera fit_camera(const Bounds& bounds, Vec3 direction, Vec3 up, double fov_deg, double aspect) {
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = {i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                  i & 4 ? bounds.max.z : bounds.min.z};
  return fit_camera(std::span<const Vec3>(corners), direction, up, fov_deg, aspect);
}

Mat4 product(const Mat4& a, const Mat4& b) {
  Mat4 c{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k) c[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return c;
}

Mat4 view_matrix(const Camera& camera) {
  const Axes a = axes_of(camera.target - camera.eye, camera.up);
  return {a.right.x,
          a.up.x,
          a.back.x,
          0,
          a.right.y,
          a.up.y,
          a.back.y,
          0,
          a.right.z,
          a.up.z,
          a.back.z,
          0,
          -dot(a.right, camera.eye),
          -dot(a.up, camera.eye),
          -dot(a.back, camera.eye),
          1};
}

Mat4 projection_matrix(const Camera& camera, double aspect, double near, double far) {
  const double f = 1 / std::tan(camera.fov_deg / 2 * kRadiansPerDegree);
  return {f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far),
          0};
}

Pixel project(const Camera& camera, int width, int height, Vec3 point) {
  const Axes a = axes_of(camera.target - camera.eye, camera.up);
  const Vec3 p = point - camera.eye;
  const double depth = -dot(p, a.back), f = 1 / std::tan(camera.fov_deg / 2 * kRadiansPerDegree);
  const double half = 0.5 * height * f / depth;
  return {0.5 * width + half * dot(p, a.right), 0.5 * height - half * dot(p, a.up), depth};
}

}  // namespace ctpm::render
