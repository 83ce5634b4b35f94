#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "core/stepping/step.h"
#include "studio/render/cut_surface.h"
#include "tests/studio/render/scene.h"

namespace ctpm::render_test {
namespace {

TEST(CutPicture, AClosedCutIsALineAndChangesNothingElse) {
  constexpr int kWidth = 640, kHeight = 360, kLine = 3;  // kLine: half the line's width, with smoothed edges [pixels]
  const auto scene = make_blob_scene(0.003, 60);
  auto made = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(made);
  render::DrawOptions options;
  options.camera = render::fit_camera(render::rest_bounds(scene->view), {0.1, 0.35, -1}, {0, 1, 0});
  const State rest = rest_state(scene->model), severed = cut_along_y(scene->model, 0.001, 0.02, -0.005);
  const render::Frame whole = (*made)->draw(rest, options), closed = (*made)->draw(severed, options);
  render::CutSurface cut_surface(scene->model, 0);
  ASSERT_TRUE(cut_surface.update(severed));
  std::vector<bool> near_lip(kWidth * kHeight);
  for (std::size_t v = 0; v < cut_surface.outer_vertex_count(); ++v) {
    if (!cut_surface.is_lip()[v]) continue;
    const render::Pixel at = render::project(options.camera, kWidth, kHeight, cut_surface.surface().vertex[v]);
    for (int y = std::max(0, int(at.y) - 3 * kLine); y < std::min(kHeight, int(at.y) + 3 * kLine); ++y)
      for (int x = std::max(0, int(at.x) - kLine); x < std::min(kWidth, int(at.x) + kLine); ++x)
        near_lip[std::size_t(y * kWidth + x)] = true;
  }
  int darker = 0, other = 0;
  for (std::size_t i = 0; i < near_lip.size(); ++i) {
    int change = 0;
    for (std::size_t c = 0; c < 3; ++c)
      change = std::max(change, std::abs(whole.rgb[3 * i + c] - closed.rgb[3 * i + c]));
    if (near_lip[i])
      darker += closed.rgb[3 * i] + 12 < whole.rgb[3 * i];
    else
      other += change > 8;
  }
  EXPECT_GT(darker, 60) << "the line is seen";
  // Triangles near the cut are others, which the outline and the edge of a highlight may show.
  EXPECT_LT(other, kWidth * kHeight / 1000) << "pixels beside the line that differ by more than 8 of 255";
}

/// Backdrop that cannot be reached from the picture's edge: what one sees through a hole.
int holes(const render::Frame& picture, const render::Frame& backdrop) {
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
  render::SceneView view = scene->view;
  view.looks = {render::look_of("liver")};
  view.looks[0].inner = {0.1, 0.7, 0.2}, view.looks[0].blood = 0;  // green, which is nowhere else
  auto made = render::Renderer::create(480, 270, view);
  ASSERT_TRUE(made);
  render::Renderer& renderer = **made;
  const State rest = rest_state(scene->model);
  State state = cut_along_y(scene->model, 0.0, 0.02, -0.005);
  // Open it by up to 8 mm at the top, tapering to its bottom and its end.
  spread(state, scene->model, [](Vec3 p) {
    const double open = std::clamp((p.z + 0.005) / 0.03, 0.0, 1.0) * std::clamp((0.02 - p.y) / 0.04, 0.0, 1.0);
    return Vec3{(p.x > 0 ? 0.004 : -0.004) * open, 0, 0};
  });
  for (const Vec3 direction : {Vec3{0.1, 0.35, -1}, Vec3{0, 0.8, -1}}) {
    render::DrawOptions options;
    options.camera = render::fit_camera(render::rest_bounds(view), direction, {0, 1, 0});
    options.show_ground = false;
    const render::Frame before = renderer.draw(rest, options), after = renderer.draw(state, options);
    render::DrawOptions away = options;
    away.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
    const render::Frame backdrop = renderer.draw(rest, away);
    const auto green = [](const render::Frame& f) {
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

/// The wall of a full cut in the plane x = 0, seen straight on; the other half is out of sight.
render::Frame picture_of_wall(const TestScene& scene, const render::OrganLook& look,
                              const render::DrawOptions& options) {
  render::SceneView view = scene.view;
  view.looks = {look};
  auto made = render::Renderer::create(480, 360, view);
  EXPECT_TRUE(made);
  State state = cut_along_y(scene.model, 0, 0.1, -0.1);
  spread(state, scene.model, [](Vec3 p) { return p.x > 0 ? Vec3{0, 0, -1} : Vec3{}; });
  return (*made)->draw(state, options);
}

TEST(CutPicture, AFreshWallBleedsAndASectionDoesNot) {
  const auto scene = make_blob_scene(0.002, 60);
  render::DrawOptions options;
  options.camera = render::fit_camera(render::rest_bounds(scene->view), {-1, 0, 0}, {0, 0, 1});
  options.show_ground = false;
  render::OrganLook bleeding = render::look_of("skin"), dry = bleeding;
  bleeding.blood = 1, dry.blood = 0, bleeding.wetness = dry.wetness = 0;
  const auto redness = [](const render::Frame& frame) {
    double sum = 0;
    for (int y = 150; y < 210; ++y)
      for (int x = 210; x < 270; ++x) {
        const std::uint8_t* p = &frame.rgb[std::size_t(y * frame.width + x) * 3];
        sum += double(p[0]) / (p[1] + p[2] + 1);
      }
    return sum / 3600;
  };
  EXPECT_GT(redness(picture_of_wall(*scene, bleeding, options)), 1.06 * redness(picture_of_wall(*scene, dry, options)));
  options.cutaway = {{0.0, 0, 0}, {1, 0, 0}};
  std::vector<render::Frame> sections;
  for (const render::OrganLook& look : {bleeding, dry}) {
    render::SceneView view = scene->view;
    view.looks = {look};
    auto made = render::Renderer::create(480, 360, view);
    ASSERT_TRUE(made);
    options.camera = render::fit_camera(render::rest_bounds(scene->view), {-1, 0, 0}, {0, 0, 1});
    sections.push_back((*made)->draw(rest_state(scene->model), options));
  }
  EXPECT_EQ(sections[0], sections[1]);
}

TEST(CutPicture, ItsWallIsPalerInTheOutermostLayer) {
  const auto layered = make_blob_scene(0.002, 60), plain = make_blob_scene(0.002, 60);
  ASSERT_GT(layered->model.organs[0].layer_count, 3);
  plain->model.organs[0].layer_count = 1;
  std::fill(plain->model.layer.begin(), plain->model.layer.end(), 1);
  render::DrawOptions options;
  options.camera = render::fit_camera(render::rest_bounds(layered->view), {-1, 0, 0}, {0, 0, 1});
  options.show_ground = false;
  for (const char* organ : {"liver", "kidney", "skin"}) {
    render::OrganLook look = render::look_of(organ), other = look;
    look.wetness = other.wetness = 0, other.outer = {0.2, 0.9, 0.9};
    const render::Frame layers = picture_of_wall(*layered, look, options), one = picture_of_wall(*plain, look, options),
                        recoloured = picture_of_wall(*plain, other, options);
    std::array<double, 2> paler{};  // green over red that the layers add: near the surface, deep inside
    std::array<int, 2> pixels{};
    for (double y = -0.045; y < 0.045; y += 0.0005)
      for (double z = -0.03; z < 0.03; z += 0.0005) {
        const double depth = -blob({0, y, z});
        const bool is_near = depth > 0.001 && depth < 0.003;
        const bool is_deep = depth > 0.021;
        if (!is_near && !is_deep) continue;
        const render::Pixel at = render::project(options.camera, layers.width, layers.height, {0, y, z});
        const std::size_t i = 3 * (std::size_t(at.y) * std::size_t(layers.width) + std::size_t(at.x));
        const auto green = [i](const render::Frame& f) { return f.rgb[i + 1] / double(f.rgb[i]); };
        paler[is_deep] += green(layers) - green(one), ++pixels[is_deep];
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(one.rgb[i + c], recoloured.rgb[i + c], 1) << organ << ": one layer has the inner colour";
          if (is_deep)
            EXPECT_NEAR(layers.rgb[i + c], one.rgb[i + c], 1) << organ << ": and so has the inside";
          else
            EXPECT_GE(layers.rgb[i + c] + 1, one.rgb[i + c]) << organ << ": no channel is darker";
        }
      }
    ASSERT_GT(std::min(pixels[0], pixels[1]), 500);
    EXPECT_GT(paler[0] / pixels[0], 0.05) << organ;
    EXPECT_LT(std::abs(paler[1] / pixels[1]), 0.002) << organ;
  }
}

/// The blob with a capsule under tension, held below, and a blade on its way through the top of it: the states at
/// two fifths, seven tenths and the whole of the way, and a quarter of a second later.
struct Stages {
  std::unique_ptr<TestScene> scene;
  std::vector<State> states;
};

Stages cut_in_stages() {
  Stages stages;
  const FilledOrgan organ = fill(blob, star_surface(blob, 60), 0.0025);
  network::OrganSettings settings;
  settings.name = "liver";
  settings.material = {15e6, 15e6, 20e6, 5e6, 1060, 1, std::numbers::pi * 4e-6, 0.012};
  settings.material.fracture_toughness = 164, settings.material.blade_friction = 2000;
  settings.layers = {{0.005, settings.material}};
  settings.layers[0].material.prestrain = 0.25;
  for (std::size_t i = 0; i < organ.centre.size(); ++i)
    if (organ.centre[i].z < -0.016) settings.anchored.push_back(std::int32_t(i));
  stages.scene = std::make_unique<TestScene>();
  Model& model = stages.scene->model;
  EXPECT_TRUE(network::add_organ(model, organ, settings));
  model.gravity = {0, 0, -9.81}, model.tools = {{"scalpel", ToolKind::scalpel, 0, 0.05}};
  stages.scene->view.model = &model;
  stages.scene->view.looks = {render::look_of("liver")};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  (void)stepper.settle(state, 200);
  const Vec3 from{0.001, -0.055, 0.006}, to{0.001, 0.025, 0.006};
  constexpr int kTicks = 400, kAfter = 250;
  for (int i = 0; i <= kTicks + kAfter; ++i) {
    Inputs inputs;
    if (i <= kTicks) {
      inputs.tool = 0, inputs.position = from + double(i) / kTicks * (to - from);
      inputs.world_from_tool = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // faces along y
    }
    EXPECT_EQ(stepper.step(state, inputs).status, stepping::StepStatus::ok);
    if (i == kTicks * 2 / 5 || i == kTicks * 7 / 10 || i == kTicks || i == kTicks + kAfter)
      stages.states.push_back(state);
  }
  return stages;
}

/// How far the outermost spheres across the cut are apart, at most, beyond their distance at rest [m].
double gape(const Model& model, const State& state) {
  double most = 0;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const auto a = std::size_t(model.axial.a[e]), b = std::size_t(model.axial.b[e]);
    if (state.axial_severed[e] && model.layer[a] == 1 && model.layer[b] == 1)
      most = std::max(
          most, norm(state.position[a] - state.position[b]) - norm(model.rest_position[a] - model.rest_position[b]));
  }
  return most;
}

/// Means of two by two pixels.
render::Frame halved(const render::Frame& frame) {
  render::Frame half = render::blank_frame(frame.width / 2, frame.height / 2, 0, 0, 0);
  const auto at = [&](int x, int y, std::size_t c) { return int(frame.rgb[3 * std::size_t(y * frame.width + x) + c]); };
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        half.rgb[3 * std::size_t(y * half.width + x) + c] =
            std::uint8_t((at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) + at(2 * x, 2 * y + 1, c) +
                          at(2 * x + 1, 2 * y + 1, c) + 2) /
                         4);
  return half;
}

/// The largest difference of the means of squares of 8 pixels, in any channel [0 to 255].
double difference(const render::Frame& a, const render::Frame& b) {
  constexpr int kSquare = 8;
  double most = a.width == b.width && a.height == b.height ? 0 : 255;
  for (int top = 0; most < 255 && top + kSquare <= a.height; top += kSquare)
    for (int left = 0; left + kSquare <= a.width; left += kSquare)
      for (std::size_t c = 0; c < 3; ++c) {
        int sum = 0;
        for (int y = top; y < top + kSquare; ++y)
          for (int x = left; x < left + kSquare; ++x) {
            const std::size_t i = 3 * std::size_t(y * a.width + x) + c;
            sum += a.rgb[i] - b.rgb[i];
          }
        most = std::max(most, std::abs(sum) / double(kSquare * kSquare));
      }
  return most;
}

/// The picture as it would be if the wall were not drawn and the backdrop seen through it.
render::Frame without_wall(const Stages& stages, std::size_t stage, const render::DrawOptions& options,
                           const render::Frame& shown, const render::Frame& backdrop) {
  render::SceneView view = stages.scene->view;
  view.looks[0].inner = {0.1, 0.7, 0.2}, view.looks[0].blood = 0;  // green, which is nowhere else
  auto made = render::Renderer::create(shown.width, shown.height, view);
  EXPECT_TRUE(made);
  const render::Frame green = (*made)->draw(stages.states[stage], options);
  render::Frame picture = shown;
  for (std::size_t i = 0; i < green.rgb.size(); i += 3)
    if (green.rgb[i + 1] > green.rgb[i] + 25 && green.rgb[i + 1] > green.rgb[i + 2] + 25)
      std::copy_n(backdrop.rgb.begin() + std::ptrdiff_t(i), 3, picture.rgb.begin() + std::ptrdiff_t(i));
  return picture;
}

TEST(CutPicture, RenderersOfOneSceneFollowACutTogether) {
  constexpr int kWidth = 320, kHeight = 180;
  const auto scene = make_blob_scene();
  auto first = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(first);
  auto second = render::Renderer::create(kWidth, kHeight, (*first)->scene());
  auto alone = render::Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(second && alone);
  EXPECT_EQ((*first)->scene().cuts, (*second)->scene().cuts);
  render::DrawOptions options;
  options.camera = render::default_camera(scene->view);
  std::uint64_t changes = 0;
  const State rest = rest_state(scene->model), shallow = cut_along_y(scene->model, 0.01, 0, 0),
              deep = cut_along_y(scene->model, 0.01, 0.02, -0.01);
  for (const State* state : {&rest, &shallow, &deep, &rest, &deep}) {
    const render::Frame expected = (*alone)->draw(*state, options);
    EXPECT_EQ((*first)->draw(*state, options).rgb, expected.rgb);
    changes = (*first)->scene().cuts->front().changes();
    EXPECT_EQ((*second)->draw(*state, options).rgb, expected.rgb);
    EXPECT_EQ((*first)->scene().cuts->front().changes(), changes) << "the second one made nothing again";
  }
  EXPECT_EQ(changes, 4u);
}

TEST(CutPicture, FourStagesOfACutFromTwoCameras) {
  const Stages stages = cut_in_stages();
  const Model& model = stages.scene->model;
  ASSERT_EQ(stages.states.size(), 4u);
  EXPECT_GT(gape(model, stages.states[3]), 0.002) << "the lips gape";
  // Those of the last two stages were looked at: copy them to pictures/ only when they were looked at again.
  constexpr double kTolerance = 6;
  const std::filesystem::path folder = CTPM_CUT_STAGES;
  const std::string looked_at = std::string(CTPM_SOURCE_DIR) + "/tests/studio/render/pictures/";
  std::filesystem::create_directories(folder);
  auto made = render::Renderer::create(640, 400, stages.scene->view);
  ASSERT_TRUE(made);
  const std::pair<const char*, Vec3> cameras[] = {{"above", {0.25, 0.6, -1}}, {"along", {-0.1, 1, -0.45}}};
  for (const auto& [name, direction] : cameras) {
    render::DrawOptions options;
    options.camera = render::fit_camera(render::rest_bounds(stages.scene->view), direction, {0, 0, 1});
    options.show_tool = false, options.show_ground = false;
    render::DrawOptions away = options;
    away.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
    const render::Frame backdrop = (*made)->draw(stages.states[0], away);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(holes((*made)->draw(stages.states[i], options), backdrop), 0) << name << ", stage " << i + 1;
      render::DrawOptions shown = options;
      shown.show_tool = shown.show_ground = true;
      const std::string file = "stage_" + std::to_string(i + 1) + "_" + name + ".png";
      const render::Frame picture = (*made)->draw(stages.states[i], shown);
      EXPECT_TRUE(render::write_png((folder / file).string(), halved(picture)));
      if (i < 2) continue;
      const auto reference = render::read_png(looked_at + file);
      EXPECT_TRUE(reference);
      if (!reference) continue;
      EXPECT_LT(difference(halved(picture), *reference), kTolerance) << file;
      EXPECT_GT(difference(halved(without_wall(stages, i, shown, picture, backdrop)), *reference), 2 * kTolerance)
          << file << ": a missing wall would be seen";
    }
  }
}

}  // namespace
}  // namespace ctpm::render_test
