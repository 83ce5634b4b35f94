#pragma once

#include <string>

namespace ctpm {

/// GLSL 3.30 sources. What several of them share is put in front when they are handed out.
struct ShaderSource {
  std::string vertex, fragment;
};

ShaderSource background_shader();
ShaderSource organ_shader();
ShaderSource tool_shader();
ShaderSource sphere_shader();
ShaderSource ground_shader();  ///< the background, darkened by the shadow
ShaderSource shadow_shader();  ///< what stands above the ground, seen from straight above
ShaderSource shadow_blur_shader();

}  // namespace ctpm
