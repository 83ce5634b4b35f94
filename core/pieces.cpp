#include "core/pieces.h"

#include <algorithm>

namespace ctpm {

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

std::int32_t Pieces::find(const State& state) {
  auto count = std::int32_t(model_.sphere_count());
  piece_.resize(model_.sphere_count());
  for (std::int32_t i = 0; i < count; ++i) piece_[std::size_t(i)] = i;
  const auto join = [&](const auto& elements, const std::vector<std::uint8_t>& severed) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (!severed.empty() && severed[i]) continue;
      const std::int32_t a = root(elements.a[i]), b = root(elements.b[i]);
      if (a != b) piece_[std::size_t(std::max(a, b))] = std::min(a, b), --count;
    }
  };
  join(model_.edges, state.edge_severed);
  join(model_.tpms, state.tpm_severed);
  for (std::size_t i = 0; i < piece_.size(); ++i) piece_[i] = root(std::int32_t(i));
  return count;
}

}  // namespace ctpm
