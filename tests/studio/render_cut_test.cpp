#include <gtest/gtest.h>

#include "studio/render/cut_surface.h"
#include "tests/studio/render_scene.h"

namespace ctpm::render_test {
namespace {

/// A blade along z that goes through the organ in the plane x = `x`, from one side to `end` in y, down to
/// `bottom`.
State cut_along_y(const Model& model, double x, double end, double bottom) {
  State state = rest_state(model);
  cut(model, state, {{x, -0.1, bottom}, {x, -0.1, 0.1}}, {{x, end, bottom}, {x, end, 0.1}});
  return state;
}

double area(const Surface& surface, std::size_t triangles) {
  double sum = 0;
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto& t = surface.triangle[i];
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])];
    sum += 0.5 * norm(cross(b - a, c - a));
  }
  return sum;
}

TEST(CutSurface, WithoutACutIsTheWholeSurface) {
  const auto scene = make_blob_scene();
  CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
  EXPECT_FALSE(cut_surface.update(rest_state(scene->model)));
  EXPECT_EQ(cut_surface.surface().triangle, scene->view.surfaces[0].triangle);
  const State severed = cut_along_y(scene->model, 0, 0.1, 0);
  EXPECT_TRUE(cut_surface.update(severed));
  EXPECT_FALSE(cut_surface.update(severed));
  EXPECT_TRUE(cut_surface.update(rest_state(scene->model)));
  EXPECT_EQ(cut_surface.surface().triangle, scene->view.surfaces[0].triangle);
  EXPECT_EQ(cut_surface.outer_triangle_count(), scene->view.surfaces[0].triangle.size());
}

TEST(CutSurface, SplitTrianglesKeepTheWholeArea) {
  const auto scene = make_blob_scene();
  const double whole = area(scene->view.surfaces[0], scene->view.surfaces[0].triangle.size());
  for (const double bottom : {-0.1, 0.0, 0.01}) {
    CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
    State state = cut_along_y(scene->model, 0.001, 0.02, bottom);
    cut(scene->model, state, {{-0.1, 0, bottom}, {-0.1, 0.01, 0.1}},
        {{0.1, 0, bottom}, {0.1, 0.01, 0.1}});  // a second cut, across
    cut_surface.update(state);
    EXPECT_GT(cut_surface.outer_triangle_count(), scene->view.surfaces[0].triangle.size());
    EXPECT_GT(cut_surface.surface().triangle.size(), cut_surface.outer_triangle_count());
    EXPECT_NEAR(area(cut_surface.surface(), cut_surface.outer_triangle_count()), whole, 1e-9 * whole);
  }
}

/// The largest change of length of any edge of any triangle [m].
double worst_stretch(const CutSurface& cut_surface, const State& state) {
  std::vector<Vec3> moved;
  const Surface& surface = cut_surface.surface();
  deform_surface(surface, state.position, 0, moved);
  double worst = 0;
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = std::size_t(t[i]), b = std::size_t(t[(i + 1) % 3]);
      worst =
          std::max(worst, std::abs(norm(moved[a] - moved[b]) - norm(surface.vertex[a] - surface.vertex[b])));
    }
  return worst;
}

TEST(CutSurface, PiecesOfAFullCutMoveApartWithoutStretchingATriangle) {
  const auto scene = make_blob_scene();
  for (const double lean : {0.0, 0.4, 1.0}) {  // the plane x = lean y
    State state = rest_state(scene->model);
    cut(scene->model, state, {{-0.1 * lean, -0.1, -0.1}, {-0.1 * lean, -0.1, 0.1}},
        {{0.1 * lean, 0.1, -0.1}, {0.1 * lean, 0.1, 0.1}});
    CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
    ASSERT_TRUE(cut_surface.update(state));
    spread(state, scene->model, [&](Vec3 p) { return p.x > lean * p.y ? Vec3{0.05, 0.01, 0} : Vec3{}; });
    EXPECT_LT(worst_stretch(cut_surface, state), 1e-12) << "lean " << lean;  // rounding only
  }
}

/// Backdrop that cannot be reached from the picture's edge: what one sees through a hole.
int holes(const Frame& picture, const Frame& backdrop) {
  const int w = picture.width, h = picture.height;
  std::vector<int> kind(std::size_t(w * h));  // 1: backdrop, 2: backdrop reached from the edge
  for (std::size_t i = 0; i < kind.size(); ++i) {
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(picture.rgb[3 * i + c] - backdrop.rgb[3 * i + c]));
    kind[i] = worst <= 4;
  }
  std::vector<int> stack;
  const auto reach = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= w || y >= h || kind[std::size_t(y * w + x)] != 1) return;
    kind[std::size_t(y * w + x)] = 2, stack.push_back(y * w + x);
  };
  for (int x = 0; x < w; ++x) reach(x, 0), reach(x, h - 1);
  for (int y = 0; y < h; ++y) reach(0, y), reach(w - 1, y);
  while (!stack.empty()) {
    const int x = stack.back() % w, y = stack.back() / w;
    stack.pop_back();
    reach(x - 1, y), reach(x + 1, y), reach(x, y - 1), reach(x, y + 1);
  }
  return int(std::count(kind.begin(), kind.end(), 1));
}

TEST(CutPicture, OpensShowsItsWallAndNoBackground) {
  const auto scene = make_blob_scene();
  SceneView view = scene->view;
  view.looks = {look_of("liver")};
  view.looks[0].inner = {0.1, 0.7, 0.2};  // green, which is nowhere else
  auto made = Renderer::create(480, 270, view);
  ASSERT_TRUE(made);
  Renderer& renderer = **made;
  const State rest = rest_state(scene->model);
  State state = cut_along_y(scene->model, 0.0, 0.02, -0.005);
  // Open it by up to 8 mm at the top, tapering to its bottom and its end.
  spread(state, scene->model, [](Vec3 p) {
    const double open =
        std::clamp((p.z + 0.005) / 0.03, 0.0, 1.0) * std::clamp((0.02 - p.y) / 0.04, 0.0, 1.0);
    return Vec3{(p.x > 0 ? 0.004 : -0.004) * open, 0, 0};
  });
  for (const Vec3 direction : {Vec3{0.1, 0.35, -1}, Vec3{0, 0.8, -1}}) {
    DrawOptions options;
    options.camera = fit_camera(rest_bounds(view), direction, {0, 1, 0});
    options.show_ground = false;
    const Frame before = renderer.draw(rest, options), after = renderer.draw(state, options);
    DrawOptions away = options;
    away.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
    const Frame backdrop = renderer.draw(rest, away);
    const auto green = [](const Frame& f) {
      int count = 0;
      for (std::size_t i = 0; i < f.rgb.size(); i += 3)
        count += f.rgb[i + 1] > f.rgb[i] + 25 && f.rgb[i + 1] > f.rgb[i + 2] + 25;
      return count;
    };
    EXPECT_EQ(green(before), 0);
    EXPECT_GT(green(after), 300);
    EXPECT_EQ(holes(after, backdrop), 0);
  }
}

}  // namespace
}  // namespace ctpm::render_test
