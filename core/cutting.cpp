#include "core/cutting.h"

#include <algorithm>
#include <cmath>

namespace ctpm {
namespace {

/// Six times the signed volume of the tetrahedron a b c d.
double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return dot(b - a, cross(c - a, d - a)); }

/// Does the segment p-q meet the triangle a b c? Touching an edge or corner counts; a segment in the plane
/// does not.
bool segment_meets_triangle(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const double side_p = volume(p, a, b, c), side_q = volume(q, a, b, c);
  if ((side_p > 0) == (side_q > 0) && side_p != 0 && side_q != 0) return false;
  if (side_p == 0 && side_q == 0) return false;
  const double ab = volume(p, q, a, b), bc = volume(p, q, b, c), ca = volume(p, q, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

/// Does segment p-q meet what the segment from-to sweeps while it moves to from2-to2?
bool segment_meets_sweep(Vec3 p, Vec3 q, Vec3 from, Vec3 to, Vec3 from2, Vec3 to2) {
  return segment_meets_triangle(p, q, from, to, from2) || segment_meets_triangle(p, q, to, to2, from2);
}

struct Box {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  void add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool meets(const Box& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y &&
           low.z <= other.high.z && other.low.z <= high.z;
  }
};

template <class... Points>
Box box_of(Points... points) {
  Box box;
  (box.add(points), ...);
  return box;
}

/// Severs the live elements for which `crosses(a, b)` holds, then the constraints and angle springs that lost
/// an edge.
template <class Crosses>
std::int32_t sever(const Model& model, State& state, Crosses&& crosses) {
  std::int32_t count = 0;
  const auto sever_axial = [&](const auto& elements, std::vector<std::uint8_t>& severed) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (!severed[i] && crosses(std::size_t(elements.a[i]), std::size_t(elements.b[i])))
        severed[i] = 1, ++count;
  };
  sever_axial(model.edges, state.edge_severed);
  sever_axial(model.tpms, state.tpm_severed);
  if (count == 0) return 0;
  const auto sever_lines = [&](const auto& lines, std::vector<std::uint8_t>& severed) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool lost = std::any_of(std::begin(lines.edge), std::end(lines.edge),
                                    [&](const std::vector<std::int32_t>& edge) {
                                      return state.edge_severed[std::size_t(edge[i])] != 0;
                                    });
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

std::int32_t sever_swept_by_blade(const Model& model, const BladeEdge& before, const BladeEdge& after,
                                  const Vec3Array& position, State& state) {
  const Box sweep = box_of(before.tip, before.heel, after.tip, after.heel);
  return sever(model, state, [&](std::size_t a, std::size_t b) {
    const Vec3 p = position[a], q = position[b];
    return sweep.meets(box_of(p, q)) &&
           segment_meets_sweep(p, q, before.tip, before.heel, after.tip, after.heel);
  });
}

std::int32_t sever_moved_through_blade(const Model& model, const BladeEdge& blade, const Vec3Array& from,
                                       const Vec3Array& to, State& state) {
  const Box edge = box_of(blade.tip, blade.heel);
  return sever(model, state, [&](std::size_t a, std::size_t b) {
    return edge.meets(box_of(from[a], from[b], to[a], to[b])) &&
           segment_meets_sweep(blade.tip, blade.heel, from[a], from[b], to[a], to[b]);
  });
}

}  // namespace ctpm
