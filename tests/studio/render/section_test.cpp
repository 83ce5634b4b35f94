// What a cutaway shows, against the organ's own labels.

#include <gtest/gtest.h>

#include "core/cutting/blade_geometry.h"
#include "studio/render/depth_field.h"
#include "studio/render/shading.h"
#include "tests/studio/render/scene.h"

namespace ctpm::render_test {
namespace {

constexpr int kWidth = 480, kHeight = 270;
constexpr double kFirstEnds = 0.006, kSecondEnds = 0.012;  // layers [m]

enum class Shown { nothing, outside, first, second, inside };

/// The blob in colours far from each other: red outside, green and magenta layers, blue below.
std::unique_ptr<TestScene> make_layered_scene(int rows) {
  auto scene = make_blob_scene(0.003, rows);
  render::OrganLook look;
  look.outer = {0.75, 0.12, 0.10}, look.inner = {0.12, 0.22, 0.80}, look.wetness = 0;
  look.layers = {{kFirstEnds, {0.15, 0.70, 0.20}}, {kSecondEnds, {0.75, 0.15, 0.70}}};
  scene->view.looks = {look};
  return scene;
}

Shown shown_at(const render::Frame& frame, int x, int y) {
  const std::uint8_t* p = &frame.rgb[std::size_t(y * frame.width + x) * 3];
  const int red = p[0], green = p[1], blue = p[2];
  if (std::max({red, green, blue}) - std::min({red, green, blue}) < 40) return Shown::nothing;
  if (green > red && green > blue) return Shown::first;
  if (red > green + 30 && blue > green + 30 && std::abs(red - blue) < 50) return Shown::second;
  return red > blue ? Shown::outside : Shown::inside;
}

/// What a ray meets that ends at the plane or goes on in what the cutaway keeps.
class Truth {
 public:
  Truth(const Surface& rest, const std::function<Vec3(Vec3)>& move, const std::function<Vec3(Vec3)>& back,
        const render::DrawOptions& options)
      : rest_(rest), back_(back), options_(options), view_(render::view_matrix(options.camera)) {
    for (const Vec3& v : rest.vertex) position_.push_back(move(v));
  }

  Shown at(double x, double y) const {
    const Vec3 eye = options_.camera.eye, way = ray(x, y);
    const render::Cutaway& cut = options_.cutaway;
    const double plane = dot(cut.point - eye, cut.normal) / dot(way, cut.normal);
    if (!(plane > 0)) return Shown::nothing;
    int beyond = 0;
    for (const auto& t : rest_.triangle) beyond += hit(t, eye, way) > plane;
    if (beyond == 0) return Shown::nothing;
    if (beyond % 2 == 0) return Shown::outside;
    const Vec3 place = back_(eye + plane * way);
    double depth = 1;
    for (const auto& t : rest_.triangle)
      depth = std::min(depth, norm(place - cutting::nearest_in_triangle(place, rest_.vertex[std::size_t(t[0])],
                                                                        rest_.vertex[std::size_t(t[1])],
                                                                        rest_.vertex[std::size_t(t[2])])));
    return depth < kFirstEnds ? Shown::first : depth < kSecondEnds ? Shown::second : Shown::inside;
  }

 private:
  Vec3 ray(double x, double y) const {
    const double up = std::tan(options_.camera.fov_deg / 2 * std::numbers::pi / 180);
    const double a = (2 * x / kWidth - 1) * up * kWidth / kHeight, b = (1 - 2 * y / kHeight) * up;
    return {a * view_[0] + b * view_[1] - view_[2], a * view_[4] + b * view_[5] - view_[6],
            a * view_[8] + b * view_[9] - view_[10]};
  }
  /// Where a ray meets a triangle, in lengths of `way`; -1: nowhere.
  double hit(const std::array<std::int32_t, 3>& t, Vec3 eye, Vec3 way) const {
    const Vec3 a = position_[std::size_t(t[0])], b = position_[std::size_t(t[1])] - a,
               c = position_[std::size_t(t[2])] - a, n = cross(b, c);
    const double facing = dot(n, way);
    if (facing == 0) return -1;
    const double along = dot(n, a - eye) / facing;
    const Vec3 p = eye + along * way - a;
    const double u = dot(cross(p, c), n) / dot(n, n), v = dot(cross(b, p), n) / dot(n, n);
    return u >= 0 && v >= 0 && u + v <= 1 ? along : -1;
  }

