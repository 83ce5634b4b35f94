#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "studio/video/yuv.h"

namespace ctpm {
namespace {

struct Planes {
  explicit Planes(const render::Frame& frame) : width(frame.width), height(frame.height) {
    luma.resize(std::size_t(width * height)), blue.resize(luma.size() / 4), red.resize(luma.size() / 4);
    video::to_yuv(frame, {{luma.data(), blue.data(), red.data()}, {width, width / 2, width / 2}});
  }
  int width, height;
  std::vector<std::uint8_t> luma, blue, red;
};

/// By the definition of BT.709, narrow range.
struct Yuv {
  double luma, blue, red;
};
Yuv defined(double r, double g, double b) {
  const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  return {16 + 219 * y / 255, 128 + 224 * (b - y) / 1.8556 / 255, 128 + 224 * (r - y) / 1.5748 / 255};
}

TEST(Yuv, EveryPixelIsThatOfItsDefinition) {
  constexpr int kWidth = 46, kHeight = 22;  // no multiple of what a processor takes at a time
  render::Frame frame = render::blank_frame(kWidth, kHeight, 0, 0, 0);
  std::uint32_t random = 1;
  for (std::uint8_t& part : frame.rgb) random = random * 1664525u + 1013904223u, part = std::uint8_t(random >> 24);
  frame.rgb[0] = frame.rgb[1] = frame.rgb[2] = 255;  // the ends of the range
  frame.rgb[3] = frame.rgb[4] = frame.rgb[5] = 0;
  const Planes planes(frame);
  const auto at = [&](int x, int y, int c) {
    return double(frame.rgb[std::size_t(y * kWidth + x) * 3 + std::size_t(c)]);
  };
  EXPECT_EQ(int(planes.luma[0]), 235);
  EXPECT_EQ(int(planes.luma[1]), 16);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      EXPECT_NEAR(planes.luma[std::size_t(y * kWidth + x)], defined(at(x, y, 0), at(x, y, 1), at(x, y, 2)).luma, 0.52);
  for (int y = 0; y < kHeight / 2; ++y)
    for (int x = 0; x < kWidth / 2; ++x) {
      const auto mean = [&](int c) {
        return (at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) + at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c)) /
               4;
      };
      const Yuv wanted = defined(mean(0), mean(1), mean(2));
      EXPECT_NEAR(planes.blue[std::size_t(y * kWidth / 2 + x)], wanted.blue, 0.52);
      EXPECT_NEAR(planes.red[std::size_t(y * kWidth / 2 + x)], wanted.red, 0.52);
    }
}

TEST(Yuv, GreyHasNoHue) {
  for (const int grey : {0, 1, 127, 128, 254, 255}) {
    const auto part = std::uint8_t(grey);
    const Planes planes(render::blank_frame(16, 2, part, part, part));
    for (const std::uint8_t hue : planes.blue) EXPECT_EQ(hue, 128) << grey;
    for (const std::uint8_t hue : planes.red) EXPECT_EQ(hue, 128) << grey;
  }
}

}  // namespace
}  // namespace ctpm
