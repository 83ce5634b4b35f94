#pragma once

#include <cstddef>
#include <string>

namespace ctpm::render {

/// GLSL 3.30 sources, each with the code that several shaders share in front.
struct ShaderSource {
  std::string vertex, fragment;
};

/// The part of an organ's surface that is drawn. Each has its own program: most pixels show the outside, whose program
/// omits what it does not need.
enum class OrganPass {
  outside,   ///< triangles that face the eye, far from cuts
  near_cut,  ///< the same beside cuts, where blood oozes
  inside,    ///< walls of cuts, and with a cutaway the section
  glassy,    ///< the outside, transparent where it faces the eye
};
inline constexpr std::size_t kOrganPasses = 4;

/// Where nearness_to_lips() is less, no blood shows however high the relief stands.
inline constexpr float kLeastOoze = 0.1f;

/// The shader's output has premultiplied alpha; the backdrop is composited behind it afterwards.
ShaderSource organ_shader(OrganPass pass, bool has_cutaway);
ShaderSource count_shader();  ///< without colour: which pixels show a cutaway's section
ShaderSource tool_shader();
ShaderSource sphere_shader();
ShaderSource rod_shader();  ///< elements

}  // namespace ctpm::render
