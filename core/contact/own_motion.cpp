#include "core/contact/own_motion.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace ctpm::contact {

OwnMotion::OwnMotion(const Model& model)
    : model_(model),
      severed_(model.has_scalpel() ? model.axial.size() : 0, 0),
      pieces_(model),
      is_held_(model.sphere_count()),
      by_piece_(model.sphere_count()) {
  pieces_.reserve();
  std::iota(by_piece_.begin(), by_piece_.end(), 0);
  find();
}

void OwnMotion::follow(const std::vector<std::uint8_t>& axial_severed) {
  if (axial_severed == severed_) return;
  severed_ = axial_severed;
  find();
}

void OwnMotion::find() {
  (void)pieces_.find(severed_);
  const std::vector<std::int32_t>& piece = pieces_.piece();
  std::fill(is_held_.begin(), is_held_.end(), std::uint8_t{0});
  for (std::size_t i = 0; i < piece.size(); ++i) is_held_[std::size_t(piece[i])] |= model_.held_axes[i] != 0;
  std::sort(by_piece_.begin(), by_piece_.end(), [&](std::int32_t a, std::int32_t b) {
    const std::int32_t of_a = piece[std::size_t(a)], of_b = piece[std::size_t(b)];
    return of_a != of_b ? of_a < of_b : a < b;
  });
}

std::int32_t OwnMotion::free_piece(std::int32_t sphere) const {
  const std::int32_t piece = pieces_.piece()[std::size_t(sphere)];
  return is_held_[std::size_t(piece)] ? -1 : piece;
}

surface::RigidMotion OwnMotion::of(std::int32_t piece, const Vec3Array& position) const {
  const auto piece_of = [&](std::int32_t sphere) { return pieces_.piece()[std::size_t(sphere)]; };
  const auto first = std::lower_bound(by_piece_.begin(), by_piece_.end(), piece,
                                      [&](std::int32_t sphere, std::int32_t of) { return piece_of(sphere) < of; });
  const auto last =
      std::find_if(first, by_piece_.end(), [&](std::int32_t sphere) { return piece_of(sphere) != piece; });
  return surface::rigid_motion(model_, {first, last}, position);
}

}  // namespace ctpm::contact
