#include <gtest/gtest.h>

#include <filesystem>

#include "tests/studio/output/short_files.h"
#include "tests/studio/render/scene.h"

namespace ctpm::render_test {
namespace {

constexpr int kWidth = 480, kHeight = 270;

std::unique_ptr<render::Renderer> make_renderer(const TestScene& scene) {
  auto made = render::Renderer::create(kWidth, kHeight, scene.view);
  if (!made) ADD_FAILURE() << to_string(made.errors()[0]);
  return *std::move(made);
}

int difference(const render::Frame& a, const render::Frame& b, std::size_t pixel) {
  int worst = 0;
  for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.rgb[3 * pixel + c] - b.rgb[3 * pixel + c]));
  return worst;
}

/// Pixels whose centre a projected triangle covers.
std::vector<bool> projected_mask(const Surface& surface, const render::Camera& camera) {
  std::vector<bool> mask(kWidth * kHeight);
  for (const auto& t : surface.triangle) {
    render::Pixel p[3];
    for (std::size_t i = 0; i < 3; ++i)
      p[i] = render::project(camera, kWidth, kHeight, surface.vertex[std::size_t(t[i])]);
    const int top = int(std::min({p[0].y, p[1].y, p[2].y})), bottom = int(std::max({p[0].y, p[1].y, p[2].y})) + 1;
    const int left = int(std::min({p[0].x, p[1].x, p[2].x})), right = int(std::max({p[0].x, p[1].x, p[2].x})) + 1;
    for (int y = std::max(top, 0); y < std::min(bottom, kHeight); ++y)
      for (int x = std::max(left, 0); x < std::min(right, kWidth); ++x) {
        double turn[3];
        for (std::size_t i = 0; i < 3; ++i) {
          const render::Pixel a = p[i], b = p[(i + 1) % 3];
          turn[i] = (b.x - a.x) * (y + 0.5 - a.y) - (b.y - a.y) * (x + 0.5 - a.x);
        }
        if ((turn[0] >= 0 && turn[1] >= 0 && turn[2] >= 0) || (turn[0] <= 0 && turn[1] <= 0 && turn[2] <= 0))
          mask[std::size_t(y * kWidth + x)] = true;
      }
  }
  return mask;
}

TEST(Picture, SilhouetteIsThatOfTheProjectedMesh) {
  const auto scene = make_blob_scene();
  auto renderer = make_renderer(*scene);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  options.show_ground = false;
  const State state = rest_state(scene->model);
  const render::Frame picture = renderer->draw(state, options);
  render::DrawOptions away = options;  // the backdrop does not depend on the camera
  away.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
  const render::Frame backdrop = renderer->draw(state, away);
  const std::vector<bool> mask = projected_mask(scene->model.surfaces[0], options.camera);
  int covered = 0, wrong = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    covered += mask[i];
    wrong += mask[i] != (difference(picture, backdrop, i) > 12);
  }
  EXPECT_GT(covered, kWidth * kHeight / 20);
  EXPECT_LT(wrong, 0.02 * covered) << "of " << covered << " pixels";  // the anti-aliased outline
}

TEST(Picture, AnOutlineHasNoDarkSeam) {
  const auto scene = make_blob_scene();
  auto renderer = make_renderer(*scene);
  render::DrawOptions options;
  options.show_ground = false;
  int seen = 0, dark = 0;
  for (const Vec3 way : {Vec3{0.2, 1, -0.6}, Vec3{1, 0.3, -0.8}, Vec3{-0.5, -1, -0.4}}) {
    options.camera = render::fit_camera(render::rest_bounds(scene->view), way, {0, 0, 1});
    const render::Frame picture = renderer->draw(rest_state(scene->model), options);
    const std::vector<bool> mask = projected_mask(scene->model.surfaces[0], options.camera);
    const auto luma = [&](int x, int y) {
      const std::uint8_t* p = &picture.rgb[std::size_t(3 * (y * kWidth + x))];
      return 0.3 * p[0] + 0.59 * p[1] + 0.11 * p[2];
    };
    for (int x = 0; x < kWidth; ++x) {
      int top = 0;
      while (top + 4 < kHeight && !mask[std::size_t(top * kWidth + x)]) ++top;
      if (top + 4 == kHeight) continue;
      // Between the bright backdrop and the tissue the outline's own pixels are no darker than either.
      ++seen, dark += luma(x, top) < 0.9 * std::min(luma(x, top + 2), luma(x, top + 3));
    }
  }
  EXPECT_GT(seen, 500);
  EXPECT_LT(dark, seen / 100) << dark << " of " << seen;
}

