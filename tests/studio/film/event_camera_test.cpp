#include "studio/views/event_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "core/cutting/pieces.h"
#include "recordings/session_reader.h"
#include "scenes/scene_file.h"
#include "studio/film/reel.h"
#include "studio/film/schedule.h"
#include "studio/render/renderer.h"
#include "studio/views/look.h"
#include "studio/views/view_of_scene.h"
#include "tests/studio/commands/run_program.h"
#include "tests/studio/render/scene.h"

namespace ctpm {
namespace {

constexpr double kAspect = 16.0 / 9;

constexpr render::Colour kGrey{0.25, 0.25, 0.25}, kGreen{0, 0.9, 0};

int green_pixels(const render::SceneView& scene, const State& state, const render::DrawOptions& options) {
  auto renderer = render::Renderer::create(640, 360, scene);
  EXPECT_TRUE(renderer);
  const render::Frame frame = (*renderer)->draw(state, options);
  int count = 0;
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
    count += frame.rgb[i + 1] > frame.rgb[i] + 25 && frame.rgb[i + 1] > frame.rgb[i + 2] + 25;
  return count;
}

/// The expert's cut, and what shows it: the wound in green, the organ in grey.
class WoundCamera : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened =
        recordings::SessionReader::open(std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/kidney-cut-expert.ctpm");
    ASSERT_TRUE(opened);
    reader_ = std::make_unique<recordings::SessionReader>(*std::move(opened));
    auto text = scenes::read_scene(reader_->start().scene_text, "scene");
    ASSERT_TRUE(text);
    scene_ = text->spec;
    view_ = views::view_of(scene_, reader_->start().model);
    auto late = reader_->keyframe_at_or_before(reader_->tick_count());
    ASSERT_TRUE(late);
    cut_ = late->state;
  }

  int green(const render::Camera& camera) {
    render::DrawOptions options;
    options.camera = camera, options.show_tool = false;
    return green_pixels({view_.model, {{"organ", kGrey, kGreen, 0, {}}}, {}}, cut_, options);
  }
  views::Look look(const std::string& camera, const State* cut) {
    views::LookRequest request;
    request.camera = camera;
    auto found = views::find_look(request, scene_, view_, kAspect, cut);
    EXPECT_TRUE(found) << camera;
    return *found;
  }

