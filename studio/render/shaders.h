#pragma once

#include <string>

namespace ctpm::render {

/// GLSL 3.30 sources. What several of them share is put in front when they are handed out.
struct ShaderSource {
  std::string vertex, fragment;
};

/// Which side of an organ's surface is drawn, each with its own program: what the outside need not work out is
/// left out, for most pixels are outside.
enum class OrganPass {
  outside,  ///< triangles that face the eye
  inside,   ///< walls of cuts, inner faces, and with a cutaway the section
  glassy,   ///< the outside, see-through where it faces the eye
};

/// Colours come out multiplied by their alpha; the backdrop is put behind them afterwards.
ShaderSource organ_shader(OrganPass pass, bool has_cutaway);
ShaderSource tool_shader();
ShaderSource sphere_shader();
ShaderSource rod_shader();  ///< elements

}  // namespace ctpm::render
