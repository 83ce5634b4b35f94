#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/render/overlay.h"
#include "studio/render/picture_size.h"
#include "studio/render/renderer.h"

namespace ctpm::film {

/// A small picture within the picture: the same moment, seen in another way.
class Inset {
 public:
  enum class Kind {
    near,     ///< the tool from close by, from the same side
    section,  ///< the tissue opened at the tool, along the picture's plane
  };

  /// Of a picture of this size; `scene` is that of the picture's Renderer. Errors: no OpenGL 3.3.
  static Result<Inset> create(Kind kind, const render::PictureSize& picture, const render::SceneView& scene);

  /// Draws it into the picture, as number `place` of those above each other in its lower right corner. `draw` is how
  /// the picture itself was drawn, `moments` the argument of following_camera().
  void add(render::Frame& picture, int place, const State& state, render::DrawOptions draw,
           const std::vector<Inputs>& moments);

  /// Where add() draws it, without its frame.
  static render::PixelBox box(const render::PictureSize& picture, int place);

  /// How much of the picture's width they take at its lower border [pixels]; in half a pair they stand higher.
  static int taken_right(const render::PictureSize& picture);

 private:
  Inset(Kind kind, std::unique_ptr<render::Renderer> renderer) : kind_(kind), renderer_(std::move(renderer)) {}
  Kind kind_;
  std::unique_ptr<render::Renderer> renderer_;
  bool has_place_ = false;
  Vec3 place_;  ///< where the tool was last [m]
};

/// The insets that words name: near and section, with commas between. Errors: another word.
Result<std::vector<Inset::Kind>> insets_of(const std::string& words);

}  // namespace ctpm::film