  std::unique_ptr<recordings::SessionReader> reader_;
  scenes::SceneSpec scene_;
  render::SceneView view_;
  State cut_;
};

TEST_F(WoundCamera, ShowsMoreOfTheCutThanTheScenesCameras) {
  const views::Look chosen = look("", &cut_);
  EXPECT_EQ(chosen.camera, "wound");
  for (const char* name : {"front", "side"})
    EXPECT_GT(green(chosen.draw.camera), 2 * green(look(name, &cut_).draw.camera)) << name;
  EXPECT_GT(green(chosen.draw.camera), green(look("cut", &cut_).draw.camera));
  EXPECT_GT(green(look("follow", &cut_).draw.camera), 2 * green(look("front", &cut_).draw.camera)) << "its base";
}

TEST_F(WoundCamera, TheWoundAndTheOrgansMiddleAreInThePicture) {
  const render::Camera camera = look("wound", &cut_).draw.camera;
  for (std::size_t row = 0; row < cut_.swept.size(); row += 7) {
    const render::Pixel at = render::project(camera, 1280, 720, cut_.swept[row]);
    if (cut_.swept[row].z > 0.05) continue;  // above the organ
    EXPECT_TRUE(at.x > 200 && at.x < 1080 && at.y > 100 && at.y < 620) << at.x << ", " << at.y;
  }
}

TEST_F(WoundCamera, APieceThatFliesAwayDoesNotMakeTheRestSmall) {
  const auto distance = [&](const State& state) {
    const render::Camera camera = look("wound", &state).draw.camera;
    return norm(camera.eye - camera.target);
  };
  const Model& model = reader_->start().model;
  State flown = cut_;
  const auto severed = std::find(cut_.axial_severed.begin(), cut_.axial_severed.end(), 1);
  ASSERT_NE(severed, cut_.axial_severed.end());
  const auto sphere = std::size_t(model.axial.a[std::size_t(severed - cut_.axial_severed.begin())]);
  flown.position.set(sphere, flown.position[sphere] - Vec3{2, 0, 0});
  EXPECT_LT(distance(flown), 2 * distance(cut_));
}

TEST_F(WoundCamera, APlaceAndWhatItLooksAtAreACamera) {
  const render::Camera camera = look("10,-300,200:0,0.5,20", &cut_).draw.camera;
  EXPECT_LT(norm(camera.eye - Vec3{0.01, -0.3, 0.2}) + norm(camera.target - Vec3{0, 0.0005, 0.02}), 1e-12);
  EXPECT_EQ(camera.up, render::up_of(*view_.model));
  EXPECT_EQ(look("10,-300,200:0,0,20:1,0,0.5", nullptr).draw.camera.up, (Vec3{1, 0, 0.5}));
  // A field of view stands at the end; without one it is the usual one.
  EXPECT_EQ(camera.fov_deg, render::Camera{}.fov_deg);
  EXPECT_EQ(look("10,-300,200:0,0,20:24.5", nullptr).draw.camera.fov_deg, 24.5);
  EXPECT_EQ(look("10,-300,200:0,0,20:24.5", nullptr).draw.camera.up, camera.up);
  EXPECT_EQ(look("10,-300,200:0,0,20:1,0,0.5:60", nullptr).draw.camera.fov_deg, 60);
  EXPECT_EQ(look("10,-300,200:0,0,20:1,0,0.5:60", nullptr).draw.camera.up, (Vec3{1, 0, 0.5}));
  // Straight from above it sees something too.
  const render::Camera above = look("0,0,400:0,0,20", nullptr).draw.camera;
  EXPECT_GT(norm(cross(above.up, above.target - above.eye)), 0.1);
  // A narrow picture keeps the sides: what is at a side's edge of the wide one stays at the edge.
  views::LookRequest request;
  request.camera = "0,-300,20:0,0,20";
  const auto wide = views::find_look(request, scene_, view_, kAspect);
  const auto narrow = views::find_look(request, scene_, view_, 0.5);
  ASSERT_TRUE(wide && narrow);
  const Vec3 aside{0.1, 0, 0.02};
  EXPECT_NEAR(render::project(wide->draw.camera, 1600, 900, aside).x / 1600,
              render::project(narrow->draw.camera, 450, 900, aside).x / 450, 1e-9);
  for (const auto& [wrong, why] : {std::pair{"0,0:0,0,20", "the eye '0,0' has 2 numbers instead of 3"},
                                   {"1,2:3", "the eye '1,2' has 2 numbers instead of 3"},
                                   {"0,0,0:0,0,0", "the eye is at what it looks at"},
                                   {"1,2,3:4,5", "what it looks at '4,5' has 2 numbers"},
                                   {"1,2,3", "what it looks at is missing"},
                                   {"1,2,3:4,5,6:", "the upward direction '' has 1 number instead of 3"},
                                   {"1,2,x:4,5,6", "has 'x', no number"},
                                   {"1,2,inf:4,5,6", "has 'inf', no number"},
                                   {"1,2,:4,5,6", "has '', no number"},
                                   {"1,2,3:4,5,6:0,0,0", "the upward direction is 0"},
                                   {"1,2,3:4,5,6:7,8,9:1,2,3", "4 places"},
                                   {"1,2,3:4,5,6:7,8,9:1,2,3:40", "4 places"},
                                   {"1,2,3:4,5,6:0", "field of view '0' must be 1 to 170"},
                                   {"1,2,3:4,5,6:7,8,9:180", "field of view '180' must be"},
                                   {"1,2,3:4,5,6:wide", "field of view 'wide' must be"},
                                   {"1,2,3:40", "what it looks at '40' has 1 number"}}) {
    request.camera = wrong;
    const auto found = views::find_look(request, scene_, view_, kAspect);
    ASSERT_FALSE(found) << wrong;
    EXPECT_NE(found.errors()[0].message.find(why), std::string::npos) << found.errors()[0].message;
    EXPECT_NE(found.errors()[0].hint.find("0,-300,200:0,0,20"), std::string::npos) << found.errors()[0].hint;
  }
  request.camera = "behind";
  const auto unknown = views::find_look(request, scene_, view_, kAspect);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.errors()[0].message.find("no camera 'behind'"), std::string::npos) << "a name is taken for a name";
}

TEST_F(WoundCamera, ASectionIsSeenFromItsFront) {
  for (const char* cutaway : {"x", "y=2", "z=30"}) {
    views::LookRequest request;
    request.cutaway = cutaway;
    const auto found = views::find_look(request, scene_, view_, kAspect, &cut_);
    ASSERT_TRUE(found) << cutaway;
    const render::Camera& camera = found->draw.camera;
    EXPECT_GT(dot(camera.eye - camera.target, found->draw.cutaway.normal), 0.8 * norm(camera.eye - camera.target))
        << cutaway;
    request.camera = "front";
    EXPECT_EQ(views::find_look(request, scene_, view_, kAspect, &cut_)->camera, "front") << "unless one is named";
  }
}

