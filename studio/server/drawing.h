#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/model/result.h"
#include "core/model/state.h"
#include "recordings/session_reader.h"
#include "studio/render/picture_size.h"
#include "studio/render/renderer.h"
#include "studio/views/look.h"

namespace ctpm::server {

/// How a page wants to see a session: as `export` shows it.
struct DrawingRequest {
  views::LookRequest look;
  std::optional<render::PictureSize> size;  ///< of drawings; none: the page draws
  std::string expert = {};  ///< file of the session whose cut is shown on the organs, if it is of this scene
};

/// A request that was checked, and what it comes to.
struct DrawingPlan {
  views::Look look;
  render::Legend legend;  ///< without a title: the view needs none
  std::optional<render::PictureSize> size;
};

/// Checks a request. `told` and errors: see views::find_look().
Result<DrawingPlan> plan_drawing(const recordings::SessionReader& reader, const DrawingRequest& request,
                                 const State* told);

/// Draws moments of one session as a video shows them, without its overlay. One thread may use it.
class Drawing {
 public:
  /// `reader` must outlive this.
  explicit Drawing(recordings::SessionReader& reader) : reader_(reader) {}

  /// Draws as that plan has it, which must have a size. Errors: no OpenGL 3.3.
  Result<Done> follow(const DrawingPlan& plan);

  /// Message with the picture of the State before `tick`, after follow(). PROTOCOL.md gives its bytes. Errors: a
  /// damaged part.
  Result<std::string> draw(const State& state, std::int64_t tick, std::uint32_t stage, std::uint32_t request);

 private:
  recordings::SessionReader& reader_;
  views::Look look_;
  render::PictureSize size_;
  std::unique_ptr<render::Renderer> renderer_;
};

}  // namespace ctpm::server
