#pragma once

#include <span>

#include "core/model/vec3.h"
#include "studio/render/camera.h"
#include "studio/render/overlay.h"
#include "studio/render/picture_size.h"

namespace ctpm::film {

/// What a film shows that panels should not hide: points in the world [m].
struct Shown {
  std::span<const Vec3> organs;  ///< of what is drawn of them, at rest
  std::span<const Vec3> tools;   ///< where they are used in the film
};

/// The camera moved sideways, up or down and, where that does not suffice, back, without a turn, by as little as lets
/// the panels and the picture's border hide the least of what is shown.
render::Camera beside_panels(const render::Camera& camera, const render::PictureSize& size,
                             std::span<const render::PixelBox> panels, const Shown& shown);

}  // namespace ctpm::film
