#include "core/cutting/cutting.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/cutting/blade_geometry.h"

namespace ctpm::cutting {
namespace {

/// Severs the constraints and angle springs that have lost an element, and returns their number.
template <class Lines>
std::int32_t sever_lines(const Lines& lines, const std::vector<std::uint8_t>& axial_severed,
                         std::vector<std::uint8_t>& severed) {
  std::int32_t count = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool lost =
        std::any_of(std::begin(lines.edge), std::end(lines.edge),
                    [&](const std::vector<std::int32_t>& edge) { return axial_severed[std::size_t(edge[i])] != 0; });
    if (lost && !severed[i]) severed[i] = 1, ++count;
  }
  return count;
}

/// What the front sweeps between two nodes.
struct Sweep {
  Vec3 from, to, from2, to2;
  Box box{Vec3{}};
};

/// Where the element p-q crosses one of the sweeps, from 0 at p to 1 at q. `around`: box of all of them.
std::optional<double> crossing(std::span<const Sweep> sweeps, const Box& around, Vec3 p, Vec3 q) {
  const Box box(p, q);
  if (!around.meets(box)) return std::nullopt;
  for (const Sweep& s : sweeps) {
    if (!s.box.meets(box)) continue;
    if (const auto hit = meet_sweep(p, q, s.from, s.to, s.from2, s.to2)) return hit->along;
  }
  return std::nullopt;
}

/// How far inside the tissue of a sphere at the boundary is taken to be, in spacings.
constexpr double kInside = 0.1;

/// The place under a surface of which `nearest` is nearest to a point outside [m].
Vec3 under_surface(Vec3 point, Vec3 nearest, double spacing) {
  const double distance = norm(nearest - point);
  return distance > 0 ? nearest + kInside * spacing / distance * (nearest - point) : nearest;
}

/// A sphere's place, moved inside where it has no neighbours on one side [m].
Vec3 towards_neighbours(const Model& model, const RestElements& elements, std::size_t sphere) {
  Vec3 sum;
  for (const std::int32_t e : elements.of(sphere)) {
    const Vec3 a = model.rest_position[std::size_t(model.axial.a[std::size_t(e)])],
               b = model.rest_position[std::size_t(model.axial.b[std::size_t(e)])];
    sum += std::size_t(model.axial.a[std::size_t(e)]) == sphere ? b - a : a - b;
  }
  const auto count = double(elements.of(sphere).size());
  return model.rest_position[sphere] + (count > 0 ? kInside / count : 0.0) * sum;
}

}  // namespace

BladeEdge blade_edge(const Tool& scalpel, const Hand& hand) {
  // The blade cuts towards x of the tool. Its point is ground at 45 degrees, as that of a blade No. 11 about is.
  const double height = std::min(scalpel.flank_height, scalpel.blade_length);
  return {hand.position, hand.position + rotate(hand.world_from_tool, {0, 0, scalpel.blade_length}),
          hand.position + rotate(hand.world_from_tool, {-height, 0, height})};
}

Vec3 at_node(const BladeEdge& edge, std::size_t node) {
  if (node < kPointNodes) return edge.back + double(node) / double(kPointNodes) * (edge.tip - edge.back);
  return edge.tip + double(node - kPointNodes) / double(kEdgeNodes - 1 - kPointNodes) * (edge.heel - edge.tip);
}

std::uint8_t stored_crossing(double along) {
  return std::uint8_t(1 + int(std::clamp(along, 0.0, 1.0) / kCrossingUnit + 0.5));
}

double crossing_of(std::uint8_t stored) { return stored == 0 ? 0.5 : (stored - 1) * kCrossingUnit; }

RestElements::RestElements(const Model& model)
    : first_(model.sphere_count() + 1, 0), elements_(2 * model.axial.size()) {
  const AxialElements& axial = model.axial;
  for (std::size_t e = 0; e < axial.size(); ++e)
    ++first_[std::size_t(axial.a[e]) + 1], ++first_[std::size_t(axial.b[e]) + 1];
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t e = 0; e < axial.size(); ++e)
    for (const std::int32_t sphere : {axial.a[e], axial.b[e]})
      elements_[std::size_t(next[std::size_t(sphere)]++)] = std::int32_t(e);
  for (std::size_t i = 0; i < model.sphere_count(); ++i) place_.push_back(model.rest_position[i]);
  find_longest(axial);
}