TEST(Picture, FollowsTheSpheres) {
  const auto scene = make_blob_scene();
  auto renderer = make_renderer(*scene);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  options.show_ground = false;
  State state = rest_state(scene->model);
  const Vec3 shift{0.02, 0, 0};
  for (std::size_t i = 0; i < scene->model.sphere_count(); ++i) state.position.add(i, shift);
  const render::Frame moved = renderer->draw(state, options);
  Surface surface = scene->model.surfaces[0];
  for (Vec3& v : surface.vertex) v += shift;
  const std::vector<bool> mask = projected_mask(surface, options.camera);
  int covered = 0, red = 0;
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) ++covered, red += moved.rgb[3 * i] > moved.rgb[3 * i + 2] + 10;
  EXPECT_GT(red, 0.95 * covered);
}

TEST(Picture, ShowsTheToolWhereItIs) {
  const auto scene = make_blob_scene();
  auto renderer = make_renderer(*scene);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  options.camera.eye = options.camera.eye + 0.8 * (options.camera.eye - options.camera.target);  // room for the tool
  State state = rest_state(scene->model);
  const render::Frame without = renderer->draw(state, options);
  for (const std::int32_t tool : {0, 1}) {
    state.last_inputs.tool = tool;
    state.last_inputs.position = {0, 0, 0.045};
    const render::Frame with = renderer->draw(state, options);
    // The ball's middle; the blade a third up its edge and a little towards its back.
    const Vec3 inside = state.last_inputs.position + (tool ? Vec3{-0.003, 0, 0.012} : Vec3{});
    const render::Pixel at = render::project(options.camera, kWidth, kHeight, inside);
    ASSERT_TRUE(at.x >= 0 && at.x < kWidth && at.y >= 0 && at.y < kHeight) << at.x << ", " << at.y;
    EXPECT_GT(difference(with, without, std::size_t(int(at.y) * kWidth + int(at.x))), 20) << "tool " << tool;
    options.show_tool = false;
    EXPECT_EQ(renderer->draw(state, options), without);
    options.show_tool = true;
  }
}

TEST(Picture, ShowsTheToolOfEitherHandAlike) {
  const auto scene = make_blob_scene();
  auto renderer = make_renderer(*scene);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  State first = rest_state(scene->model), second = first, both = first;
  const render::Frame without = renderer->draw(first, options);
  first.last_inputs.tool = 0, first.last_inputs.position = {0, 0, 0.04};
  second.last_inputs.second = first.last_inputs;
  both.last_inputs.second = first.last_inputs;
  both.last_inputs.tool = 1, both.last_inputs.position = {0.03, 0, 0.04};
  const render::Frame of_first = renderer->draw(first, options), of_second = renderer->draw(second, options),
                      of_both = renderer->draw(both, options);
  EXPECT_NE(of_first, without);
  EXPECT_EQ(of_first, of_second) << "with its shadow";
  EXPECT_NE(of_both, of_second);
}

TEST(Picture, SameStateGivesSamePixelsWhateverWasDrawnBefore) {
  const auto scene = make_blob_scene();
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  for (const render::View view : {render::View::surface, render::View::spheres, render::View::both}) {
    options.view = view;
    auto renderer = make_renderer(*scene);
    const State rest = rest_state(scene->model);
    State severed = rest;
    cut(scene->model, severed, {{0, -0.1, 0}, {0, -0.1, 0.1}}, {{0, 0.1, 0}, {0, 0.1, 0.1}});
    const render::Frame first = renderer->draw(rest, options);
    const render::Frame cut_open = renderer->draw(severed, options);
    EXPECT_EQ(renderer->draw(rest, options), first);
    auto other = make_renderer(*scene);
    EXPECT_EQ(other->draw(severed, options), cut_open);
    EXPECT_EQ(renderer->draw(rest, options), first) << "with two renderers in turn";
  }
}

