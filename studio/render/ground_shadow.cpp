#include "studio/render/ground_shadow.h"

#include <algorithm>
#include <cmath>

#include "studio/render/wide_loop.h"

namespace ctpm::render {
namespace {

constexpr int kStep = 8;  // pixels between knots; the shadow has no finer detail
constexpr std::size_t kTexels = std::size_t(GroundShadow::kSize) * GroundShadow::kSize;

}  // namespace

GroundShadow::GroundShadow(Vec3 centre, Vec3 x, Vec3 y, Vec3 up, double reach)
    : centre_(centre),
      half_x_(x),
      half_y_(y),
      x_(x / dot(x, x)),
      y_(y / dot(y, y)),
      up_(up / reach),
      lowest_(kTexels),
      touched_(kTexels),
      narrow_(kTexels),
      wide_(kTexels),
      swap_(kTexels) {}

void GroundShadow::clear() { std::fill(lowest_.begin(), lowest_.end(), INFINITY); }

void GroundShadow::add_point(Vec3 p, const Cutaway& cutaway) {
  if (cutaway.leaves_out(p)) return;
  const Vec3 d = p - centre_;
  const int column = int(std::floor((0.5 + 0.5 * dot(d, x_)) * kSize)),
            row = int(std::floor((0.5 + 0.5 * dot(d, y_)) * kSize));
  if (column < 0 || row < 0 || column >= kSize || row >= kSize) return;
  float& texel = lowest_[std::size_t(row) * kSize + std::size_t(column)];
  texel = std::min(texel, float(dot(d, up_)));
}

void GroundShadow::add(const Surface& surface, std::span<const Vec3> position, std::size_t triangle_count,
                       const Cutaway& cutaway) {
  const double texel = 2 / (kSize * norm(x_));  // side of a texel [m]
  for (std::size_t i = 0; i < triangle_count; ++i) {
    const auto& t = surface.triangle[i];
    const Vec3 a = position[std::size_t(t[0])], b = position[std::size_t(t[1])] - a,
               c = position[std::size_t(t[2])] - a;
    const double longest = std::max({dot(b, b), dot(c, c), dot(b - c, b - c)});
    if (longest < texel * texel) {
      add_point(a + (b + c) / 3.0, cutaway);
      continue;
    }
    const int parts = std::min(int(std::sqrt(longest) / texel) + 1, 64);  // points at most a texel apart
    for (int u = 0; u <= parts; ++u)
      for (int v = 0; u + v <= parts; ++v) add_point(a + (double(u) / parts) * b + (double(v) / parts) * c, cutaway);
  }
}

void GroundShadow::blur(const std::vector<float>& from, std::vector<float>& to, double width) {
  const int radius = int(std::ceil(2.2 * width));
  std::vector<float> weight;
  float total = 0;
  for (int k = -radius; k <= radius; ++k)
    weight.push_back(float(std::exp(-k * k / (2 * width * width)))), total += weight.back();
  for (float& w : weight) w /= total;
  // Blurs rows, then columns; there is no shadow beyond the border.
  for (int r = 0; r < kSize; ++r)
    for (int c = 0; c < kSize; ++c) {
      float sum = 0;
      for (int k = std::max(-radius, -c); k <= std::min(radius, kSize - 1 - c); ++k)
        sum += weight[std::size_t(k + radius)] * from[std::size_t(r * kSize + c + k)];
      swap_[std::size_t(r * kSize + c)] = sum;
    }
  for (int r = 0; r < kSize; ++r) {
    float* row = &to[std::size_t(r * kSize)];
    std::fill(row, row + kSize, 0.0f);
    for (int k = std::max(-radius, -r); k <= std::min(radius, kSize - 1 - r); ++k) {
      const float w = weight[std::size_t(k + radius)];
      const float* other = &swap_[std::size_t((r + k) * kSize)];
      for (int c = 0; c < kSize; ++c) row[c] += w * other[c];
    }
  }
}

/// Combines both blurs in wide_.
void GroundShadow::find_darkness() {
  constexpr float kContact = 0.46f, kRoom = 0.38f, kDarkest = 0.85f;
  // 1 on the ground, a third at height `reach`, 0 far above.
  for (std::size_t i = 0; i < kTexels; ++i) {
    const float h = std::max(lowest_[i], 0.0f);
    touched_[i] = 1 / (1 + h * (1 + h));
  }
  blur(touched_, narrow_, 1.6), blur(narrow_, wide_, 6.5);
  for (std::size_t i = 0; i < kTexels; ++i) wide_[i] = std::min(kDarkest, kContact * narrow_[i] + kRoom * wide_[i]);
}

/// Darkness at a point in texel coordinates, interpolated; 0 outside.
float GroundShadow::darkness(float u, float v) const {
  if (!(u >= 0 && v >= 0 && u < kSize - 1 && v < kSize - 1)) return 0;
  const int c = int(u), r = int(v);
  const float s = u - float(c), t = v - float(r);
  const float* row = &wide_[std::size_t(r * kSize + c)];
  return (1 - t) * ((1 - s) * row[0] + s * row[1]) + t * ((1 - s) * row[kSize] + s * row[kSize + 1]);
}

float GroundShadow::darkness_at(Vec3 p) const {
  const Vec3 d = p - centre_;
  // The outermost texels reach half a texel less far than the ground.
  const auto texel = [](double at) { return std::clamp(float((0.5 + 0.5 * at) * kSize - 0.5), 0.0f, kSize - 1.001f); };
  return darkness(texel(dot(d, x_)), texel(dot(d, y_)));
}

/// The part of the picture that the ground square covers, in knots: columns [left, right), rows [top, bottom).
GroundShadow::KnotRange GroundShadow::find_range(const Frame& frame, const Mat4& m) const {
  const KnotRange all{0, 0, frame.width / kStep + 2, frame.height / kStep + 2};
  double left = 1, right = -1, low = 1, high = -1;
  for (const double u : {-1.0, 1.0})
    for (const double v : {-1.0, 1.0}) {
      const Vec3 p = centre_ + u * half_x_ + v * half_y_;
      const auto row = [&](std::size_t r) { return m[r] * p.x + m[4 + r] * p.y + m[8 + r] * p.z + m[12 + r]; };
      const double w = row(3);
      if (w <= 0) return all;  // a corner is behind the eye
      left = std::min(left, row(0) / w), right = std::max(right, row(0) / w);
      low = std::min(low, row(1) / w), high = std::max(high, row(1) / w);
    }
  const auto knot = [](double clip, int size) { return int((0.5 + 0.5 * std::clamp(clip, -1.0, 1.0)) * size / kStep); };
  return {knot(left, frame.width), knot(-high, frame.height), std::min(all.right, knot(right, frame.width) + 2),
          std::min(all.bottom, knot(-low, frame.height) + 2)};
}

/// Darkness at the knots of a range.
void GroundShadow::find_knots(const Frame& frame, const Mat4& m, const KnotRange& range) {
  // Maps ground coordinates (u, v, 1) to clip coordinates (x, y, w); its adjugate is the inverse up to scale.
  const auto row = [&](int r, Vec3 p, double last) {
    return m[std::size_t(r)] * p.x + m[std::size_t(4 + r)] * p.y + m[std::size_t(8 + r)] * p.z +
           last * m[std::size_t(12 + r)];
  };
  const Vec3 to_x{row(0, half_x_, 0), row(0, half_y_, 0), row(0, centre_, 1)},
      to_y{row(1, half_x_, 0), row(1, half_y_, 0), row(1, centre_, 1)};
  const Vec3 to_w{row(3, half_x_, 0), row(3, half_y_, 0), row(3, centre_, 1)};
  const Vec3 from_x = cross(to_y, to_w), from_y = cross(to_w, to_x), from_w = cross(to_x, to_y);
  const double facing = dot(to_w, from_w);
  knots_.assign(std::size_t(range.columns()) * std::size_t(range.rows()), 0.0f);
  for (int r = range.top; r < range.bottom; ++r)
    for (int c = range.left; c < range.right; ++c) {
      const double x = 2.0 * c * kStep / frame.width - 1, y = 1 - 2.0 * r * kStep / frame.height;
      const Vec3 g = x * from_x + y * from_y + from_w;
      if (g.z * facing <= 0) continue;  // above the horizon
      const double u = g.x / g.z, v = g.y / g.z;
      knots_[std::size_t((r - range.top) * range.columns() + c - range.left)] =
          darkness(float((0.5 + 0.5 * u) * kSize - 0.5), float((0.5 + 0.5 * v) * kSize - 0.5));
    }
}

void GroundShadow::draw(Frame& frame, const Mat4& clip_from_world) {
  find_darkness();
  const KnotRange range = find_range(frame, clip_from_world);
  find_knots(frame, clip_from_world, range);
  light_.resize(std::size_t(kStep * range.columns()));
  for (int r = range.top; r + 1 < range.bottom; ++r)
    for (int y = r * kStep; y < std::min(frame.height, (r + 1) * kStep); ++y) darken_row(frame, range, y);
}

/// Darkens one row of the picture by linear interpolation between the knots.
void GroundShadow::darken_row(Frame& frame, const KnotRange& range, int y) {
  const float t = float(y % kStep) / kStep;
  const float* upper = &knots_[std::size_t((y / kStep - range.top) * range.columns())];
  const float* lower = upper + range.columns();
  const auto at = [&](int c) { return upper[c] + t * (lower[c] - upper[c]); };
  int begin = 0, end = range.columns() - 1;  // skips knots without shadow
  while (begin < end && at(begin) + at(begin + 1) == 0) ++begin;
  while (begin < end && at(end) + at(end - 1) == 0) --end;
  if (begin == end) return;
  for (int c = begin; c < end; ++c) {
    std::uint16_t* light = &light_[std::size_t(kStep * (c - begin))];
    const float left = 65535 * (1 - at(c)), step = 65535 * (at(c) - at(c + 1)) / kStep;
    for (int k = 0; k < kStep; ++k) light[k] = std::uint16_t(left + float(k) * step);
  }
  const int first = (range.left + begin) * kStep, last = std::min(frame.width, (range.left + end) * kStep);
  std::uint8_t* to = &frame.rgb[(std::size_t(y) * std::size_t(frame.width) + std::size_t(first)) * 3];
  const std::uint16_t* light = light_.data();
  const int count = last - first;
  // In 16 bits, so that the compiler vectorises the loop: colour * light in 1/256, rounded.
  run_wide([=]() CTPM_WIDE_LOOP {
    const auto darken = [](std::uint8_t colour, std::uint16_t by) CTPM_WIDE_LOOP {
      const std::uint16_t product = std::uint16_t((std::uint32_t(colour << 8) * by) >> 16);
      return std::uint8_t(std::uint16_t(product + 128) >> 8);
    };
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < 3; ++k) to[3 * i + k] = darken(to[3 * i + k], light[i]);
  });
}

}  // namespace ctpm::render
