#include "core/cutting/cutting.h"

#include <algorithm>

#include "core/cutting/blade_geometry.h"

namespace ctpm::cutting {
namespace {

/// Severs the unsevered elements among those `near` for which `meet(a, b)` finds a crossing, then the constraints and
/// angle springs that have lost an element.
template <class Meet>
std::int32_t sever(const Model& model, const NearElements& near, State& state, std::vector<Crossing>& crossings,
                   Meet&& meet) {
  std::int32_t count = 0;
  const AxialElements& axial = model.axial;
  for (const std::int32_t element : near.elements()) {
    const auto i = std::size_t(element);
    if (state.axial_severed[i]) continue;
    std::optional<Crossing> crossed = meet(std::size_t(axial.a[i]), std::size_t(axial.b[i]));
    if (!crossed) continue;
    state.axial_severed[i] = 1, ++count;
    if (!state.axial_crossing.empty()) state.axial_crossing[i] = stored_crossing(crossed->along);
    crossed->element = element;
    crossings.push_back(*crossed);
  }
  if (count == 0) return 0;
  const auto sever_lines = [&](const auto& lines, std::vector<std::uint8_t>& severed) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool lost = std::any_of(
          std::begin(lines.edge), std::end(lines.edge),
          [&](const std::vector<std::int32_t>& edge) { return state.axial_severed[std::size_t(edge[i])] != 0; });
      if (lost && !severed[i]) severed[i] = 1, ++count;
    }
  };
  sever_lines(model.constraints, state.constraint_severed);
  sever_lines(model.angle_springs, state.angle_severed);
  return count;
}

}  // namespace

BladeEdge blade_edge(const Tool& scalpel, const Inputs& inputs) {
  return {inputs.position, inputs.position + rotate(inputs.world_from_tool, {0, 0, scalpel.blade_length})};
}

std::uint8_t stored_crossing(double along) {
  return std::uint8_t(1 + int(std::clamp(along, 0.0, 1.0) / kCrossingUnit + 0.5));
}

double crossing_of(std::uint8_t stored) { return stored == 0 ? 0.5 : (stored - 1) * kCrossingUnit; }

std::int32_t sever_swept_by_blade(const Model& model, const NearElements& near, const BladeEdge& before,
                                  const BladeEdge& after, const Vec3Array& position, State& state,
                                  std::vector<Crossing>& crossings) {
  const Box sweep(before.tip, before.heel, after.tip, after.heel);
  return sever(model, near, state, crossings, [&](std::size_t a, std::size_t b) -> std::optional<Crossing> {
    const Vec3 p = position[a], q = position[b];
    if (!sweep.meets(Box(p, q))) return std::nullopt;
    const auto hit = meet_sweep(p, q, before.tip, before.heel, after.tip, after.heel);
    if (!hit) return std::nullopt;
    return Crossing{-1, hit->along, hit->across, hit->share};
  });
}

std::int32_t sever_moved_through_blade(const Model& model, const NearElements& near, const BladeEdge& blade,
                                       const Vec3Array& from, const Vec3Array& to, State& state,
                                       std::vector<Crossing>& crossings) {
  const Box edge(blade.tip, blade.heel);
  return sever(model, near, state, crossings, [&](std::size_t a, std::size_t b) -> std::optional<Crossing> {
    if (!edge.meets(Box(from[a], from[b], to[a], to[b]))) return std::nullopt;
    const auto hit = meet_sweep(blade.tip, blade.heel, from[a], from[b], to[a], to[b]);
    if (!hit) return std::nullopt;
    return Crossing{-1, hit->across, hit->along, hit->share};
  });
}

}  // namespace ctpm::cutting