TEST_F(WoundCamera, IsTheSameEveryTimeAndTheScenesWhereNothingIsCut) {
  const render::Camera one = look("", &cut_).draw.camera, other = look("", &cut_).draw.camera;
  EXPECT_EQ(one.eye, other.eye);
  EXPECT_EQ(one.target, other.target);
  const State whole = rest_state(reader_->start().model);
  EXPECT_EQ(look("", &whole).camera, "front");
  EXPECT_EQ(look("", nullptr).camera, "front");
  views::LookRequest request;
  request.camera = "wound";
  const auto none = views::find_look(request, scene_, view_, kAspect, &whole);
  ASSERT_FALSE(none);
  EXPECT_NE(to_string(none.errors()[0]).find("nothing is cut"), std::string::npos);
}

/// The line of sight of the camera on a ball that presses the first organ from above.
Vec3 sight_of_press(const Model& model) {
  State state = rest_state(model);
  state.last_inputs.tool = 0, state.last_inputs.position = {0, 0, 0.03};
  const render::SceneView view{&model, {}, {}};
  const auto camera =
      views::event_camera(views::Event::press, view, state, render::default_camera(view, kAspect), kAspect);
  EXPECT_TRUE(camera && *camera);
  const Vec3 sight = (*camera)->camera.target - (*camera)->camera.eye;
  return sight / norm(sight);
}

TEST(EventCamera, AnOrganAsideDoesNotTurnIt) {
  const FilledOrgan blob =
      render_test::fill(render_test::blob, render_test::star_surface(render_test::blob, 40), 0.004);
  const auto alone = render_test::make_scene(blob), pair = render_test::make_scene(blob);
  FilledOrgan aside = blob;
  const Vec3 away{0.3, 0, 0};
  for (auto* points : {&aside.centre, &aside.surface.vertex})
    for (Vec3& p : *points) p = p + away;
  network::OrganSettings settings;
  settings.name = "other", settings.material = {15e6, 15e6, 20e6, 5e6, 1060, 1, std::numbers::pi * 4e-6, 0.012};
  ASSERT_TRUE(network::add_organ(pair->model, aside, settings));
  constexpr double kAStep = 0.9;  // cosine of somewhat less than the 30 degrees between directions
  EXPECT_GT(dot(sight_of_press(alone->model), sight_of_press(pair->model)), kAStep);
}

