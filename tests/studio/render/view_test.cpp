#include <gtest/gtest.h>

#include "studio/render/element_values.h"
#include "tests/studio/render/scene.h"

namespace ctpm::render_test {
namespace {

int count_green(const render::Frame& f) {
  int count = 0;
  for (std::size_t i = 0; i < f.rgb.size(); i += 3)
    count += f.rgb[i + 1] > f.rgb[i] + 25 && f.rgb[i + 1] > f.rgb[i + 2] + 25;
  return count;
}

TEST(ElementValues, AnEvenStretchIsThatOfEveryElement) {
  const auto scene = make_blob_scene(0.004, 12);
  State state = rest_state(scene->model);
  constexpr double kStretch = 0.05;
  for (std::size_t i = 0; i < scene->model.sphere_count(); ++i)
    state.position.set(i, (1 + kStretch) * scene->model.rest_position[i]);
  std::vector<render::ElementValue> values;
  render::measure_elements(scene->model, state, render::ElementQuantity::stretch, values);
  ASSERT_EQ(values.size(), scene->model.axial.size());
  for (const render::ElementValue& e : values) EXPECT_NEAR(e.value, kStretch, 1e-12);  // rounding only
  render::measure_elements(scene->model, state, render::ElementQuantity::tilt, values);
  ASSERT_EQ(values.size(), 2 * scene->model.constraints.size());
  for (const render::ElementValue& e : values) EXPECT_NEAR(e.value, 0, 1e-6);
  render::measure_elements(scene->model, state, render::ElementQuantity::force, values);
  const AxialElements& axial = scene->model.axial;
  for (std::size_t i = 0; i < axial.size(); ++i)
    EXPECT_NEAR(values[i].value, axial.k[i] * kStretch * axial.rest_length[i], 1e-9 * axial.k[i]);
}

TEST(ElementValues, SeveredElementsAreNotShown) {
  const auto scene = make_blob_scene(0.004, 12);
  State state = rest_state(scene->model);
  std::vector<render::ElementValue> whole, rest;
  render::measure_elements(scene->model, state, render::ElementQuantity::stretch, whole);
  cut(scene->model, state, {{0, -0.1, -0.1}, {0, -0.1, 0.1}}, {{0, 0.1, -0.1}, {0, 0.1, 0.1}});
  render::measure_elements(scene->model, state, render::ElementQuantity::stretch, rest);
  EXPECT_LT(rest.size(), whole.size());
  for (const render::ElementValue& e : rest)
    EXPECT_GT(scene->model.rest_position[std::size_t(e.a)].x * scene->model.rest_position[std::size_t(e.b)].x, 0);
}

TEST(View, CutawayShowsASolidSectionAndNothingBeyondIt) {
  const auto scene = make_blob_scene();
  render::SceneView view = scene->view;
  view.looks = {render::look_of("liver")};
  view.looks[0].inner = {0.1, 0.7, 0.2};  // green, which is nowhere else
  auto renderer = render::Renderer::create(480, 270, view);
  ASSERT_TRUE(renderer);
  render::DrawOptions options;
  options.camera = render::fit_camera(render::rest_bounds(view), {0, 1, 0}, {0, 0, 1});
  options.show_ground = false;
  const State state = rest_state(scene->model);
  const render::Frame whole = (*renderer)->draw(state, options);
  EXPECT_EQ(count_green(whole), 0);
  options.cutaway = {{0, 0, 0}, {0, -1, 0}};
  const render::Frame half = (*renderer)->draw(state, options);
  // The section of an ellipsoid through its middle, seen straight on, fills its outline.
  int outline = 0;
  for (std::size_t i = 0; i < whole.rgb.size(); i += 3) outline += whole.rgb[i] > whole.rgb[i + 2] + 25;
  EXPECT_GT(count_green(half), 0.85 * outline);
  options.cutaway.point.y = -1;  // everything is on the side that is left out
  options.cutaway.normal = {0, 1, 0};
  const render::Frame none = (*renderer)->draw(state, options);
  options.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
  EXPECT_EQ(none, (*renderer)->draw(state, options)) << "only the backdrop is left";
}

TEST(View, AnOrganOnABoxCastsItsShadowOnTheTop) {
  const auto scene = make_blob_scene(0.004, 12);
  scene->model.obstacles = {{"table", ObstacleKind::box, {0, 0, -0.04}, {}, {0.2, 0.2, 0.01}}};
  auto renderer = render::Renderer::create(480, 270, scene->view);
  ASSERT_TRUE(renderer);
  render::DrawOptions options;
  options.camera = {{0, -0.6, 0.4}, {0, -0.05, -0.03}, {0, 0, 1}, 32};
  State state = rest_state(scene->model);
  const render::Frame on_it = (*renderer)->draw(state, options);
  for (double& z : state.position.z) z += 5;
  const render::Frame alone = (*renderer)->draw(state, options);
  const auto light_at = [&](const render::Frame& frame, Vec3 p) {
    const render::Pixel at = render::project(options.camera, 480, 270, p);
    const std::size_t i = (std::size_t(at.y) * 480 + std::size_t(at.x)) * 3;
    return double(frame.rgb[i]) + frame.rgb[i + 1] + frame.rgb[i + 2];
  };
  // Under the organ's edge, and far aside.
  const Vec3 near{0, -0.045, -0.03}, far{0.17, -0.17, -0.03};
  EXPECT_LT(light_at(on_it, near), 0.9 * light_at(alone, near));
  EXPECT_NEAR(light_at(on_it, far), light_at(alone, far), 0.02 * light_at(alone, far));
}

TEST(View, ElementsShowColoursOfTheirLegend) {
  const auto scene = make_blob_scene(0.004, 12);
  auto renderer = render::Renderer::create(480, 270, scene->view);
  ASSERT_TRUE(renderer);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  options.view = render::View::elements;
  State state = rest_state(scene->model);
  const auto blueness = [&](double stretch) {
    State moved = state;
    for (std::size_t i = 0; i < scene->model.sphere_count(); ++i)
      moved.position.set(i, (1 + stretch) * scene->model.rest_position[i]);
    options.show_ground = false;
    const render::Frame frame = (*renderer)->draw(moved, options);
    options.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
    const render::Frame backdrop = (*renderer)->draw(moved, options);
    options.camera = render::default_camera(scene->view);
    double sum = 0;
    for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
      if (std::abs(frame.rgb[i] - backdrop.rgb[i]) > 20) sum += double(frame.rgb[i + 2]) - frame.rgb[i];
    return sum;
  };
  EXPECT_GT(blueness(-0.2), 1000) << "pressed elements are blue";
  EXPECT_LT(blueness(0.2), -1000) << "pulled elements are red";
  EXPECT_EQ(render::legend_of(scene->model, options).high, "+20");
  options.quantity = render::ElementQuantity::force, options.full_scale = 0.25;
  EXPECT_EQ(render::legend_of(scene->model, options).high, "0.25");
  options.view = render::View::surface;
  EXPECT_TRUE(render::legend_of(scene->model, options).title.empty());
}

TEST(View, FollowingCameraNearsTheToolThatWorks) {
  const auto scene = make_blob_scene(0.004, 12);
  const render::Camera base = render::default_camera(scene->view);
  Inputs inputs;
  const auto follow = [&] { return render::following_camera(scene->view, base, {&inputs, 1}); };
  const auto distance = [](const render::Camera& c) { return norm(c.eye - c.target); };
  EXPECT_EQ(distance(follow()), distance(base));
  inputs.tool = 0, inputs.position = {0, 0, 10};
  EXPECT_EQ(distance(follow()), distance(base)) << "far away";
  double last = distance(base);
  for (const double height : {0.06, 0.05, 0.04, 0.03}) {
    inputs.position.z = height;
    EXPECT_LT(distance(follow()), last);
    last = distance(follow());
  }
  inputs.position = {0.05, 0, 0.02};
  EXPECT_LT(norm(follow().target - inputs.position), norm(base.target - inputs.position) / 2);
  // The second hand is followed alike, and two hands at a place between them.
  const render::Camera first = follow();
  inputs.second = inputs, static_cast<Hand&>(inputs) = {};
  EXPECT_EQ(follow().target, first.target);
  EXPECT_EQ(follow().eye, first.eye);
  inputs.tool = 0, inputs.position = {-0.05, 0, 0.02}, inputs.second.tool = 1;
  EXPECT_LT(std::abs(follow().target.x - base.target.x), 5e-3);
}

TEST(View, FollowingCameraMovesSoftlyWhenTheToolIsPutAwayAtTheTissue) {
  const auto scene = make_blob_scene(0.004, 12);
  const render::Camera base = render::default_camera(scene->view);
  // Two seconds of work at the tissue, then nothing is held.
  std::vector<Inputs> all(400);
  for (std::size_t i = 0; i < 200; ++i) all[i].tool = 0, all[i].position = {0.05, 0, 0.02};
  std::vector<Vec3> eye;
  for (std::size_t now = 1; now <= all.size(); ++now) {
    const std::size_t count = std::min(now, render::kFollowedMoments);
    eye.push_back(render::following_camera(scene->view, base, std::span(all).subspan(now - count, count)).eye);
  }
  const double way = norm(eye[199] - base.eye);
  EXPECT_GT(way, 0.02);
  EXPECT_LT(norm(eye[199] - eye[0]), 1e-12) << "it stands still while the tool does";
  EXPECT_EQ(eye.back(), base.eye);
  double fastest = 0, sharpest = 0;
  for (std::size_t i = 2; i < eye.size(); ++i) {
    fastest = std::max(fastest, norm(eye[i] - eye[i - 1]));
    sharpest = std::max(sharpest, norm(eye[i] - 2.0 * eye[i - 1] + eye[i - 2]));
  }
  EXPECT_LT(fastest, way / 50) << "80 moments for the way";
  EXPECT_LT(sharpest, way / 1000) << "it sets out and arrives gently";
}

TEST(View, BesideKeepsBothPictures) {
  const render::Frame left = render::blank_frame(100, 40, 200, 10, 10),
                      right = render::blank_frame(60, 40, 10, 200, 10);
  const render::Frame both = render::join_beside(left, right);
  ASSERT_EQ(both.width, 160);
  ASSERT_EQ(both.height, 40);
  for (int y = 0; y < 40; ++y)
    for (const int x : {0, 50, 98, 101, 130, 159}) {
      const std::uint8_t* pixel = &both.rgb[std::size_t(y * 160 + x) * 3];
      EXPECT_EQ(pixel[0], x < 100 ? 200 : 10);
      EXPECT_EQ(pixel[1], x < 100 ? 10 : 200);
    }
}

TEST(Spheres, AreRedWhereABladeSeveredAnElement) {
  const auto scene = make_blob_scene(0.004, 30);
  const State rest = rest_state(scene->model), cut = cut_along_y(scene->model, 0, 0.1, -0.1);
  EXPECT_TRUE(render::spheres_at_cuts(scene->model, rest).empty());
  const std::vector<std::uint8_t> at_cut = render::spheres_at_cuts(scene->model, cut);
  ASSERT_EQ(at_cut.size(), scene->model.sphere_count());
  for (std::size_t i = 0; i < at_cut.size(); ++i)
    if (at_cut[i]) {
      EXPECT_LT(std::abs(scene->model.rest_position.x[i]), 0.02) << "beside the plane of the cut";
    }
  EXPECT_GT(std::count(at_cut.begin(), at_cut.end(), 1), 10);
  auto renderer = render::Renderer::create(320, 240, scene->view);
  ASSERT_TRUE(renderer);
  render::DrawOptions options;
  options.view = render::View::spheres;
  options.camera = render::fit_camera(render::rest_bounds(scene->view), {0, 0, -1}, {0, 1, 0});
  const auto red = [](const render::Frame& frame) {
    int count = 0;
    for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
      count += frame.rgb[i] > 90 && frame.rgb[i] > 3 * frame.rgb[i + 1] && frame.rgb[i] > 3 * frame.rgb[i + 2];
    return count;
  };
  EXPECT_EQ(red((*renderer)->draw(rest, options)), 0);
  EXPECT_GT(red((*renderer)->draw(cut, options)), 300);
}

}  // namespace
}  // namespace ctpm::render_test
