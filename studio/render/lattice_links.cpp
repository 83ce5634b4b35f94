#include "studio/render/lattice_links.h"

#include <algorithm>
#include <cmath>

#include "core/cutting/cutting.h"
#include "core/model/result.h"

namespace ctpm::render {
namespace {

/// Length of the longest element between lattice neighbours; angle springs are longer.
constexpr double kLongestLinkInSpacings = 1.6;

/// Part of the heaviest sphere's mass from which a sphere counts as inside: one on a flat surface has half.
constexpr double kInsideShare = 0.45;

int step_back(int step) {
  const auto& steps = LatticeLinks::steps();
  const auto& s = steps[std::size_t(step)];
  const LatticeLinks::Cell back{-s[0], -s[1], -s[2]};
  return int(std::find(steps.begin(), steps.end(), back) - steps.begin());
}

}  // namespace

const std::array<LatticeLinks::Cell, LatticeLinks::kSteps>& LatticeLinks::steps() {
  static const std::array<Cell, kSteps> all{{{1, 0, 0},
                                             {-1, 0, 0},
                                             {0, 1, 0},
                                             {0, -1, 0},
                                             {0, 0, 1},
                                             {0, 0, -1},
                                             {1, 1, 0},
                                             {-1, -1, 0},
                                             {1, -1, 0},
                                             {-1, 1, 0},
                                             {1, 0, 1},
                                             {-1, 0, -1},
                                             {1, 0, -1},
                                             {-1, 0, 1},
                                             {0, 1, 1},
                                             {0, -1, -1},
                                             {0, 1, -1},
                                             {0, -1, 1}}};
  return all;
}

LatticeLinks::LatticeLinks(const Model& model, std::size_t organ) {
  const OrganRange& range = model.organs[organ];
  first_ = range.first, spacing_ = range.spacing;
  for (std::int32_t i = first_; i < first_ + range.count; ++i)
    rest_.push_back(model.rest_position[std::size_t(i)]), cell_.push_back(model.cell[std::size_t(i)]),
        mass_.push_back(model.mass[std::size_t(i)]);
  for (const double mass : mass_) inside_mass_ = std::max(inside_mass_, kInsideShare * mass);
  build_table();
  find_axes();

  // Neighbours, and the elements that join them.
  neighbour_.assign(rest_.size() * kSteps, -1), link_.assign(rest_.size() * kSteps, Link::none);
  crossing_.assign(rest_.size() * kSteps, 0.5f);
  for (std::int32_t i = 0; i < count(); ++i)
    for (int s = 0; s < kSteps; ++s) {
      const Cell c = cell(i), d = steps()[std::size_t(s)];
      neighbour_[index(i, s)] = at({c[0] + d[0], c[1] + d[1], c[2] + d[2]});
    }
  for (std::size_t e = 0; e < model.axial.size(); ++e) add_element(model.axial.a[e], model.axial.b[e], std::int32_t(e));
  severed_.assign(elements_.size(), 0), passed_.assign(elements_.size(), 0), cut_.assign(rest_.size(), 0);
}

/// Builds the dense table from cell to sphere.
void LatticeLinks::build_table() {
  Cell high{};
  for (std::size_t i = 0; i < cell_.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      low_[c] = i ? std::min(low_[c], cell_[i][c]) : cell_[i][c];
      high[c] = i ? std::max(high[c], cell_[i][c]) : cell_[i][c];
    }
  for (std::size_t c = 0; c < 3; ++c) extent_[c] = high[c] - low_[c] + 1;
  sphere_at_.assign(std::size_t(extent_[0]) * std::size_t(extent_[1]) * std::size_t(extent_[2]), -1);
  for (std::size_t i = 0; i < cell_.size(); ++i)
    sphere_at_[std::size_t(((cell_[i][2] - low_[2]) * extent_[1] + cell_[i][1] - low_[1]) * extent_[0] + cell_[i][0] -
                           low_[0])] = std::int32_t(i);
}

/// Takes each axis from the first two spheres that are neighbours along it. Where an organ is one sphere thick there
/// are none, and the axis is perpendicular to the others.
void LatticeLinks::find_axes() {
  bool found[3] = {};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::int32_t i = 0; i < count() && !found[c]; ++i) {
      Cell next = cell(i);
      ++next[c];
      const std::int32_t neighbour = at(next);
      const Vec3 d = neighbour < 0 ? Vec3{} : rest(neighbour) - rest(i);
      if (norm(d) > 0) axis_[c] = spacing_ / norm(d) * d, found[c] = true;
    }
  if (!found[0] && !found[1] && !found[2]) axis_[0] = {spacing_, 0, 0}, found[0] = true;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t next = (c + 1) % 3, last = (c + 2) % 3;
    if (!found[c] || found[next] || found[last]) continue;
    const Vec3 beside = std::abs(axis_[c].x) < 0.9 * spacing_ ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 across = cross(axis_[c], beside);
    axis_[next] = spacing_ / norm(across) * across, found[next] = true;
  }
  for (std::size_t c = 0; c < 3; ++c)
    if (!found[c]) axis_[c] = cross(axis_[(c + 1) % 3], axis_[(c + 2) % 3]) / spacing_;
  // The cell (0, 0, 0) is that of the organ's first sphere.
  if (count() > 0) origin_ = rest(0);
}

