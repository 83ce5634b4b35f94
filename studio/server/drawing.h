#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "core/model/state.h"
#include "recordings/session_reader.h"
#include "studio/render/picture_size.h"
#include "studio/render/renderer.h"
#include "studio/views/look.h"

namespace ctpm::server {

/// How a stage is drawn here instead of by the page: as `export` draws it.
struct DrawingRequest {
  views::LookRequest look;
  render::PictureSize size;
};

/// Draws moments of one session as a video shows them, without its overlay. One thread may use it, which made it.
class Drawing {
 public:
  /// `reader` must outlive this. Errors: those of views::find_look() and of render::Renderer.
  static Result<std::unique_ptr<Drawing>> create(recordings::SessionReader& reader, const DrawingRequest& request);

  /// Checks a request; the legend of its colours, without a title if they need none. Errors: those of find_look().
  static Result<render::Legend> check(const recordings::SessionReader& reader, const DrawingRequest& request);

  /// Message with the picture of the State before `tick`. PROTOCOL.md gives its bytes. Errors: a damaged part.
  Result<std::string> draw(const State& state, std::int64_t tick, std::uint32_t stage, std::uint32_t request);

 private:
  Drawing(recordings::SessionReader& reader, views::Look look, std::unique_ptr<render::Renderer> renderer)
      : reader_(reader), look_(std::move(look)), renderer_(std::move(renderer)) {}

  recordings::SessionReader& reader_;
  views::Look look_;
  std::unique_ptr<render::Renderer> renderer_;
};

}  // namespace ctpm::server
