#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ctpm::render {

/// Fast approximate anti-aliasing (FXAA) of pictures (RGBA, premultiplied alpha): averages pixels of high contrast
/// along the edge that passes them. Four samples per pixel look much the same and cost more than twice the time in
/// software.
class EdgeSmoother {
 public:
  void smooth(std::vector<std::uint8_t>& rgba, int width, int height);

 private:
  struct Smoothed {
    std::size_t pixel;
    std::array<std::uint8_t, 4> rgba;
  };
  std::vector<std::uint8_t> luma_, is_edge_;  // scratch memory
  std::vector<Smoothed> smoothed_;
};

}  // namespace ctpm::render