TEST(Picture, ViewsDiffer) {
  const auto scene = make_blob_scene();
  auto renderer = make_renderer(*scene);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  const State state = rest_state(scene->model);
  const render::Frame surface = renderer->draw(state, options);
  options.view = render::View::spheres;
  const render::Frame spheres = renderer->draw(state, options);
  options.view = render::View::both;
  const render::Frame both = renderer->draw(state, options);
  int changed_spheres = 0, changed_both = 0;
  for (std::size_t i = 0; i < kWidth * kHeight; ++i)
    changed_spheres += difference(surface, spheres, i) > 30, changed_both += difference(spheres, both, i) > 10;
  EXPECT_GT(changed_spheres, 1000);
  EXPECT_GT(changed_both, 1000);
}

TEST(Picture, TrianglesThatReachOutOfItAreLitAsAllOthers) {
  for (const int rows : {6, 12, 40}) {  // large triangles and small ones
    const auto scene = make_blob_scene(0.004, rows);
    auto renderer = make_renderer(*scene);
    for (const double zoom : {0.15, 0.3, 0.6})
      for (const double aside : {-0.03, 0.0, 0.03}) {
        render::DrawOptions options;
        options.camera = render::default_camera(scene->view);
        options.camera.fov_deg *= zoom;
        options.camera.eye.x += aside, options.camera.target.x += aside;
        const render::Frame picture = renderer->draw(rest_state(scene->model), options);
        int black = 0;
        for (std::size_t i = 0; i < picture.rgb.size(); i += 3) black += picture.rgb[i] < 25;
        EXPECT_EQ(black, 0) << rows << " rows, " << zoom << " of the view, " << aside << " m aside";
      }
  }
}

TEST(Picture, BadSizeOrSceneIsAnErrorNotAPicture) {
  const auto scene = make_blob_scene(0.004, 12);
  for (const auto& [width, height] : {std::pair{0, 100}, {100, -1}, {100, 100000}}) {
    const auto made = render::Renderer::create(width, height, scene->view);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.errors()[0].where, "picture size");
  }
  scene->model.surfaces.clear();
  const auto made = render::Renderer::create(100, 100, scene->view);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.errors()[0].where, "scene");
}

TEST(Png, IsReadBackAsWritten) {
  const auto scene = make_blob_scene(0.004, 12);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  const render::Frame frame = make_renderer(*scene)->draw(rest_state(scene->model), options);
  const std::string path = ::testing::TempDir() + "/render_picture.png";
  ASSERT_TRUE(render::write_png(path, frame));
  const auto back = render::read_png(path);
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, frame);
  std::filesystem::remove(path);
}

TEST(Png, ADiskThatTakesNoMoreIsAnErrorWithItsReasonAndLeavesNothing) {
  const std::string folder = ::testing::TempDir() + "/full_folder";
  std::filesystem::create_directory(folder);
  const auto written = [&] {
    const testing::ShortFiles full(100);
    return render::write_png(folder + "/a.png", render::blank_frame(400, 400, 1, 2, 3));
  }();
  ASSERT_FALSE(written);
  EXPECT_EQ(written.errors()[0].message, "cannot be written: File too large");
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove(folder);
}

TEST(Png, BadTargetIsAnErrorAndLeavesNothing) {
  const std::string folder = ::testing::TempDir() + "/no_such_folder";
  const auto missing = render::write_png(folder + "/a.png", render::blank_frame(4, 4, 1, 2, 3));
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.errors()[0].where, folder + "/a.png");
  EXPECT_FALSE(std::filesystem::exists(folder));
  EXPECT_FALSE(render::write_png(::testing::TempDir() + "/a.jpg", render::blank_frame(4, 4, 1, 2, 3)));
  EXPECT_FALSE(render::write_png(::testing::TempDir() + "/a.png", render::Frame{}));
  EXPECT_FALSE(std::filesystem::exists(::testing::TempDir() + "/a.png"));
}

}  // namespace
}  // namespace ctpm::render_test
