// The halves of --beside are compared by eye, so their axes of force must be one.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "studio/render/frame.h"
#include "tests/studio/commands/run_program.h"
#include "tests/studio/render/glyph_reader.h"

namespace ctpm {
namespace {

using testing::run_ctpm;

constexpr int kWidth = 640, kHeight = 720;  // of a half

/// Where the axis of a half's plot has its upper and its lower label [pixels].
struct Axis {
  double top = 0, bottom = 0;
};

Axis axis_of_half() {
  render::OverlayData data;
  data.history.push_back({0, 0}), data.least_top_force = 2;
  Axis axis;
  for (const render::PlacedText& text : render::Overlay(kWidth, kHeight).layout(data)) {
    const double middle = text.box.y + 0.4 * text.box.height;  // boxes hold a quarter below the line as well
    if (text.text == "0") axis.bottom = middle;
    if (text.text == "2") axis.top = middle;
  }
  return axis;
}

/// The height at which a half's curve ends in a bright point [pixels]; 0: there is none.
double end_of_curve(const render::Frame& whole, int half, const Axis& axis) {
  double sum = 0;
  int count = 0;
  for (int y = int(axis.top) - 12; y < int(axis.bottom) + 12; ++y)
    for (int x = half * kWidth; x < half * kWidth + kWidth / 2; ++x) {
      const std::uint8_t* p = &whole.rgb[std::size_t(y * whole.width + x) * 3];
      if (p[0] > 245 && p[1] > 215 && p[1] < 235 && p[2] > 145 && p[2] < 175) sum += y, ++count;
    }
  return count >= 12 ? sum / count : 0;
}

render::Frame half_of(const render::Frame& whole, int half) {
  render::Frame part = render::blank_frame(kWidth, whole.height, 0, 0, 0);
  for (int y = 0; y < whole.height; ++y)
    std::copy_n(whole.rgb.begin() + 3 * (y * whole.width + kWidth * half), 3 * kWidth,
                part.rgb.begin() + 3 * y * kWidth);
  return part;
}

/// The clumsy hand presses several times as hard; an axis of its own would hide that.
TEST(BesideAxes, BothHalvesShowForcesOnOneScale) {
  const testing::TemporaryFolder folder;
  const std::string shipped = std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/kidney-cut-";
  const auto both = run_ctpm({"export", shipped + "expert.ctpm", "--beside", shipped + "clumsy.ctpm", "-o", "both/",
                              "--fps", "2", "--from-s", "1", "--to-s", "4"},
                             folder.path());
  ASSERT_EQ(both.code, 0) << both.err;
  const render_test::GlyphReader reader(kWidth, kHeight);
  const Axis axis = axis_of_half();
  ASSERT_GT(axis.bottom, axis.top + 40);
  ASSERT_GT(axis.top, 0);
  std::array<std::vector<double>, 2>
      tops;  // of each half's axis, from a force in words and the height of its point [N]
  for (int frame = 1; std::filesystem::exists(folder.path() / "both" / ("00000" + std::to_string(frame) + ".png"));
       ++frame) {
    const auto picture =
        render::read_png((folder.path() / "both" / ("00000" + std::to_string(frame) + ".png")).string());
    ASSERT_TRUE(picture);
    for (int half = 0; half < 2; ++half) {
      const double force = std::atof(reader.read_after(half_of(*picture, half), "force").c_str());
      const double end = end_of_curve(*picture, half, axis), share = (axis.bottom - end) / (axis.bottom - axis.top);
      if (end > 0 && share > 0.1) tops[std::size_t(half)].push_back(force / share);
    }
  }
  const auto median = [](std::vector<double>& of) {
    std::sort(of.begin(), of.end());
    return of.empty() ? 0 : of[of.size() / 2];
  };
  ASSERT_GE(tops[0].size(), 3u);
  ASSERT_GE(tops[1].size(), 3u);
  const double expert = median(tops[0]), clumsy = median(tops[1]);
  EXPECT_NEAR(expert, clumsy, 0.1 * clumsy) << "the tops of both axes [N]";
}

}  // namespace
}  // namespace ctpm
