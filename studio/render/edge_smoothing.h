#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/parallel/team.h"

namespace ctpm::render {

/// Fast approximate anti-aliasing (FXAA) of pictures (RGBA, premultiplied alpha): averages pixels of high contrast
/// along the edge that passes them. Four samples per pixel look much the same and cost more than twice the time in
/// software.
class EdgeSmoother {
 public:
  /// The threads of `team` share the rows.
  void smooth(std::vector<std::uint8_t>& rgba, int width, int height, parallel::Team& team);

 private:
  struct Smoothed {
    std::size_t pixel;
    std::array<std::uint8_t, 4> rgba;
  };
  /// Rows that one thread smooths, and its scratch memory.
  struct Band {
    std::vector<std::uint8_t> is_edge;
    std::vector<Smoothed> smoothed;
  };
  static constexpr int kBands = 8;
  std::vector<std::uint8_t> luma_;
  std::array<Band, kBands> bands_;
};

}  // namespace ctpm::render
