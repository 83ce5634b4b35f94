#pragma once

#include <cstdint>
#include <vector>

namespace ctpm {

/// Smooths the stairs of edges in a picture (RGBA, colours multiplied by alpha): pixels of high contrast are
/// averaged along the edge that passes them, as fast approximate anti-aliasing does. Four samples a pixel
/// would look much the same and cost more than twice the time in software. `scratch` keeps memory from
/// picture to picture.
void smooth_edges(std::vector<std::uint8_t>& rgba, int width, int height, std::vector<std::uint8_t>& scratch);

}  // namespace ctpm