TEST(WoundOfAFilm, APieceThatFellBesideItsOrganIsInThePictureUntilTheEnd) {
  const testing::TemporaryFolder folder;
  const std::string scenes = std::string(CTPM_SOURCE_DIR) + "/scenes/";
  const auto recorded = testing::run_ctpm({"record", scenes + "kidney-knife.json", "--script",
                                           scenes + "scripts/kidney-knife-cap.json", "-o", "cap.ctpm", "--fast"},
                                          folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  auto reader = recordings::SessionReader::open((folder.path() / "cap.ctpm").string());
  ASSERT_TRUE(reader);
  auto ticks = film::schedule({&*reader}, {.range = {}, .frame_s = 0.1, .matched = {}, .slow = {}});
  ASSERT_TRUE(ticks);
  const render::PictureSize size{640, 480};  // narrow, with panels that take much of it
  const auto reel = film::make_reel(*reader, ticks->front(), size, {});
  ASSERT_TRUE(reel);
  EXPECT_EQ(reel->look.camera, "wound");
  const auto end = reader->keyframe_at_or_before(reader->tick_count());
  ASSERT_TRUE(end);
  cutting::Pieces pieces(reader->start().model);
  EXPECT_EQ(pieces.find(end->state), 2);
  int in = 0, points = 0;
  for (std::size_t i = 0; i < end->state.position.size(); ++i) {
    if (pieces.piece()[i] == pieces.piece()[0]) continue;  // the first sphere is at the bottom
    EXPECT_LT(end->state.position[i].z, 0.025) << "on the table";
    const render::Pixel at = render::project(reel->look.draw.camera, size.width, size.height, end->state.position[i]);
    ++points, in += at.x > 0 && at.x < size.width && at.y > 0 && at.y < size.height;
  }
  EXPECT_GT(points, 30);
  EXPECT_GT(in, 0.85 * points);
}

/// Pixels that show the pressed place, of which the spheres are green.
int pixels_of(const Model& model, const State& state, Vec3 at, const render::Camera& camera) {
  render::SceneView plain{&model, {}, std::vector<render::Colour>(state.position.size(), kGrey)};
  for (std::size_t i = 0; i < state.position.size(); ++i)
    if (norm(state.position[i] - at) < 0.012) plain.sphere_colours[i] = kGreen;
  render::DrawOptions options;
  options.camera = camera, options.view = render::View::spheres;
  return green_pixels(plain, state, options);
}

/// What a camera on an event is found from in a shipped session.
struct Told {
  recordings::SessionReader reader;
  State state;
  scenes::SceneText text;
  render::SceneView view;
};
std::unique_ptr<Told> told_of(const std::string& name) {
  auto reader = recordings::SessionReader::open(std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/" + name + ".ctpm");
  if (!reader) return nullptr;
  const session::TickRange whole{0, reader->tick_count()};
  const auto all = film::all_moments(*reader, whole);
  if (!all) return nullptr;
  auto told = film::telling_state(*reader, whole, *all);
  auto text = scenes::read_scene(reader->start().scene_text, "scene");
  if (!told || !text) return nullptr;
  auto result = std::make_unique<Told>(Told{std::move(*reader), std::move(*told), std::move(*text), {}});
  result->view = views::view_of(result->text.spec, result->reader.start().model);
  return result;
}

TEST(PressCamera, SeesThePressedTissueOfEachSession) {
  for (const char* name : {"liver-press-expert", "liver-press-clumsy"}) {
    const auto shipped = told_of(name);
    ASSERT_NE(shipped, nullptr) << name;
    const auto& [reader, told, text, view] = *shipped;
    views::LookRequest request;
    const auto chosen = views::find_look(request, text.spec, view, kAspect, &told);
    request.camera = "front";
    const auto front = views::find_look(request, text.spec, view, kAspect, &told);
    ASSERT_TRUE(chosen && front);
    EXPECT_EQ(chosen->camera, "press") << name;
    const auto seen = [&](const views::Look& look) {
      return pixels_of(reader.start().model, told, told.last_inputs.position, look.draw.camera);
    };
    EXPECT_GT(2 * seen(*chosen), 3 * seen(*front)) << name;
    const render::Pixel at = render::project(chosen->draw.camera, 1280, 720, told.last_inputs.position);
    EXPECT_TRUE(at.x > 400 && at.x < 880 && at.y > 150 && at.y < 570) << at.x << ", " << at.y;
  }
}

TEST(EventCamera, TheWholeOrganIsInThePictureOfEachSession) {
  for (const char* name : {"liver-press-expert", "liver-press-clumsy", "kidney-cut-expert", "kidney-cut-clumsy"}) {
    const auto shipped = told_of(name);
    ASSERT_NE(shipped, nullptr) << name;
    const auto& [reader, told, text, view] = *shipped;
    const auto chosen = views::find_look({}, text.spec, view, kAspect, &told);
    ASSERT_TRUE(chosen);
    int in = 0, points = 0;
    for (const Vec3& point : render::rest_points(view)) {
      const render::Pixel at = render::project(chosen->draw.camera, 1280, 720, point);
      ++points, in += at.x > 0 && at.x < 1280 && at.y > 0 && at.y < 720;
    }
    EXPECT_GT(in, 0.98 * points) << name;
  }
}

TEST_F(WoundCamera, ASessionThatIsCutTellsOfItsPressToo) {
  const session::TickRange whole{0, reader_->tick_count()};
  const std::int64_t pressed = 700;
  const auto told = film::telling_state(*reader_, whole, {{pressed, "deepest press", film::Moment::Kind::deepest}});
  ASSERT_TRUE(told);
  EXPECT_EQ(told->swept.size(), cut_.swept.size());
  const auto records = reader_->ticks(pressed, pressed + 1);
  ASSERT_TRUE(records);
  EXPECT_EQ(told->last_inputs, records->front().inputs);
}

TEST_F(WoundCamera, IsTheOneOfASessionThatIsCutAndPressed) {
  State pressed = cut_;
  const auto& tools = reader_->start().model.tools;
  const auto ball = std::find_if(tools.begin(), tools.end(), [](const Tool& t) { return t.kind == ToolKind::ball; });
  views::LookRequest request;
  request.camera = "press";
  const auto none = views::find_look(request, scene_, view_, kAspect, &cut_);
  ASSERT_FALSE(none) << "a blade does not press";
  EXPECT_NE(to_string(none.errors()[0]).find("nothing is pressed"), std::string::npos);
  if (ball == tools.end()) GTEST_SKIP() << "the kidney has no ball";
  pressed.last_inputs.tool = std::int32_t(ball - tools.begin()), pressed.last_inputs.position = cut_.position[0];
  EXPECT_EQ(look("", &pressed).camera, "wound");
  EXPECT_EQ(look("press", &pressed).camera, "press");
}

}  // namespace
}  // namespace ctpm