RestElements::RestElements(const Model& model, const TissueDepth& depth, std::optional<std::size_t> only)
    : RestElements(model) {
  for (std::size_t o = 0; o < model.organs.size(); ++o) {
    if (only.value_or(o) != o) continue;
    const OrganRange& organ = model.organs[o];
    const bool has_surface = o < model.surfaces.size() && !model.surfaces[o].triangle.empty();
    for (auto i = std::size_t(organ.first); i < std::size_t(organ.first + organ.count); ++i) {
      const Vec3 centre = model.rest_position[i];
      if (!has_surface)
        place_[i] = towards_neighbours(model, *this, i);
      else if (!(depth.at(o, centre) > 0))
        place_[i] = under_surface(centre, depth.nearest_on_surface(o, centre), organ.spacing);
    }
  }
  find_longest(model.axial);
}

void RestElements::find_longest(const AxialElements& axial) {
  constexpr double kRounding = 1 + 1e-9;
  longest_ = 0;
  for (std::size_t e = 0; e < axial.size(); ++e)
    longest_ = std::max(longest_, kRounding * norm(place(std::size_t(axial.b[e])) - place(std::size_t(axial.a[e]))));
}

void find_severed(const Model& model, const RestElements& elements, std::size_t organ, const Front& from,
                  const Front& to, const NewlySwept& newly, std::vector<std::uint8_t>& severed,
                  std::vector<Crossing>& crossings) {
  std::array<Sweep, kEdgeNodes - 1> all;
  std::size_t count = 0;
  std::optional<Box> around;
  for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
    if (newly[n] != organ + 1) continue;
    if (from[n] == to[n] && from[n + 1] == to[n + 1]) continue;
    const Box box(from[n], from[n + 1], to[n], to[n + 1]);
    all[count++] = {from[n], from[n + 1], to[n], to[n + 1], box};
    if (around) around->add(box.low), around->add(box.high);
    if (!around) around = box;
  }
  if (count == 0) return;
  const std::span<const Sweep> sweeps(all.data(), count);
  const OrganRange& range = model.organs[organ];
  const Box near = around->grown(elements.longest());
  const auto first = std::size_t(range.first), last = first + std::size_t(range.count);
  for (std::size_t i = first; i < last; ++i) {
    const Vec3 p = elements.place(i);
    if (!near.meets(Box(p))) continue;
    for (const std::int32_t element : elements.of(i)) {
      const auto e = std::size_t(element);
      if (severed[e] != 0 || model.axial.a[e] != std::int32_t(i)) continue;
      const std::optional<double> along = crossing(sweeps, *around, p, elements.place(std::size_t(model.axial.b[e])));
      if (along) severed[e] = 1, crossings.push_back({element, *along});
    }
  }
}

std::int32_t sever_swept(const Model& model, const RestElements& elements, const Front& from, const Front& to,
                         const NewlySwept& newly, State& state, std::vector<Crossing>& crossings) {
  const std::size_t before = crossings.size();
  for (std::size_t organ = 0; organ < model.organs.size(); ++organ)
    find_severed(model, elements, organ, from, to, newly, state.axial_severed, crossings);
  if (crossings.size() == before) return 0;
  if (!state.axial_crossing.empty())
    for (std::size_t c = before; c < crossings.size(); ++c)
      state.axial_crossing[std::size_t(crossings[c].element)] = stored_crossing(crossings[c].along);
  auto severed = std::int32_t(crossings.size() - before);
  severed += sever_lines(model.constraints, state.axial_severed, state.constraint_severed);
  severed += sever_lines(model.angle_springs, state.axial_severed, state.angle_severed);
  return severed;
}

}  // namespace ctpm::cutting
