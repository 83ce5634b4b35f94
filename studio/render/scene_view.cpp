#include "studio/render/scene_view.h"

#include <algorithm>
#include <cmath>

namespace ctpm {

OrganLook look_of(std::string_view organ_name) {
  OrganLook look{std::string(organ_name), {0.53, 0.20, 0.17}, {0.50, 0.08, 0.08}, 1};
  const auto has = [&](std::string_view word) { return organ_name.find(word) != std::string_view::npos; };
  if (has("liver")) look.outer = {0.42, 0.15, 0.115}, look.inner = {0.43, 0.07, 0.06};
  if (has("kidney")) look.outer = {0.56, 0.235, 0.20}, look.inner = {0.56, 0.12, 0.11};
  if (has("skin")) look.outer = {0.86, 0.67, 0.57}, look.inner = {0.76, 0.30, 0.26}, look.wetness = 0.25;
  return look;
}

Bounds rest_bounds(const SceneView& scene) {
  std::vector<Vec3> points;
  for (const Surface& surface : scene.surfaces)
    points.insert(points.end(), surface.vertex.begin(), surface.vertex.end());
  return bounds_of(points);
}

Vec3 up_of(const Model& model) {
  const double strength = norm(model.gravity);
  return strength > 0 ? -model.gravity / strength : Vec3{0, 0, 1};
}

Camera default_camera(const SceneView& scene, double aspect) {
  const Vec3 up = up_of(*scene.model);
  Vec3 side = cross(std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, up);
  side = side / norm(side);  // -y when z is up
  const Vec3 right = cross(up, side);
  const Vec3 from = side + 0.45 * -right + 0.62 * up;
  std::vector<Vec3> points;
  for (const Surface& surface : scene.surfaces)
    points.insert(points.end(), surface.vertex.begin(), surface.vertex.end());
  return fit_camera(points, -from, up, 32, aspect);
}

Colour layer_colour(int layer, int layer_count) {
  // From the skin inwards: rose, amber, green, blue, violet; equal steps of lightness.
  static constexpr Colour kLadder[] = {{0.84, 0.40, 0.38}, {0.93, 0.66, 0.32}, {0.62, 0.72, 0.36},
                                       {0.30, 0.62, 0.68}, {0.36, 0.42, 0.75}, {0.55, 0.33, 0.66}};
  const int last = int(std::size(kLadder)) - 1;
  const double place =
      std::clamp((layer - 1) * (layer_count > last ? double(last) / std::max(layer_count - 1, 1) : 1.0), 0.0,
                 double(last));
  const int step = std::min(int(place), last - 1);
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = kLadder[step][c] + (place - step) * (kLadder[step + 1][c] - kLadder[step][c]);
  return colour;
}

}  // namespace ctpm
