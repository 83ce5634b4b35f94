#include "studio/film/beside_panels.h"
#include "studio/film/inset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ctpm {
namespace {

class BesidePanels : public ::testing::Test {
 protected:
  static constexpr render::PictureSize kSize{1280, 720};
  const render::Camera camera_{{0, -0.4, 0.1}, {0, 0, 0}, {0, 0, 1}, 32};

  /// Points of a plate across the line of sight [m].
  static std::vector<Vec3> plate(double left, double right) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 40; ++i)
      for (int k = -10; k <= 10; ++k) points.push_back({left + (right - left) * i / 40, 0, 0.003 * k});
    return points;
  }
  static int hidden(const render::Camera& camera, const std::vector<Vec3>& points,
                    const std::vector<render::PixelBox>& panels) {
    int count = 0;
    for (const Vec3& point : points) {
      const render::Pixel p = render::project(camera, kSize.width, kSize.height, point);
      count +=
          p.x < 0 || p.x > kSize.width || std::ranges::any_of(panels, [&](const auto& box) { return box.holds(p); });
    }
    return count;
  }
};

TEST_F(BesidePanels, NothingMovesWhereNothingIsHidden) {
  const std::vector<Vec3> organ = plate(-0.05, 0.05);
  const auto found =
      film::beside_panels(camera_, kSize, std::vector<render::PixelBox>{{20, 20, 200, 680}}, {organ, {}});
  EXPECT_EQ(found.eye, camera_.eye);
  EXPECT_EQ(found.target, camera_.target);
}

TEST_F(BesidePanels, TheOrganComesOutFromBehindAPanelWithoutATurn) {
  const std::vector<Vec3> organ = plate(-0.12, 0.08);
  for (const std::vector<render::PixelBox>& panels :
       {std::vector<render::PixelBox>{{20, 20, 400, 680}}, {{800, 20, 460, 680}}}) {
    const auto found = film::beside_panels(camera_, kSize, panels, {organ, {}});
    EXPECT_GT(hidden(camera_, organ, panels), 100);
    EXPECT_EQ(hidden(found, organ, panels), 0);
    EXPECT_NEAR(norm((found.target - found.eye) - (camera_.target - camera_.eye)), 0, 1e-12);
    EXPECT_NEAR(dot(found.eye - camera_.eye, camera_.up), 0, 1e-12);
    // It goes no further than it must.
    const double moved = norm(found.eye - camera_.eye), share = 0.03 * 1280 * 0.4123 / 720;
    render::Camera nearer = found;
    const Vec3 back = share * (camera_.eye - found.eye) / moved;
    nearer.eye += back, nearer.target += back;
    EXPECT_GT(hidden(nearer, organ, panels), 0);
  }
}

TEST_F(BesidePanels, ItRisesAboveAPanelAlongTheWholeBottom) {
  const std::vector<Vec3> organ = plate(-0.08, 0.08);
  const std::vector<render::PixelBox> panels{{20, 340, 1240, 360}};
  const auto found = film::beside_panels(camera_, kSize, panels, {organ, {}});
  EXPECT_GT(hidden(camera_, organ, panels), 100);
  EXPECT_EQ(hidden(found, organ, panels), 0);
  EXPECT_NEAR(norm((found.target - found.eye) - (camera_.target - camera_.eye)), 0, 1e-12);
}

TEST_F(BesidePanels, ToolsCountToo) {
  const std::vector<Vec3> organ = plate(-0.03, 0.03), tools = plate(-0.12, -0.10);
  const std::vector<render::PixelBox> panels{{20, 20, 300, 680}};
  const auto found = film::beside_panels(camera_, kSize, panels, {organ, tools});
  EXPECT_GT(hidden(camera_, tools, panels), 100);
  EXPECT_EQ(hidden(found, tools, panels), 0);
}

TEST_F(BesidePanels, WhatIsTooLargeToBeFreeIsNotPushedOutOfThePicture) {
  const std::vector<Vec3> organ = plate(-0.3, 0.3);
  const std::vector<render::PixelBox> panels{{20, 20, 300, 300}};
  const auto found = film::beside_panels(camera_, kSize, panels, {organ, {}});
  EXPECT_LE(hidden(found, organ, panels), hidden(camera_, organ, panels));
}

TEST_F(BesidePanels, WhatDoesNotFitBetweenThemIsSeenFromFartherAway) {
  const std::vector<Vec3> organ = plate(-0.14, 0.14);
  const std::vector<render::PixelBox> panels{{0, 0, 300, 720}, {980, 0, 300, 720}};
  const auto found = film::beside_panels(camera_, kSize, panels, {organ, {}});
  EXPECT_GT(hidden(camera_, organ, panels), 100);
  EXPECT_LE(hidden(found, organ, panels), 8) << "1 % is not worth a step";
  const auto distance = [](const render::Camera& c) { return norm(c.eye - c.target); };
  EXPECT_GT(distance(found), distance(camera_));
  EXPECT_LT(distance(found), 1.4 * distance(camera_)) << "it stays large";
}

TEST(Insets, HideNoWordsOfTheOverlay) {
  for (const bool has_legend : {false, true})
    for (const render::PictureSize& size : {render::PictureSize{1280, 720}, {1920, 1080}, {640, 720}, {960, 1080}}) {
      render::OverlayData data;
      data.title = "liver", data.model = "CTPM", data.session = "liver-press-clumsy", data.pace = 1;
      data.hand = {3, 0.018}, data.damage_depth = 0.012, data.verdict = "replay same as recorded";
      data.caption = "tissue damage: deeper than 12 mm", data.history = {{0, 3}};
      data.taken_right = film::Inset::taken_right(size), data.has_insets = true;
      if (has_legend) data.legend = {"layer, red: cut", "1", "4", {{1, 0, 0}, {0, 0, 1}}, true};
      const auto boxes = render::Overlay(size.width, size.height).standing_panels(data);
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k)
          EXPECT_FALSE(boxes[i].overlaps(boxes[k])) << i << " " << k << " " << size.width;
        for (const int place : {0, 1})
          EXPECT_FALSE(film::Inset::box(size, place).overlaps(boxes[i])) << i << " " << size.width;
      }
      for (const render::PlacedText& text : render::Overlay(size.width, size.height).layout(data))
        for (const int place : {0, 1}) {
          EXPECT_FALSE(film::Inset::box(size, place).overlaps(text.box)) << text.text << " " << size.width;
          EXPECT_FALSE(text.text.ends_with("...")) << text.text;
        }
    }
}

}  // namespace
}  // namespace ctpm
