#include "studio/render/expert_cut.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/contact/drawn_surfaces.h"
#include "core/cutting/blade_geometry.h"
#include "studio/render/cut_surface.h"
#include "tests/studio/render/scene.h"

namespace ctpm::render_test {
namespace {

constexpr double kEnd = 0.02, kBottom = 0.005;  // of the expert's cut along y and down in z [m]

/// The blob as it is drawn in a State, and the marks on it.
struct Drawn {
  render::CutSurface cut;
  contact::DrawnSurfaces places;
  std::vector<Vec3> vertex;
  render::ExpertMarks marks;

  Drawn(const Model& model, const State& state, render::ExpertMarker& marker,
        const std::shared_ptr<const render::ExpertCut>& expert, std::uint64_t version)
      : cut(model, 0), places(model) {
    cut.update(state);
    places.place(0, cut.surface(), state, vertex);
    const render::DrawnOrgan organ{&cut.surface(), cut.outer_triangle_count(), &vertex};
    marks = marker.place(model, expert, {&organ, 1}, version, state);
  }

  /// How far a place is from the outside [m].
  double off(Vec3 place) const {
    double least = 1;
    for (std::size_t t = 0; t < cut.outer_triangle_count(); ++t) {
      const auto& c = cut.surface().triangle[t];
      least = std::min(
          least, norm(place - cutting::nearest_in_triangle(place, vertex[std::size_t(c[0])], vertex[std::size_t(c[1])],
                                                           vertex[std::size_t(c[2])])));
    }
    return least;
  }
  double length() const {
    double sum = 0;
    for (const auto& [from, to] : marks.line) sum += norm(to - from);
    return sum;
  }
};

class ExpertCut : public ::testing::Test {
 protected:
  std::unique_ptr<TestScene> scene_ = make_blob_scene();
  const Model& model_ = scene_->model;
  std::shared_ptr<const render::ExpertCut> expert_ =
      std::make_shared<const render::ExpertCut>(model_, cut_along_y(model_, 0, kEnd, kBottom));
  render::ExpertMarker marker_;
};

/// The length of the way over the blob in the plane x = 0, above the cut's bottom up to its end.
double way_over_blob() {
  double length = 0;
  Vec3 last;
  constexpr int kParts = 4000;
  for (int i = 0; i <= kParts; ++i) {
    const double angle = std::numbers::pi * i / kParts;
    double low = 0, high = 0.2;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (low + high);
      (blob({0, -middle * std::cos(angle), middle * std::sin(angle)}) < 0 ? low : high) = middle;
    }
    const Vec3 place{0, -low * std::cos(angle), low * std::sin(angle)};
    if (i > 0 && last.y < kEnd && last.z > kBottom) length += norm(place - last);
    last = place;
  }
  return length;
}

TEST_F(ExpertCut, ItsLineIsWhereTheBladeWentThroughTheSkin) {
  const Drawn whole(model_, rest_state(model_), marker_, expert_, 1);
  ASSERT_GT(whole.marks.line.size(), 20u);
  EXPECT_TRUE(whole.marks.strays.empty());
  for (const auto& part : whole.marks.line)
    for (const Vec3 end : part) {
      EXPECT_NEAR(end.x, 0, 0.35e-3);
      EXPECT_LT(whole.off(end), 1e-6);
      EXPECT_TRUE(end.y < kEnd + 0.2e-3 && end.z > kBottom - 0.5e-3);
    }
  EXPECT_NEAR(whole.length(), way_over_blob(), 0.03 * way_over_blob()) << "without a gap, and once";
  // Nothing of it in the middle of the tissue, where the blade went too: an expert who cut nothing has none.
  EXPECT_TRUE(render::ExpertCut(model_, rest_state(model_)).line().empty());
}

TEST_F(ExpertCut, ItGoesWithTheTissueAsThatIsDrawn) {
  State moved = cut_along_y(model_, 0.004, 0, 0);  // a trainee's cut beside it, which gapes
  spread(moved, model_, [](Vec3 p) { return Vec3{p.x > 0.004 ? 0.006 : 0.0, 0.002, 0.01 * p.y}; });
  const Drawn drawn(model_, moved, marker_, expert_, 2);
  const Drawn whole(model_, rest_state(model_), marker_, expert_, 3);
  EXPECT_GT(drawn.length(), 0.9 * whole.length());
  for (const auto& part : drawn.marks.line)
    for (const Vec3 end : part) EXPECT_LT(drawn.off(end), 1e-6) << end.x << ", " << end.y << ", " << end.z;
  // The line of a cut that the trainee made too lies whole on one of its lips, and spans no wound.
  State same = cut_along_y(model_, 0, kEnd, kBottom);
  spread(same, model_, [](Vec3 p) { return Vec3{p.x > 0 ? 0.008 : 0.0, 0, 0}; });
  const Drawn on_lip(model_, same, marker_, expert_, 4);
  EXPECT_GT(on_lip.length(), 0.85 * whole.length());
  const auto side_of = [](const auto& part) { return part[0].x > 0.004; };
  const auto on_far_side = std::ranges::count_if(on_lip.marks.line, side_of);
  EXPECT_TRUE(on_far_side == 0 || std::size_t(on_far_side) == on_lip.marks.line.size()) << on_far_side;
}

TEST_F(ExpertCut, WhatIsCutElsewhereIsMarkedWhereTheBladeCrossedIt) {
  EXPECT_TRUE(render::strays_of(model_, *expert_, cut_along_y(model_, 0, kEnd, kBottom)).empty());
  EXPECT_TRUE(render::strays_of(model_, *expert_, cut_along_y(model_, 0, -0.01, 0.01)).empty())
      << "less is not elsewhere";
  State beside = cut_along_y(model_, 0.02, kEnd, kBottom);
  const std::vector<Vec3> strays = render::strays_of(model_, *expert_, beside);
  EXPECT_EQ(strays.size(), std::size_t(std::ranges::count(beside.axial_severed, 1)));
  ASSERT_GT(strays.size(), 10u);
  for (const Vec3 stray : strays) EXPECT_NEAR(stray.x, 0.02, 0.1e-3);
  // They go with the tissue.
  spread(beside, model_, [](Vec3) { return Vec3{0.01, 0, 0}; });
  for (const Vec3 stray : render::strays_of(model_, *expert_, beside)) EXPECT_NEAR(stray.x, 0.03, 0.1e-3);
}

/// Pixels that are of a mark's colour.
int count_of(const render::Frame& frame, const render::Colour& colour, int within) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < frame.rgb.size(); i += 3) {
    int off = 0;
    for (std::size_t c = 0; c < 3; ++c) off = std::max(off, std::abs(int(frame.rgb[i + c]) - int(255 * colour[c])));
    count += off < within;
  }
  return count;
}

