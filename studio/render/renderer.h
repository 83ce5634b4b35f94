#pragma once

#include <memory>
#include <vector>

#include "core/model/result.h"
#include "core/model/state.h"
#include "studio/render/frame.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// Draws States of one scene into memory, without a display or a GPU. The pixels depend only on the State and the
/// options, not on the order of calls. One thread at a time may use a Renderer.
class Renderer {
 public:
  /// Errors: a size outside [16, 8192], a scene without a model or without one surface for each organ, no
  /// OpenGL 3.3.
  static Result<std::unique_ptr<Renderer>> create(int width, int height, SceneView scene);
  ~Renderer();

  /// The picture of a state.
  Frame draw(const State& state, const DrawOptions& options);

  /// Points of the tools in that picture, so close that nothing of use fits between.
  std::vector<Pixel> tool_points(const State& state, const DrawOptions& options) const;

  const SceneView& scene() const;

  /// Name and version of the OpenGL implementation.
  std::string opengl() const;

 private:
  struct Parts;
  explicit Renderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::render
