#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/organ.h"
#include "studio/render/camera.h"
#include "studio/render/frame.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// The soft shadow that a scene casts straight down onto its ground, as a square texture of darkness.
class GroundShadow {
 public:
  static constexpr int kSize = 96;  ///< [texels] along a side; the shadow is blurred far wider than a texel

  /// The ground is the plane through `centre` spanned by `x` and `y` (half a side each) [m]. A surface `reach` [m]
  /// above it darkens it by a third.
  GroundShadow(Vec3 centre, Vec3 x, Vec3 y, Vec3 up, double reach);

  void clear();
  /// Adds the first `triangle_count` triangles of a surface whose vertices are at `position`, but what is left out.
  void add(const Surface& surface, std::span<const Vec3> position, std::size_t triangle_count, const Cutaway& cutaway);
  /// Darkness at a point of the ground [m], 0 to 1, of what was added before find_darkness(); 0 beyond its border.
  float darkness_at(Vec3 p) const;
  void find_darkness();
  /// Darkens `frame`, a picture of the empty ground seen with `clip_from_world`. A narrow shadow shows contact, a wide
  /// one the ambient light.
  void draw(Frame& frame, const Mat4& clip_from_world);

 private:
  void add_point(Vec3 p, const Cutaway& cutaway);
  void blur(const std::vector<float>& from, std::vector<float>& to, double width);

  Vec3 centre_, half_x_, half_y_;
  Vec3 x_, y_, up_;  ///< map a world vector to ground coordinates in [-1, 1], and height in units of `reach`

  struct KnotRange {
    int left, top, right, bottom;
    int columns() const { return right - left; }
    int rows() const { return bottom - top; }
  };
  float darkness(float u, float v) const;
  KnotRange find_range(const Frame& frame, const Mat4& clip_from_world) const;
  void darken_row(Frame& frame, const KnotRange& range, int y);
  void find_knots(const Frame& frame, const Mat4& clip_from_world, const KnotRange& range);

  std::vector<float> lowest_;                          ///< height of the lowest surface [reach] (kSize x kSize)
  std::vector<float> touched_, narrow_, wide_, swap_;  ///< (kSize x kSize)
  std::vector<float> knots_;                           ///< darkness at a coarse grid of pixels in a part of the picture
  std::vector<std::uint16_t> light_;                   ///< share of light left, 65535 = all; one row
};

}  // namespace ctpm::render
