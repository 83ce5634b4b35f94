#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ctpm::render {

/// Smooths the stairs of edges in pictures (RGBA, colours multiplied by alpha): pixels of high contrast are
/// averaged along the edge that passes them, as fast approximate anti-aliasing does. Four samples a pixel
/// would look much the same and cost more than twice the time in software.
class EdgeSmoother {
 public:
  void smooth(std::vector<std::uint8_t>& rgba, int width, int height);

 private:
  struct Smoothed {
    std::size_t pixel;
    std::array<std::uint8_t, 4> rgba;
  };
  std::vector<std::uint8_t> luma_, is_edge_;  // kept from picture to picture
  std::vector<Smoothed> smoothed_;
};

}  // namespace ctpm::render
