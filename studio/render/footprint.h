#pragma once

#include <algorithm>

#include "core/model/vec3.h"
#include "studio/render/camera.h"
#include "studio/render/gl_objects.h"

namespace ctpm::render {

/// Grows a rectangle around projected points.
class Footprint {
 public:
  Footprint(const Mat4& clip_from_world, int width, int height) : m_(clip_from_world), width_(width), height_(height) {}

  void add(Vec3 p) {
    const double w = m_[3] * p.x + m_[7] * p.y + m_[11] * p.z + m_[15];
    if (w <= 0) {
      everywhere_ = true;
      return;
    }
    const double x = (m_[0] * p.x + m_[4] * p.y + m_[8] * p.z + m_[12]) / w;
    const double y = (m_[1] * p.x + m_[5] * p.y + m_[9] * p.z + m_[13]) / w;
    left_ = std::min(left_, x), right_ = std::max(right_, x), bottom_ = std::min(bottom_, y), top_ = std::max(top_, y);
  }

  /// The pixels that the points and a border around them cover; may be empty.
  PixelRect pixels() const {
    constexpr int kBorder = 3;
    if (everywhere_) return {0, 0, width_, height_};
    const auto at = [](double clip, int size) { return (0.5 + 0.5 * std::clamp(clip, -1.0, 1.0)) * size; };
    const int x0 = std::max(0, int(at(left_, width_)) - kBorder),
              x1 = std::min(width_, int(at(right_, width_)) + kBorder + 1);
    const int y0 = std::max(0, int(at(bottom_, height_)) - kBorder),
              y1 = std::min(height_, int(at(top_, height_)) + kBorder + 1);
    return {x0, y0, std::max(0, x1 - x0), std::max(0, y1 - y0)};
  }

 private:
  Mat4 m_;
  int width_, height_;
  double left_ = 2, right_ = -2, bottom_ = 2, top_ = -2;
  bool everywhere_ = false;
};

}  // namespace ctpm::render