  const Surface& rest_;
  const std::function<Vec3(Vec3)>& back_;
  const render::DrawOptions& options_;
  const render::Mat4 view_;
  std::vector<Vec3> position_;
};

/// Looks from every `step`th of ten directions.
void expect_rays_show_known_layers(int step) {
  const auto scene = make_layered_scene(20);
  auto made = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(made);
  // The tissue is turned, stretched and moved; its layers go with it.
  const Quat turn{std::cos(0.3), 0.2 * std::sin(0.3), std::sqrt(0.5) * std::sin(0.3), std::sqrt(0.46) * std::sin(0.3)};
  const Vec3 stretch{1.12, 0.94, 1.05}, shift{0.004, -0.003, 0.006};
  const std::function<Vec3(Vec3)> move = [&](Vec3 p) {
    return shift + rotate(turn, {stretch.x * p.x, stretch.y * p.y, stretch.z * p.z});
  };
  const std::function<Vec3(Vec3)> back = [&](Vec3 p) {
    const Vec3 q = rotate({turn.w, -turn.x, -turn.y, -turn.z}, p - shift);
    return Vec3{q.x / stretch.x, q.y / stretch.y, q.z / stretch.z};
  };
  State state = rest_state(scene->model);
  for (std::size_t i = 0; i < scene->model.sphere_count(); ++i)
    state.position.set(i, move(scene->model.rest_position[i]));
  std::map<Shown, int> seen, wrong;
  for (int direction = 0; direction < 10; direction += step) {
    // Eyes around the organ; planes through different places, tilted from straight on to nearly edge on.
    const double height = -0.9 + 0.2 * direction, angle = 2.4 * direction, flat = std::sqrt(1 - height * height);
    const Vec3 from{flat * std::cos(angle), flat * std::sin(angle), height}, side{-std::sin(angle), std::cos(angle), 0};
    render::DrawOptions options;
    options.show_ground = false;
    options.camera = render::fit_camera(render::rest_bounds(scene->view), -from, {0, 0, 1});
    const double tilt = 0.13 * direction;
    const Vec3 normal = std::cos(tilt) * from + std::sin(tilt) * side;
    options.cutaway = {shift + (0.002 * direction - 0.01) * normal, normal};
    const render::Frame picture = (*made)->draw(state, options);
    const Truth truth(scene->model.surfaces[0], move, back, options);
    for (int y = 4; y < kHeight - 4; y += 5)
      for (int x = 4; x < kWidth - 4; x += 5) {
        const Shown known = truth.at(x + 0.5, y + 0.5);
        bool is_clear = true;  // two pixels from the next colour
        for (const double away : {-2.0, 2.0})
          is_clear &= truth.at(x + 0.5 + away, y + 0.5) == known && truth.at(x + 0.5, y + 0.5 + away) == known;
        if (!is_clear) continue;
        ++seen[known];
        if (shown_at(picture, x, y) != known && ++wrong[known] < 4)
          ADD_FAILURE() << "direction " << direction << " pixel " << x << ", " << y << " is " << int(known)
                        << ", shown " << int(shown_at(picture, x, y));
      }
  }
  for (const Shown known : {Shown::nothing, Shown::outside, Shown::first, Shown::second, Shown::inside})
    EXPECT_GT(seen[known], 150) << int(known) << " was looked at";
  for (const auto& [known, count] : wrong) EXPECT_EQ(count, 0) << int(known) << " of " << seen[known];
}

TEST(Section, FromAnyDirectionARayThroughKnownLayersShowsTheirColours) { expect_rays_show_known_layers(3); }
TEST(Section, SlowFromTenDirectionsARayThroughKnownLayersShowsTheirColours) { expect_rays_show_known_layers(1); }

/// As the shader reads it, between the values.
double depth_between(const render::DepthField& field, Vec3 p) {
  std::array<int, 3> cell;
  std::array<double, 3> part;
  const Vec3 from = p - field.low;
  for (std::size_t a = 0; a < 3; ++a) {
    const double place = (a == 0   ? from.x / field.size.x
                          : a == 1 ? from.y / field.size.y
                                   : from.z / field.size.z) *
                             field.count[a] -
                         0.5;
    cell[a] = int(std::floor(place)), part[a] = place - cell[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::size_t at = 0, stride = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const int up = corner >> a & 1;
      weight *= up ? part[a] : 1 - part[a];
      at += stride * std::size_t(std::clamp(cell[a] + up, 0, field.count[a] - 1)),
          stride *= std::size_t(field.count[a]);
    }
    sum += weight * field.depth[at];
  }
  return sum;
}

TEST(Section, ADepthSmallerThanTheGridIsKnown) {
  const Surface surface = star_surface(blob, 60);
  const render::DepthField field(surface, 0.004, 0.0006);
  const double grid = field.size.x / field.count[0];
  ASSERT_GT(grid, 0.0007);
  render::Shading shading;
  render::find_normals(surface, surface.vertex, shading);
  for (std::size_t v = 0; v < surface.vertex.size(); v += 7)
    for (const double depth : {-0.0003, 0.0003, 0.0006, 0.002})
      EXPECT_NEAR(depth_between(field, surface.vertex[v] - depth * shading.normal[v]), depth, 0.00015) << v;
}

double light_at(const render::Frame& frame, const render::Camera& camera, Vec3 p) {
  const render::Pixel at = render::project(camera, kWidth, kHeight, p);
  const std::size_t i = (std::size_t(at.y) * kWidth + std::size_t(at.x)) * 3;
  return double(frame.rgb[i]) + frame.rgb[i + 1] + frame.rgb[i + 2];
}

/// The section through the middle across y, with nothing around it.
render::DrawOptions section_from_side(const render::SceneView& view) {
  render::DrawOptions options;
  options.show_ground = false;
  options.camera = render::fit_camera(render::rest_bounds(view), {0, 1, 0}, {0, 0, 1});
  options.cutaway = {{0, 0, 0}, {0, -1, 0}};
  return options;
}

TEST(Section, ItsTextureStaysWithTheTissue) {
  const auto scene = make_blob_scene();
  auto made = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(made);
  render::DrawOptions options = section_from_side(scene->view);
  State state = rest_state(scene->model);
  const render::Frame before = (*made)->draw(state, options);
  const Vec3 shift{0.0137, 0, 0};
  for (std::size_t i = 0; i < scene->model.sphere_count(); ++i) state.position.add(i, shift);
  for (Vec3* place : {&options.camera.eye, &options.camera.target, &options.cutaway.point}) *place += shift;
  const render::Frame after = (*made)->draw(state, options);
  int changed = 0;
  for (std::size_t i = 0; i < before.rgb.size(); ++i) changed += std::abs(before.rgb[i] - after.rgb[i]) > 6;
  EXPECT_LT(changed, 60) << "of " << before.rgb.size();
}

TEST(Section, ItsRimAndEachLayerBelowAnotherAreInShade) {
  const auto scene = make_layered_scene(40);
  auto made = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(made);
  render::DrawOptions options = section_from_side(scene->view);
  options.camera.fov_deg *= 0.4, options.camera.target.z += 0.015;
  const render::Frame picture = (*made)->draw(rest_state(scene->model), options);
  double top = 0;
  for (const Vec3& p : scene->model.surfaces[0].vertex) top = std::max(top, p.z);
  // Along the middle, where the surface is level and a depth is a height; the mean of many places has no texture.
  const auto light_at_depth = [&](double depth) {
    double sum = 0;
    for (int i = -20; i <= 20; ++i) sum += light_at(picture, options.camera, {0.0003 * i, 0, top - depth});
    return sum;
  };
  EXPECT_LT(light_at_depth(0.0007), 0.9 * light_at_depth(0.0035));
  EXPECT_LT(light_at_depth(kFirstEnds + 0.0007), 0.85 * light_at_depth(kFirstEnds + 0.0045));
  EXPECT_LT(light_at_depth(kSecondEnds + 0.0007), 0.85 * light_at_depth(kSecondEnds + 0.006));
}

TEST(Section, WhatIsLeftOutCastsNoShadow) {
  const auto scene = make_blob_scene();
  auto made = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(made);
  render::DrawOptions options;
  options.camera = {{0.25, -0.45, 0.35}, {0, 0, -0.02}, {0, 0, 1}, 32};
  options.cutaway = {{-0.03, 0, 0}, {1, 0, 0}};
  const State state = rest_state(scene->model);
  const render::Frame picture = (*made)->draw(state, options);
  options.cutaway.point.x = -1;  // nothing is left
  const render::Frame empty = (*made)->draw(state, options);
  const Vec3 under_left_out{0.035, 0, -0.031}, under_kept{-0.042, -0.012, -0.031};
  EXPECT_GT(light_at(picture, options.camera, under_left_out), 0.95 * light_at(empty, options.camera, under_left_out));
  EXPECT_LT(light_at(picture, options.camera, under_kept), 0.9 * light_at(empty, options.camera, under_kept));
}

TEST(Section, AClosedCutIsALine) {
  const auto scene = make_blob_scene();
  auto made = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(made);
  render::DrawOptions options = section_from_side(scene->view);
  options.camera.fov_deg *= 0.5;
  const render::Frame whole = (*made)->draw(rest_state(scene->model), options);
  const State cut_open = cut_along_y(scene->model, 0.01, 0.02, 0);
  const render::Frame picture = (*made)->draw(cut_open, options);
  const auto share = [&](double x, double z) {
    const Vec3 place{x, 0, z};
    return light_at(picture, options.camera, place) / light_at(whole, options.camera, place);
  };
  for (const double z : {0.003, 0.008, 0.013, 0.018}) {
    EXPECT_LT(share(0.01, z), 0.9) << z;
    for (const double aside : {-0.004, 0.004}) EXPECT_NEAR(share(0.01 + aside, z), 1, 0.03) << z;
  }
  EXPECT_NEAR(share(0.01, -0.004), 1, 0.03) << "below the cut";
}

}  // namespace
}  // namespace ctpm::render_test
