#include "studio/render/edge_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "studio/render/wide_loop.h"

namespace ctpm::render {
namespace {

constexpr int kBackdropLuma = 160;  // luma of pixels without drawing, in [0, 255]
constexpr int kLeastContrast = 26;  // smaller steps are not edges
constexpr float kReach = 8;         // longest search along an edge [pixels]

int luma_of(const std::uint8_t* p) { return (77 * p[0] + 150 * p[1] + 29 * p[2] + kBackdropLuma * (255 - p[3])) >> 8; }

/// Brightness of a run of pixels. Reads whole words through plain pointers, so that the compiler vectorises the loop.
void find_luma(const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
  run_wide([=]() CTPM_WIDE_LOOP {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t word;
      std::memcpy(&word, from + 4 * i, 4);
      const std::uint32_t red = word & 255, green = (word >> 8) & 255, blue = (word >> 16) & 255, alpha = word >> 24;
      to[i] = std::uint8_t((77 * red + 150 * green + 29 * blue + kBackdropLuma * (255 - alpha)) >> 8);
    }
  });
}

/// Marks the pixels of a row that differ from their diagonal neighbours.
void find_edges(const std::uint8_t* row, int width, std::uint8_t* is_edge) {
  const std::uint8_t *above = row - width, *below = row + width;
  run_wide([=]() CTPM_WIDE_LOOP {
    for (int x = 1; x + 1 < width; ++x) {
      const std::uint8_t low =
          std::min(std::min(std::min(above[x - 1], above[x + 1]), std::min(below[x - 1], below[x + 1])), row[x]);
      const std::uint8_t high =
          std::max(std::max(std::max(above[x - 1], above[x + 1]), std::max(below[x - 1], below[x + 1])), row[x]);
      is_edge[x] = std::uint8_t(high - low) >= kLeastContrast;
    }
  });
}

/// Interpolated colour between pixels.
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

/// The first edge at or after `x`, or `end`.
int next_edge(const std::vector<std::uint8_t>& is_edge, int x, int end) {
  const void* found = x < end ? std::memchr(&is_edge[std::size_t(x)], 1, std::size_t(end - x)) : nullptr;
  return found ? int(static_cast<const std::uint8_t*>(found) - is_edge.data()) : end;
}

/// The colour of an edge pixel: the mean of samples along the edge.
std::array<std::uint8_t, 4> along_edge(const std::vector<std::uint8_t>& rgba, const std::uint8_t* m, int width,
                                       int height, int x, int y) {
  const int nw = m[-width - 1], ne = m[-width + 1], sw = m[width - 1], se = m[width + 1];
  const int low = std::min({int(*m), nw, ne, sw, se}), high = std::max({int(*m), nw, ne, sw, se});
  // The edge is perpendicular to the gradient.
  float dx = float(-(nw + ne) + (sw + se)), dy = float((nw + sw) - (ne + se));
  const float scale = 1 / (std::min(std::abs(dx), std::abs(dy)) + std::max(float(nw + ne + sw + se) / 32, 2.0f));
  dx = std::clamp(dx * scale, -kReach, kReach), dy = std::clamp(dy * scale, -kReach, kReach);
  const auto at = [&](float way) {
    return between(rgba.data(), width, height, float(x) + way * dx, float(y) + way * dy);
  };
  const auto a = at(-1.0f / 6), b = at(1.0f / 6), c = at(-0.5f), d = at(0.5f);
  std::array<std::uint8_t, 4> near, far;
  for (std::size_t k = 0; k < 4; ++k) {
    near[k] = std::uint8_t(0.5f * (a[k] + b[k]) + 0.5f);
    far[k] = std::uint8_t(0.25f * (a[k] + b[k] + c[k] + d[k]) + 0.5f);
  }
  const int reached = luma_of(far.data());
  return reached < low || reached > high ? near : far;
}

}  // namespace

void EdgeSmoother::smooth(std::vector<std::uint8_t>& rgba, int width, int height, parallel::Team& team) {
  if (width < 3 || height < 3) return;
  luma_.resize(rgba.size() / 4);
  const auto row_of = [&](int band) { return height * band / kBands; };
  team.for_each(kBands, [&](int band) {
    const auto begin = std::size_t(row_of(band)) * std::size_t(width),
               end = std::size_t(row_of(band + 1)) * std::size_t(width);
    find_luma(rgba.data() + 4 * begin, luma_.data() + begin, end - begin);
  });
  team.for_each(kBands, [&](int band) {
    auto& [is_edge, smoothed] = bands_[std::size_t(band)];
    is_edge.assign(std::size_t(width), 0), smoothed.clear();
    for (int y = std::max(1, row_of(band)); y < std::min(height - 1, row_of(band + 1)); ++y) {
      const std::uint8_t* row = luma_.data() + std::ptrdiff_t(y) * width;
      find_edges(row, width, is_edge.data());
      for (int x = next_edge(is_edge, 1, width - 1); x < width - 1; x = next_edge(is_edge, x + 1, width - 1))
        smoothed.push_back(
            {std::size_t(y) * std::size_t(width) + std::size_t(x), along_edge(rgba, row + x, width, height, x, y)});
    }
  });
  // Written at the end, because every colour is computed from the unchanged picture.
  for (const Band& band : bands_)
    for (const Smoothed& s : band.smoothed) std::copy_n(s.rgba.data(), 4, &rgba[4 * s.pixel]);
}

}  // namespace ctpm::render
