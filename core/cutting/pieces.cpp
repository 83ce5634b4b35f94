#include "core/cutting/pieces.h"

#include <algorithm>

namespace ctpm::cutting {

std::int32_t Pieces::root(std::int32_t sphere) {
  std::int32_t top = sphere;
  while (piece_[std::size_t(top)] != top) top = piece_[std::size_t(top)];
  while (piece_[std::size_t(sphere)] != top) {
    const std::int32_t next = piece_[std::size_t(sphere)];
    piece_[std::size_t(sphere)] = top;
    sphere = next;
  }
  return top;
}

/// Whether two pieces became one.
bool Pieces::join(std::int32_t p, std::int32_t q) {
  const std::int32_t a = root(p), b = root(q);
  if (a != b) piece_[std::size_t(std::max(a, b))] = std::min(a, b);
  return a != b;
}

std::int32_t Pieces::find(const std::vector<std::uint8_t>& axial_severed) {
  auto count = std::int32_t(model_.sphere_count());
  piece_.resize(model_.sphere_count());
  for (std::int32_t i = 0; i < count; ++i) piece_[std::size_t(i)] = i;
  const AxialElements& axial = model_.axial;
  for (std::size_t i = 0; i < axial.size(); ++i)
    if ((axial_severed.empty() || !axial_severed[i]) && join(axial.a[i], axial.b[i])) --count;
  for (std::size_t i = 0; i < piece_.size(); ++i) piece_[i] = root(std::int32_t(i));
  return count;
}

std::int32_t Pieces::rejoin(std::span<const Crossing> crossings) {
  std::int32_t count = 0;
  for (const Crossing& crossing : crossings) {
    const auto i = std::size_t(crossing.element);
    count += join(model_.axial.a[i], model_.axial.b[i]);
  }
  return count;
}

}  // namespace ctpm::cutting
