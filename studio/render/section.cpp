#include "studio/render/section.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/surface/surface.h"
#include "studio/render/cut_surface.h"
#include "studio/render/noise.h"
#include "studio/render/organ_mesh.h"

namespace ctpm::render {
namespace {

Vec3 unit(Vec3 v) { return v / norm(v); }

/// Where the plane cuts a triangle: two points, or none.
struct Crossing {
  std::array<Vec3, 2> point;
  std::size_t count = 0;

  Crossing(const std::array<std::int32_t, 3>& triangle, const std::vector<Vec3>& position,
           const std::vector<double>& above) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = std::size_t(triangle[i]), b = std::size_t(triangle[(i + 1) % 3]);
      if ((above[a] > 0) == (above[b] > 0) || count == 2) continue;
      point[count++] = position[a] + above[a] / (above[a] - above[b]) * (position[b] - position[a]);
    }
  }
};

}  // namespace

/// Squares on the plane, which stand still in the world while the organ moves through them.
struct Section::Net {
  Vec3 origin, normal, u, v;  ///< unit vectors
  double step = 0;            ///< [m]
  int left = 0, right = -1, low = 0, high = -1;

  void add(Vec3 p) {
    const int column = int(std::floor(dot(p - origin, u) / step)), row = int(std::floor(dot(p - origin, v) / step));
    if (right < left) left = right = column, low = high = row;
    left = std::min(left, column), right = std::max(right, column);
    low = std::min(low, row), high = std::max(high, row);
  }
};

Section::Section(const Model& model, const cutting::RestMap& map, std::size_t organ)
    : model_(model), map_(map), organ_(organ) {}

std::uint32_t Section::add_vertex(Vec3 p, Vec3 n, Vec3 rest, float hollow, float rind) {
  const float stain = float(noise_at(kStainsPerMetre * rest));
  for (const double x : {p.x, p.y, p.z, n.x, n.y, n.z, rest.x, rest.y, rest.z}) vertex_.push_back(float(x));
  for (const float x : {hollow, stain, 0.0f, rind}) vertex_.push_back(x);
  return std::uint32_t(vertex_.size() / kOrganVertexFloats - 1);
}

/// As in the walls of cuts.
float Section::rind_at(Vec3 rest) const {
  const OrganRange& organ = model_.organs[organ_];
  if (organ.layer_count < 2) return 0;
  cutting::Place place;
  map_.find(organ_, rest, surface::kBindingReach * organ.spacing, place);
  double layer = 0;
  for (std::size_t i = 0; i < std::size_t(place.count); ++i)
    layer += place.weight[i] * model_.layer[std::size_t(place.sphere[i])];
  return place.count > 0 ? rind_of_layer(layer) : 0;
}

void Section::add_net(const State& state, const Net& net) {
  const double reach = surface::kBindingReach * model_.organs[organ_].spacing;
  for (int row = net.low; row <= net.high + 1; ++row)
    for (int column = net.left; column <= net.right + 1; ++column) {
      const Vec3 p = net.origin + net.step * (column * net.u + row * net.v);
      const Vec3 rest = map_.rest_of(organ_, state.position, p, reach);
      add_vertex(p, net.normal, rest, 0, rind_at(rest));
    }
  const int columns = net.right - net.left + 2;
  for (int row = 0; row <= net.high - net.low; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = std::uint32_t(row * columns + column), b = a + std::uint32_t(columns);
      index_.insert(index_.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
}

/// Ribbons a little above the net, dark as the bottom of a fold.
void Section::add_lines(const Net& net, const Surface& surface, std::size_t outer_count,
                        const std::vector<Vec3>& position, double width) {
  constexpr float kDark = -1;
  for (std::size_t t = outer_count; t < surface.triangle.size(); ++t) {
    const Crossing crossing(surface.triangle[t], position, above_);
    if (crossing.count < 2) continue;
    const Vec3 way = crossing.point[1] - crossing.point[0];
    if (!(norm(way) > 0)) continue;
    const Vec3 rest = surface.vertex[std::size_t(surface.triangle[t][0])];
    const Vec3 along = 0.5 * width * unit(way), side = cross(net.normal, along), lift = 0.2 * width * net.normal;
    std::array<std::uint32_t, 4> corner;
    for (std::size_t i = 0; i < 4; ++i)
      corner[i] = add_vertex(crossing.point[i / 2] + lift + (i / 2 ? 1 : -1) * along + (i % 2 ? 1 : -1) * side,
                             net.normal, rest, kDark, 0);
    index_.insert(index_.end(), {corner[0], corner[2], corner[1], corner[1], corner[2], corner[3]});
  }
}

void Section::update(const State& state, const Cutaway& cutaway, const Surface& surface, std::size_t outer_count,
                     const std::vector<Vec3>& position, double line_width) {
  constexpr double kNetStep = 0.5;  // in spacings: finer than the lattice can bend
  vertex_.clear(), index_.clear();
  above_.resize(position.size());
  for (std::size_t v = 0; v < position.size(); ++v) above_[v] = dot(position[v] - cutaway.point, cutaway.normal);
  Net net;
  net.origin = cutaway.point, net.normal = cutaway.normal, net.step = kNetStep * model_.organs[organ_].spacing;
  net.u = unit(cross(std::abs(net.normal.x) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, net.normal));
  net.v = cross(net.normal, net.u);
  for (std::size_t t = 0; t < outer_count; ++t) {
    const Crossing crossing(surface.triangle[t], position, above_);
    for (std::size_t i = 0; i < crossing.count; ++i) net.add(crossing.point[i]);
  }
  if (net.right < net.left) return;
  add_net(state, net);
  add_lines(net, surface, outer_count, position, line_width);
}

}  // namespace ctpm::render
