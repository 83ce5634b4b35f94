#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/organ.h"
#include "studio/render/camera.h"
#include "studio/render/frame.h"

namespace ctpm::render {

/// The soft shadow that a scene casts straight down onto its ground: a square picture of darkness.
class GroundShadow {
 public:
  static constexpr int kSize = 96;  ///< [texels] along a side; the shadow is blurred far wider than a texel

  /// The plane through `centre` spanned by `x` and `y` (half a side each) [m]; what stands `reach` [m] above
  /// it darkens it by a third.
  GroundShadow(Vec3 centre, Vec3 x, Vec3 y, Vec3 up, double reach);

  void clear();
  /// Adds the first `triangle_count` triangles of a surface whose vertices are at `position`.
  void add(const Surface& surface, std::span<const Vec3> position, std::size_t triangle_count);
  /// Darkens `frame`, a picture of the empty ground taken with `clip_from_world`: a narrow shadow for the
  /// contact and a wide one for the room's light.
  void draw(Frame& frame, const Mat4& clip_from_world);

 private:
  void add_point(Vec3 p);
  void blur(const std::vector<float>& from, std::vector<float>& to, double width);

  Vec3 centre_, half_x_, half_y_;
  Vec3 x_, y_, up_;  ///< turn a world vector into ground coordinates, -1 to 1, and height in reaches

  struct KnotRange {
    int left, top, right, bottom;
    int columns() const { return right - left; }
    int rows() const { return bottom - top; }
  };
  float darkness(float u, float v) const;
  void find_darkness();
  KnotRange find_range(const Frame& frame, const Mat4& clip_from_world) const;
  void darken_row(Frame& frame, const KnotRange& range, int y);
  void find_knots(const Frame& frame, const Mat4& clip_from_world, const KnotRange& range);

  std::vector<float> lowest_;                          ///< height of what stands there [reaches] (kSize x kSize)
  std::vector<float> touched_, narrow_, wide_, swap_;  ///< (kSize x kSize)
  std::vector<float> knots_;                           ///< darkness at every few pixels of a part of the picture
  std::vector<std::uint16_t> light_;                   ///< of a row, 65535: all; for each part of a colour
};

}  // namespace ctpm::render
