#include "core/cutting/pieces.h"

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

/// Whether two pieces became one.
bool Pieces::join(std::int32_t p, std::int32_t q) {
  const std::int32_t a = root(p), b = root(q);
  if (a != b) piece_[std::size_t(std::max(a, b))] = std::min(a, b);
  return a != b;
}

std::int32_t Pieces::find(const State& state) {
  auto count = std::int32_t(model_.sphere_count());
  piece_.resize(model_.sphere_count());
  for (std::int32_t i = 0; i < count; ++i) piece_[std::size_t(i)] = i;
  const auto join_living = [&](const auto& elements, const std::vector<std::uint8_t>& severed) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      if ((severed.empty() || !severed[i]) && join(elements.a[i], elements.b[i])) --count;
  };
  join_living(model_.edges, state.edge_severed);
  join_living(model_.tpms, state.tpm_severed);
  for (std::size_t i = 0; i < piece_.size(); ++i) piece_[i] = root(std::int32_t(i));
  return count;
}

std::int32_t Pieces::rejoin(std::span<const Crossing> crossings) {
  std::int32_t count = 0;
  const std::size_t edges = model_.edges.size();
  for (const Crossing& crossing : crossings) {
    const auto e = std::size_t(crossing.element);
    count += e < edges ? join(model_.edges.a[e], model_.edges.b[e])
                       : join(model_.tpms.a[e - edges], model_.tpms.b[e - edges]);
  }
  return count;
}

}  // namespace ctpm
