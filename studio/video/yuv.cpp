#include "studio/video/yuv.h"

#include <cstddef>
#include <vector>

#include "core/model/result.h"
#include "studio/render/wide_loop.h"

namespace ctpm::video {
namespace {

// Shares of red and blue in luma, and the narrow range: 219 steps of luma above 16, 224 of chroma around 128.
constexpr double kRed = 0.2126, kBlue = 0.0722, kGreen = 1 - kRed - kBlue, kLuma = 219.0 / 255, kChroma = 112.0 / 255;
constexpr std::uint16_t part(double share) { return std::uint16_t(65536 * share + 0.5); }
constexpr std::uint16_t kRedLuma = part(kRed * kLuma), kGreenLuma = part(kGreen * kLuma),
                        kBlueLuma = part(kBlue * kLuma);
constexpr int kBits = 16;
constexpr int fixed(double share) { return int((1 << kBits) * share + (share < 0 ? -0.5 : 0.5)); }
constexpr int kOwn = fixed(kChroma), kRedBlue = fixed(-kChroma * kRed / (1 - kBlue)), kGreenBlue = -kOwn - kRedBlue;
constexpr int kBlueRed = fixed(-kChroma * kBlue / (1 - kRed)), kGreenRed = -kOwn - kBlueRed;

/// The colours of one row, each in the upper eight bits.
struct Row {
  explicit Row(std::size_t width) : red(width), green(width), blue(width) {}
  std::vector<std::uint16_t> red, green, blue;
};

void split(const std::uint8_t* rgb, int width, Row& row) {
  std::uint16_t *red = row.red.data(), *green = row.green.data(), *blue = row.blue.data();
  render::run_wide([=]() CTPM_WIDE_LOOP {
    for (int x = 0; x < width; ++x) {
      red[x] = std::uint16_t(rgb[3 * x] << 8), green[x] = std::uint16_t(rgb[3 * x + 1] << 8);
      blue[x] = std::uint16_t(rgb[3 * x + 2] << 8);
    }
  });
}

/// In 16 bits, so that the compiler vectorises the loop.
void find_luma(const Row& row, int width, std::uint8_t* to) {
  const std::uint16_t *red = row.red.data(), *green = row.green.data(), *blue = row.blue.data();
  render::run_wide([=]() CTPM_WIDE_LOOP {
    const auto times = [](std::uint16_t colour, std::uint16_t share)
                           CTPM_WIDE_LOOP { return std::uint16_t((std::uint32_t(colour) * share) >> 16); };
    for (int x = 0; x < width; ++x) {
      const std::uint16_t sum =
          std::uint16_t(times(red[x], kRedLuma) + times(green[x], kGreenLuma) + times(blue[x], kBlueLuma));
      to[x] = std::uint8_t(16 + (std::uint16_t(sum + 128) >> 8));
    }
  });
}

/// Of the squares of four pixels in two rows.
void find_chroma(const Row& above, const Row& below, int squares, std::uint8_t* to_blue, std::uint8_t* to_red) {
  const std::uint16_t *red[] = {above.red.data(), below.red.data()},
                      *green[] = {above.green.data(), below.green.data()},
                      *blue[] = {above.blue.data(), below.blue.data()};
  render::run_wide([=]() CTPM_WIDE_LOOP {
    for (int x = 0; x < squares; ++x) {
      const auto mean = [x](const std::uint16_t* const* rows) CTPM_WIDE_LOOP {
        return (rows[0][2 * x] + rows[0][2 * x + 1] + rows[1][2 * x] + rows[1][2 * x + 1]) >> 8;  // four times it
      };
      const int r = mean(red), g = mean(green), b = mean(blue);
      constexpr int kShift = kBits + 2, kMiddle = (128 << kShift) + (1 << (kShift - 1));
      to_blue[x] = std::uint8_t((kRedBlue * r + kGreenBlue * g + kOwn * b + kMiddle) >> kShift);
      to_red[x] = std::uint8_t((kOwn * r + kGreenRed * g + kBlueRed * b + kMiddle) >> kShift);
    }
  });
}

}  // namespace

void to_yuv(const render::Frame& frame, const YuvPlanes& yuv) {
  CTPM_CHECK(frame.width % 2 == 0 && frame.height % 2 == 0, "chroma needs an even size");
  Row above(std::size_t(frame.width)), below(std::size_t(frame.width));
  for (int y = 0; y < frame.height; y += 2) {
    const std::uint8_t* const rgb = frame.rgb.data() + std::size_t(y) * std::size_t(frame.width) * 3;
    split(rgb, frame.width, above), split(rgb + 3 * frame.width, frame.width, below);
    std::uint8_t* const luma = yuv.plane[0] + std::ptrdiff_t(y) * yuv.stride[0];
    find_luma(above, frame.width, luma), find_luma(below, frame.width, luma + yuv.stride[0]);
    find_chroma(above, below, frame.width / 2, yuv.plane[1] + std::ptrdiff_t(y / 2) * yuv.stride[1],
                yuv.plane[2] + std::ptrdiff_t(y / 2) * yuv.stride[2]);
  }
}

}  // namespace ctpm::video
