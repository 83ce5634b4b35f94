#include "studio/film/inset.h"

#include <algorithm>
#include <sstream>

#include "studio/output/option_name.h"

namespace ctpm::film {
namespace {

constexpr double kShare = 0.235;                 // of the picture's width and height
constexpr double kNarrow = 0.24, kBelow = 0.43;  // in half a pair: of its height, and of what stands below them
constexpr double kCloser = 0.45;
constexpr double kFieldOfView = 32;  // of a section [deg]
constexpr int kFrame = 2;            // of a light line around it [pixels]

bool is_narrow(const render::PictureSize& picture) { return picture.width < 1.4 * picture.height; }

Vec3 unit(Vec3 v) { return norm(v) > 0 ? v / norm(v) : Vec3{0, -1, 0}; }

}  // namespace

Result<Inset> Inset::create(Kind kind, const render::PictureSize& picture, const render::SceneView& scene) {
  const render::PixelBox own = box(picture, 0);
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(own.width, own.height, scene);
  if (!renderer) return renderer.errors();
  return Inset(kind, std::move(*renderer));
}

render::PixelBox Inset::box(const render::PictureSize& picture, int place) {
  const int width = std::max(16, int(kShare * picture.width)),
            height = std::max(16, int((is_narrow(picture) ? kNarrow : kShare) * picture.height)),
            below = is_narrow(picture) ? int(kBelow * picture.height) : 0;
  const int margin = std::max(4, picture.height / 60);
  return {picture.width - width - margin, picture.height - below - (place + 1) * (height + margin), width, height};
}

int Inset::taken_right(const render::PictureSize& picture) {
  return is_narrow(picture) ? 0 : picture.width - box(picture, 0).x;
}

void Inset::add(render::Frame& picture, int place, const State& state, render::DrawOptions draw,
                const std::vector<Inputs>& moments) {
  const Hand& first = state.last_inputs;
  const Hand& hand = first.tool >= 0 ? first : state.last_inputs.second;
  if (hand.tool >= 0) has_place_ = true, place_ = hand.position;
  draw.ghost.reset();
  const render::Camera whole = draw.camera;
  if (kind_ == Kind::near || has_place_) {
    draw.camera = render::following_camera(renderer_->scene(), whole, moments);
    draw.camera.eye = draw.camera.target + kCloser * (draw.camera.eye - draw.camera.target);
  }
  if (kind_ == Kind::section) {
    // Upright and from its front, so that it shows how deep a cut goes.
    const render::SceneView& scene = renderer_->scene();
    const Vec3 up = render::up_of(*scene.model), back = whole.eye - whole.target,
               front = unit(back - dot(back, up) * up);
    draw.cutaway = {has_place_ ? place_ : render::rest_bounds(scene).centre(), front};
    draw.camera = render::section_camera(scene, draw.cutaway.point, front, -front - 0.2 * up, up, kFieldOfView,
                                         double(picture.width) / picture.height);
  }
  const render::Frame small = renderer_->draw(state, draw);
  const auto [left, top, width, height] = box({picture.width, picture.height}, place);
  if (left < kFrame || top < kFrame) return;
  for (int y = -kFrame; y < height + kFrame; ++y)
    for (int x = -kFrame; x < width + kFrame; ++x) {
      std::uint8_t* to = &picture.rgb[std::size_t((top + y) * picture.width + left + x) * 3];
      const bool inside = x >= 0 && y >= 0 && x < width && y < height;
      for (int c = 0; c < 3; ++c) to[c] = inside ? small.rgb[std::size_t(y * width + x) * 3 + std::size_t(c)] : 225;
    }
}

Result<std::vector<Inset::Kind>> insets_of(const std::string& words) {
  std::vector<Inset::Kind> kinds;
  Errors errors;
  std::istringstream list(words);
  for (std::string word; std::getline(list, word, ',');)
    if (word == "near")
      kinds.push_back(Inset::Kind::near);
    else if (word == "section")
      kinds.push_back(Inset::Kind::section);
    else
      errors.push_back({output::option_name("export.inset"),
                        "got '" + word + "', must be near or section, or both with a comma between", ""});
  if (!errors.empty()) return errors;
  return kinds;
}

}  // namespace ctpm::film
