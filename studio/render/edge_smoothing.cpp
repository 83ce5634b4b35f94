#include "studio/render/edge_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ctpm {
namespace {

constexpr int kBackdropLuma = 160;  // what shows where nothing was drawn, in [0, 255]
constexpr int kLeastContrast = 26;  // below it a step is no edge
constexpr float kReach = 8;         // longest way along an edge [pixels]

int luma_of(const std::uint8_t* p) {
  return (77 * p[0] + 150 * p[1] + 29 * p[2] + kBackdropLuma * (255 - p[3])) >> 8;
}

/// Colour between the pixels.
std::array<float, 4> between(const std::uint8_t* rgba, int width, int height, float x, float y) {
  x = std::clamp(x, 0.0f, float(width - 1)), y = std::clamp(y, 0.0f, float(height - 1));
  const int c = std::min(int(x), width - 2), r = std::min(int(y), height - 2);
  const float s = x - float(c), t = y - float(r);
  const std::uint8_t* a = rgba + (std::ptrdiff_t(r) * width + c) * 4;
  const std::uint8_t* b = a + std::ptrdiff_t(width) * 4;
  std::array<float, 4> mixed;
  for (std::size_t k = 0; k < 4; ++k)
    mixed[k] = (1 - t) * ((1 - s) * a[k] + s * a[k + 4]) + t * ((1 - s) * b[k] + s * b[k + 4]);
  return mixed;
}

}  // namespace

void smooth_edges(std::vector<std::uint8_t>& rgba, int width, int height,
                  std::vector<std::uint8_t>& scratch) {
  if (width < 3 || height < 3) return;
  const std::size_t count = std::size_t(width) * std::size_t(height);
  // One plane of brightness, then the untouched picture to read from.
  scratch.resize(count * 5);
  std::uint8_t* luma = scratch.data();
  std::uint8_t* from = scratch.data() + count;
  std::copy(rgba.begin(), rgba.begin() + std::ptrdiff_t(count * 4), from);
  for (std::size_t i = 0; i < count; ++i) luma[i] = std::uint8_t(luma_of(from + 4 * i));
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const std::uint8_t* m = luma + std::ptrdiff_t(y) * width + x;
      const int nw = m[-width - 1], ne = m[-width + 1], sw = m[width - 1], se = m[width + 1];
      const int low = std::min({int(*m), nw, ne, sw, se}), high = std::max({int(*m), nw, ne, sw, se});
      if (high - low < kLeastContrast) continue;
      // Along the edge is across the steepest change.
      float dx = float(-(nw + ne) + (sw + se)), dy = float((nw + sw) - (ne + se));
      const float scale =
          1 / (std::min(std::abs(dx), std::abs(dy)) + std::max(float(nw + ne + sw + se) / 32, 2.0f));
      dx = std::clamp(dx * scale, -kReach, kReach), dy = std::clamp(dy * scale, -kReach, kReach);
      const auto at = [&](float way) {
        return between(from, width, height, float(x) + way * dx, float(y) + way * dy);
      };
      const auto a = at(-1.0f / 6), b = at(1.0f / 6), c = at(-0.5f), d = at(0.5f);
      std::uint8_t near[4], far[4];
      for (std::size_t k = 0; k < 4; ++k) {
        near[k] = std::uint8_t(0.5f * (a[k] + b[k]) + 0.5f);
        far[k] = std::uint8_t(0.25f * (a[k] + b[k] + c[k] + d[k]) + 0.5f);
      }
      const int reached = luma_of(far);
      std::copy_n(reached < low || reached > high ? near : far, 4,
                  &rgba[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 4]);
    }
}

}  // namespace ctpm
