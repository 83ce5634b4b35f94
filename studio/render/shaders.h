#pragma once

#include <string>

namespace ctpm {

/// GLSL 3.30 sources. What several of them share is put in front when they are handed out.
struct ShaderSource {
  std::string vertex, fragment;
};

/// Colours come out multiplied by their alpha; the backdrop is put behind them afterwards.
/// Glassy: see-through where it faces the eye. With a cutaway the section is drawn as inner tissue.
ShaderSource organ_shader(bool is_glassy, bool has_cutaway);
ShaderSource tool_shader();
ShaderSource sphere_shader();
ShaderSource rod_shader();  ///< elements

}  // namespace ctpm