int bluish(const render::Frame& frame, const render::Frame& without) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < frame.rgb.size(); i += 3)
    count += frame.rgb[i + 2] > frame.rgb[i] + 20 && frame.rgb[i + 2] > without.rgb[i + 2] + 20;
  return count;
}

TEST_F(ExpertCut, APictureShowsTheLineWhereTheOrganDoesNotHideItAndAllStrays) {
  auto renderer = render::Renderer::create(320, 240, scene_->view);
  ASSERT_TRUE(renderer);
  render::DrawOptions above, below;
  above.camera.eye = {0, -0.05, 0.35}, below.camera.eye = {0, -0.05, -0.35};
  for (render::DrawOptions* options : {&above, &below}) options->camera.up = {0, 1, 0};
  const State beside = cut_along_y(model_, 0.02, kEnd, kBottom), same = cut_along_y(model_, 0, kEnd, kBottom);
  const auto draw = [&](const State& state, render::DrawOptions options, bool has_marks) {
    if (has_marks) options.expert = expert_;
    return (*renderer)->draw(state, options);
  };
  EXPECT_GT(bluish(draw(beside, above, true), draw(beside, above, false)), 60);
  EXPECT_EQ(bluish(draw(beside, below, true), draw(beside, below, false)), 0) << "the organ hides it";
  const auto strays = [&](const State& state, const render::DrawOptions& options) {
    return count_of(draw(state, options, true), render::kStrayColour, 8) -
           count_of(draw(state, options, false), render::kStrayColour, 8);
  };
  EXPECT_GT(strays(beside, above), 30);
  EXPECT_GT(strays(beside, below), 30) << "they lie in the tissue";
  EXPECT_EQ(strays(same, above), 0);
  // What a cutaway hides has no marks.
  render::DrawOptions opened = above;
  opened.cutaway = {{-0.01, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(bluish(draw(beside, opened, true), draw(beside, opened, false)) + strays(beside, opened), 0);
}

}  // namespace
}  // namespace ctpm::render_test
