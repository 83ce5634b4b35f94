#include "core/conjugate_gradient.h"

namespace ctpm {

ConjugateGradient::ConjugateGradient(const Model& model, const Slabs& slabs, Team& team, const Kernels& kernels)
    : model_(model),
      slabs_(slabs),
      team_(team),
      kernels_(kernels),
      inverse_(6 * model.sphere_count()),
      residual_(3 * model.sphere_count()),
      preconditioned_(3 * model.sphere_count()),
      direction_(3 * model.sphere_count()),
      product_(3 * model.sphere_count()),
      part_(std::size_t(slabs.count())) {
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] != 0) held_.push_back(std::int32_t(i));
}

void ConjugateGradient::set_blocks(const DiagonalBlocks& blocks, std::int32_t pinned) {
  const std::size_t n = model_.sphere_count();
  team_.for_each(slabs_.count(), [&](int slab) {
    kernels_.invert_blocks(n, blocks.data(), inverse_.data(), std::size_t(slabs_.begin(slab)),
                           std::size_t(slabs_.end(slab)));
  });
  for (const std::int32_t sphere : held_) {
    const auto i = std::size_t(sphere);
    if (model_.held_axes[i] != kAnchored) {
      // What is left free is inverted by itself.
      double own[6], inverse[6];
      for (std::size_t k = 0; k < 6; ++k) own[k] = blocks[k * n + i];
      const auto is_held = [&](int axis) { return (model_.held_axes[i] >> axis & 1) != 0; };
      if (is_held(0) || is_held(1)) own[1] = 0;
      if (is_held(0) || is_held(2)) own[2] = 0;
      if (is_held(1) || is_held(2)) own[4] = 0;
      kernels_.invert_blocks(1, own, inverse, 0, 1);
      for (std::size_t k = 0; k < 6; ++k) inverse_[k * n + i] = inverse[k];
    }
    hold(i, model_.held_axes[i]);
  }
  if (pinned >= 0) hold(std::size_t(pinned), kAnchored);
}

void ConjugateGradient::hold(std::size_t sphere, std::uint8_t axes) {
  const std::size_t n = model_.sphere_count();
  constexpr std::uint8_t kAxes[6] = {1, 3, 5, 2, 6, 4};  // which axes xx, xy, xz, yy, yz, zz belong to
  for (std::size_t k = 0; k < 6; ++k)
    if ((kAxes[k] & axes) != 0) inverse_[k * n + sphere] = 0;
}

}  // namespace ctpm
