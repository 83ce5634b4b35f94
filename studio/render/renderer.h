#pragma once

#include <memory>

#include "core/model/result.h"
#include "core/model/state.h"
#include "studio/render/frame.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// Draws States of one scene into memory, without a display or a GPU. Only `State` and the options decide
/// what is drawn: the same ones give the same pixels, in any order of calls. One thread at a time may use a
/// Renderer.
class Renderer {
 public:
  /// Errors: a size outside [16, 8192], a scene without a model or without one surface for each organ, no
  /// OpenGL 3.3.
  static Result<std::unique_ptr<Renderer>> create(int width, int height, SceneView scene);
  ~Renderer();

  /// The picture of a state.
  Frame draw(const State& state, const DrawOptions& options);

  const SceneView& scene() const;

  /// What draws, with its version.
  std::string opengl() const;

 private:
  struct Parts;
  explicit Renderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::render