void LatticeLinks::add_element(std::int32_t a, std::int32_t b, std::int32_t source) {
  a -= first_, b -= first_;
  if (a < 0 || a >= count() || b < 0 || b >= count() || norm(rest(b) - rest(a)) > kLongestLinkInSpacings * spacing_)
    return;
  for (int s = 0; s < kSteps; ++s)
    if (neighbour(a, s) == b) {
      elements_.push_back({a, s, source});
      link_[index(a, s)] = link_[index(b, step_back(s))] = Link::joined;
      has_diagonals_ = has_diagonals_ || s >= 6;
    }
}

std::int32_t LatticeLinks::at(Cell cell) const {
  for (std::size_t c = 0; c < 3; ++c)
    if (cell[c] < low_[c] || cell[c] >= low_[c] + extent_[c]) return -1;
  return sphere_at_[std::size_t(((cell[2] - low_[2]) * extent_[1] + cell[1] - low_[1]) * extent_[0] + cell[0] -
                                low_[0])];
}

bool LatticeLinks::update(const State& state) {
  bool changed = false;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const auto source = std::size_t(elements_[e].source);
    const bool severed = source < state.axial_severed.size() && state.axial_severed[source] != 0;
    const bool has_crossing = severed && source < state.axial_crossing.size();
    const std::uint8_t passed = has_crossing ? state.axial_crossing[source] : std::uint8_t(0);
    changed = changed || severed != (severed_[e] != 0) || passed != passed_[e];
    severed_[e] = severed, passed_[e] = passed;
  }
  if (!changed) return false;
  std::fill(cut_.begin(), cut_.end(), std::uint8_t(0));
  anything_cut_ = false;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const auto [a, s, source] = elements_[e];
    const std::int32_t b = neighbour(a, s);
    link_[index(a, s)] = link_[index(b, step_back(s))] = severed_[e] ? Link::severed : Link::joined;
    const double along = cutting::crossing_of(passed_[e]);
    crossing_[index(a, s)] = float(along), crossing_[index(b, step_back(s))] = float(1 - along);
    if (severed_[e]) cut_[std::size_t(a)] = cut_[std::size_t(b)] = 1, anything_cut_ = true;
  }
  return true;
}

std::vector<std::array<std::int32_t, 2>> LatticeLinks::hops_from(std::int32_t home, bool over_severed) const {
  // Reaches every sphere to which a surface vertex near `home` may be bound.
  const std::int32_t farthest = has_diagonals_ ? 4 : 6;
  std::vector<std::array<std::int32_t, 2>> reached{{home, 0}};
  std::vector<std::uint8_t> seen(rest_.size(), 0);
  seen[std::size_t(home)] = 1;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const auto [sphere, hops] = reached[next];
    if (hops == farthest) break;
    for (int s = 0; s < kSteps; ++s) {
      const std::int32_t other = neighbour(sphere, s);
      const Link link = link_[index(sphere, s)];
      if (link == Link::none || (link == Link::severed && !over_severed) || seen[std::size_t(other)]) continue;
      seen[std::size_t(other)] = 1;
      reached.push_back({other, hops + 1});
    }
  }
  std::sort(reached.begin(), reached.end());
  return reached;
}

LatticeLinks::Sight LatticeLinks::sight_from(std::int32_t home) const {
  const auto before = hops_from(home, true), now = hops_from(home, false);
  Sight sight;
  std::size_t n = 0;
  for (const auto& [sphere, hops] : before) {
    while (n < now.size() && now[n][0] < sphere) ++n;
    const bool sees = n < now.size() && now[n][0] == sphere && now[n][1] == hops;
    (sees ? sight.seen : sight.lost).push_back(sphere);
  }
  return sight;
}

}  // namespace ctpm::render
