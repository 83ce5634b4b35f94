#include "core/surface/gathering.h"

#include <cstddef>

#include "core/surface/facets.h"

namespace ctpm::surface {
namespace {

/// For each vertex the one nearest to the middle of its facet at rest.
std::vector<Gathering::Index> middles_of_facets(const Surface& surface, const Facets& facets) {
  const std::size_t count = surface.vertex.size();
  std::vector<Vec3> sum(count);
  std::vector<double> area(count, 0);
  for (std::size_t v = 0; v < count; ++v) {
    const auto vertex = Gathering::Index(v);
    const auto facet = std::size_t(facets.facet_of(vertex));
    sum[facet] += facets.area(vertex) * surface.vertex[v], area[facet] += facets.area(vertex);
  }
  std::vector<Gathering::Index> nearest(count, -1);
  for (std::size_t v = 0; v < count; ++v) {
    const auto facet = std::size_t(facets.facet_of(Gathering::Index(v)));
    const auto off = [&](std::size_t u) { return norm(area[facet] * surface.vertex[u] - sum[facet]); };
    if (nearest[facet] < 0 || off(v) < off(std::size_t(nearest[facet]))) nearest[facet] = Gathering::Index(v);
  }
  std::vector<Gathering::Index> middles(count);
  for (std::size_t v = 0; v < count; ++v) middles[v] = nearest[std::size_t(facets.facet_of(Gathering::Index(v)))];
  return middles;
}

}  // namespace

void Gathering::add(const Surface& surface, double radius) {
  const auto before = Index(at_.size());
  for (const Index middle : middles_of_facets(surface, Facets(surface, radius))) at_.push_back(before + middle);
  const auto count = Index(at_.size());
  first_.resize(at_.size() + 1, 0);
  for (Index v = before; v < count; ++v) ++first_[std::size_t(at(v)) + 1];
  for (Index v = before; v < count; ++v) first_[std::size_t(v) + 1] += first_[std::size_t(v)];
  std::vector<Index> next(first_.begin() + before, first_.end() - 1);
  members_.resize(at_.size());
  for (Index v = before; v < count; ++v) members_[std::size_t(next[std::size_t(at(v) - before)]++)] = v;
}

}  // namespace ctpm::surface
