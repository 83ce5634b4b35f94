#include "studio/render/cut_vertices.h"

#include <algorithm>
#include <cmath>

#include "core/surface/surface.h"

namespace ctpm::render {
namespace {

constexpr std::size_t kFewestFollowed = 8;

bool holds(const std::vector<std::int32_t>& sorted, std::int32_t value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

}  // namespace

void CutVertices::clear() {
  surface_.vertex.clear(), surface_.triangle.clear(), home_.clear();
  surface_.binding.first.assign(1, 0), surface_.binding.sphere.clear(), surface_.binding.weight.clear();
  sights_.clear(), crossings_.clear();
}

const LatticeLinks::Sight& CutVertices::sight(Index sphere) {
  const auto found = sights_.find(sphere);
  return found != sights_.end() ? found->second : sights_.emplace(sphere, links_.sight_from(sphere)).first->second;
}

bool CutVertices::sees(Index sphere, Index other) { return holds(sight(sphere).seen, other); }
bool CutVertices::loses(Index sphere, Index other) { return sphere != other && holds(sight(sphere).lost, other); }

const std::vector<CutPoint>& CutVertices::crossings_around(Index sphere) {
  const auto found = crossings_.find(sphere);
  if (found != crossings_.end()) return found->second;
  std::vector<CutPoint>& all = crossings_[sphere];
  const LatticeLinks::Sight& at = sight(sphere);
  for (const Index s : at.seen)
    for (int step = 0; links_.is_cut(s) && step < LatticeLinks::kSteps; ++step) {
      if (!links_.is_severed(s, step) || !holds(at.lost, links_.neighbour(s, step))) continue;
      const Vec3 way = links_.rest(links_.neighbour(s, step)) - links_.rest(s);
      all.push_back({links_.crossing(s, step), way / norm(way)});
    }
  return all;
}

/// Appends a binding to the spheres that `home` sees around `rest`. If these do not span space, they cannot hold a
/// vertex away from them; then the reach grows until they do, or until no further sphere is seen.
void CutVertices::follow(Vec3 rest, Index home) {
  constexpr double kWiden = 1.4, kHeld = 1e-6;  // kHeld: of a spacing
  near_.clear();
  for (const Index s : sight(home).seen) near_.emplace_back(norm(links_.rest(s) - rest), s);
  const auto last_of_fewest = near_.begin() + std::ptrdiff_t(std::min(near_.size(), kFewestFollowed) - 1);
  std::nth_element(near_.begin(), last_of_fewest, near_.end());
  std::vector<Vec3> centres;
  std::vector<double> trust, weights;
  for (double reach = std::max(surface::kBindingReach * links_.spacing(), 1.05 * last_of_fewest->first);;
       reach *= kWiden) {
    // Only spheres within reach are sorted, nearest first.
    const auto known = near_.begin() + std::ptrdiff_t(centres.size());
    const auto within = std::partition(known, near_.end(), [&](const auto& n) { return n.first < reach; });
    std::sort(known, within);
    for (auto n = known; n != within; ++n)
      centres.push_back(links_.rest(n->second)), trust.push_back(links_.mass(n->second));
    weights = surface::follow_weights(rest, centres, trust, reach);
    Vec3 held = -rest;
    for (std::size_t i = 0; i < centres.size(); ++i) held += weights[i] * centres[i];
    if (norm(held) < kHeld * links_.spacing() || within == near_.end()) break;
  }
  SurfaceBinding& binding = surface_.binding;
  for (std::size_t i = 0; i < centres.size(); ++i) binding.sphere.push_back(near_[i].second);
  binding.weight.insert(binding.weight.end(), weights.begin(), weights.end());
  binding.first.push_back(Index(binding.sphere.size()));
}

CutVertices::Index CutVertices::add(Vec3 rest, Index home) {
  surface_.vertex.push_back(rest), home_.push_back(home);
  follow(rest, home);
  return count() - 1;
}

CutVertices::Index CutVertices::add(Vec3 rest, Index home, std::span<const Index> spheres,
                                    std::span<const double> weights) {
  SurfaceBinding& binding = surface_.binding;
  surface_.vertex.push_back(rest), home_.push_back(home);
  binding.sphere.insert(binding.sphere.end(), spheres.begin(), spheres.end());
  binding.weight.insert(binding.weight.end(), weights.begin(), weights.end());
  binding.first.push_back(Index(binding.sphere.size()));
  return count() - 1;
}

CutVertices::Index CutVertices::copy(Index vertex) {
  const SurfaceBinding& binding = surface_.binding;
  const std::size_t begin = std::size_t(binding.first[std::size_t(vertex)]),
                    end = std::size_t(binding.first[std::size_t(vertex) + 1]);
  const std::vector<Index> spheres(binding.sphere.begin() + std::ptrdiff_t(begin),
                                   binding.sphere.begin() + std::ptrdiff_t(end));
  const std::vector<double> weights(binding.weight.begin() + std::ptrdiff_t(begin),
                                    binding.weight.begin() + std::ptrdiff_t(end));
  return add(rest(vertex), home(vertex), spheres, weights);
}

}  // namespace ctpm::render
