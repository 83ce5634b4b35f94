#include "studio/render/backdrop.h"

#include <algorithm>
#include <cmath>

namespace ctpm::render {
namespace {

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

Frame make_backdrop(int width, int height) {
  constexpr double kNear[] = {0.70, 0.75, 0.79}, kFar[] = {0.23, 0.28, 0.335};
  Frame frame = blank_frame(width, height, 0, 0, 0);
  std::size_t at = 0;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double x = (column + 0.5) / width, y = 1 - (row + 0.5) / height;
      const double away = smooth_step(0.05, 0.85, std::hypot(x - 0.5, 0.8 * (y - 0.56)));
      const double lift = 0.86 + 0.18 * smooth_step(0, 1, y);
      const double wave = 52.9829189 * std::fmod(0.06711056 * column + 0.00583715 * row, 1.0);
      const double dither = wave - std::floor(wave) - 0.5;
      for (std::size_t c = 0; c < 3; ++c)
        frame.rgb[at++] = std::uint8_t(
            std::lround(std::clamp(255 * lift * (kNear[c] + away * (kFar[c] - kNear[c])) + dither, 0.0, 255.0)));
    }
  return frame;
}

}  // namespace ctpm::render
