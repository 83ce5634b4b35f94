#include "importers/label_surface.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ctpm::importers {
namespace {

using Size = std::array<std::int32_t, 3>;

/// A compact label is this many cells across; measured: finer cells change volume and shape by less than spheres can
/// show.
constexpr double kCellsAcross = 40;
constexpr double kVolumeBound = 1e-3;
constexpr int kMostRounds = 12;  // of halving the level

/// A number for each point of a lattice.
struct Field {
  Size size{};
  std::array<Vec3, 3> step{};  ///< [mm]
  Vec3 origin;                 ///< of point 0, 0, 0 [mm]
  std::vector<float> value;    ///< i fastest

  std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) + std::size_t(i);
  }
  Vec3 at(double i, double j, double k) const { return origin + i * step[0] + j * step[1] + k * step[2]; }
};

struct Box {
  Size least, most;  ///< both belong to it
};

Box box_of(const LabelMap& map, const Label& label) {
  Box box{map.size, {-1, -1, -1}};
  std::size_t n = std::size_t(label.layer);
  for (std::int32_t k = 0; k < map.size[2]; ++k)
    for (std::int32_t j = 0; j < map.size[1]; ++j)
      for (std::int32_t i = 0; i < map.size[0]; ++i, n += std::size_t(map.layers)) {
        if (map.value[n] != label.number) continue;
        const Size at{i, j, k};
        for (std::size_t d = 0; d < 3; ++d)
          box.least[d] = std::min(box.least[d], at[d]), box.most[d] = std::max(box.most[d], at[d]);
      }
  return box;
}

/// Voxels along each axis that become one cell, so that cells are as even as the label needs.
Size join_of(const LabelMap& map, const Label& label) {
  constexpr double kCubicMillimetre = 1e-9;  // [m^3]
  const double wanted = std::cbrt(label.volume / kCubicMillimetre) / kCellsAcross;
  Size join;
  for (std::size_t d = 0; d < 3; ++d) join[d] = std::max(1, std::int32_t(std::lround(wanted / norm(map.step[d]))));
  return join;
}

/// Steps of `cells` around the label that hold nothing: as far as smoothing reaches, and one more.
constexpr std::int32_t kReach = 3;
constexpr std::int32_t kMargin = 2 * kReach + 1;

/// The label's share of each cell.
Field shares_of(const LabelMap& map, const Label& label) {
  const Box box = box_of(map, label);
  const Size join = join_of(map, label);
  Field field;
  for (std::size_t d = 0; d < 3; ++d) {
    field.size[d] = (box.most[d] - box.least[d]) / join[d] + 1 + 2 * kMargin;
    field.step[d] = double(join[d]) * map.step[d];
  }
  field.value.assign(std::size_t(field.size[0]) * std::size_t(field.size[1]) * std::size_t(field.size[2]), 0.0f);
  field.origin = map.origin;
  for (std::size_t d = 0; d < 3; ++d)
    field.origin = field.origin + (box.least[d] + 0.5 * (join[d] - 1) - double(kMargin) * join[d]) * map.step[d];
  const float part = 1.0f / float(join[0] * join[1] * join[2]);
  for (std::int32_t k = box.least[2]; k <= box.most[2]; ++k)
    for (std::int32_t j = box.least[1]; j <= box.most[1]; ++j)
      for (std::int32_t i = box.least[0]; i <= box.most[0]; ++i) {
        const std::size_t voxel =
            (std::size_t(k) * std::size_t(map.size[1]) + std::size_t(j)) * std::size_t(map.size[0]) + std::size_t(i);
        if (map.value[voxel * std::size_t(map.layers) + std::size_t(label.layer)] != label.number) continue;
        field.value[field.index((i - box.least[0]) / join[0] + kMargin, (j - box.least[1]) / join[1] + kMargin,
                                (k - box.least[2]) / join[2] + kMargin)] += part;
      }
  return field;
}

/// Smooths along one axis with a Gaussian of `sigma` cells.
void smooth_along(Field& field, std::size_t axis, double sigma) {
  const std::int32_t reach = std::min(2 * kReach, std::int32_t(std::ceil(2.5 * sigma)));
  std::vector<float> weight;
  for (std::int32_t r = 0; r <= reach; ++r) weight.push_back(float(std::exp(-0.5 * r * r / (sigma * sigma))));
  float sum = weight[0];
  for (std::int32_t r = 1; r <= reach; ++r) sum += 2 * weight[std::size_t(r)];
  for (float& w : weight) w /= sum;
  const Size n = field.size;
  const std::size_t stride = axis == 0 ? 1 : axis == 1 ? std::size_t(n[0]) : std::size_t(n[0]) * std::size_t(n[1]);
  std::vector<float> line(static_cast<std::size_t>(n[axis]));
  const std::size_t a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  for (std::int32_t q = 0; q < n[b]; ++q)
    for (std::int32_t p = 0; p < n[a]; ++p) {
      Size at{};
      at[a] = p, at[b] = q;
      float* const first = &field.value[field.index(at[0], at[1], at[2])];
      for (std::size_t i = 0; i < line.size(); ++i) line[i] = first[i * stride];
      for (std::int32_t i = 0; i < n[axis]; ++i) {
        float value = weight[0] * line[std::size_t(i)];
        for (std::int32_t r = 1; r <= reach; ++r) {
          if (i >= r) value += weight[std::size_t(r)] * line[std::size_t(i - r)];
          if (i + r < n[axis]) value += weight[std::size_t(r)] * line[std::size_t(i + r)];
        }
        first[std::size_t(i) * stride] = value;
      }
    }
}

/// Smooths by a voxel, and across thick slices by as much along them as steps of that height need.
void smooth(Field& field) {
  constexpr double kLeast = 0.8, kMost = 2.4;  // [cells]
  const double widest = std::max({norm(field.step[0]), norm(field.step[1]), norm(field.step[2])});
  for (std::size_t d = 0; d < 3; ++d)
    smooth_along(field, d, std::clamp(0.5 * widest / norm(field.step[d]), kLeast, kMost));
}

/// The surface where the field has the value `level`, from the six tetrahedra of each cell about its long diagonal.
class Marching {
 public:
  Marching(const Field& field, float level) : field_(field), level_(level) {
    is_mirrored_ = dot(field.step[0], cross(field.step[1], field.step[2])) < 0;
    for (std::int32_t k = 0; k + 1 < field.size[2]; ++k)
      for (std::int32_t j = 0; j + 1 < field.size[1]; ++j)
        for (std::int32_t i = 0; i + 1 < field.size[0]; ++i) march(i, j, k);
  }
  Soup take() { return std::move(soup_); }

 private:
  struct Corner {
    std::size_t index;
    Size place;
    float value;
  };

  void march(std::int32_t i, std::int32_t j, std::int32_t k) {
    std::array<Corner, 8> corner;
    int inside = 0;
    for (std::int32_t c = 0; c < 8; ++c) {
      const Size place{i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)};
      const std::size_t index = field_.index(place[0], place[1], place[2]);
      corner[std::size_t(c)] = {index, place, field_.value[index]};
      inside += field_.value[index] > level_;
    }
    if (inside == 0 || inside == 8) return;
    // Ways from corner 0 to corner 7 along edges; each gives a positively oriented tetrahedron.
    constexpr std::size_t kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                               {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    for (const auto& t : kTetrahedra) cut({&corner[t[0]], &corner[t[1]], &corner[t[2]], &corner[t[3]]});
  }

  /// One or two triangles of a tetrahedron, seen from where the field is lower.
  void cut(std::array<const Corner*, 4> t) {
    std::array<std::size_t, 4> high{}, low{};
    std::size_t highs = 0, lows = 0;
    for (std::size_t c = 0; c < 4; ++c) (t[c]->value > level_ ? high[highs++] : low[lows++]) = c;
    if (highs == 0 || lows == 0) return;
    // An even order of (high, low) keeps the orientation of the tetrahedron.
    std::array<std::size_t, 4> order{};
    for (std::size_t c = 0; c < 4; ++c) order[c] = c < highs ? high[c] : low[c - highs];
    int swaps = 0;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) swaps += order[a] > order[b];
    const bool is_odd = (swaps % 2 == 1) != is_mirrored_;
    const auto edge = [&](std::size_t a, std::size_t b) { return vertex_on(*t[order[a]], *t[order[b]]); };
    if (highs == 1) add(edge(0, 1), edge(0, 2), edge(0, 3), is_odd);
    if (highs == 3) add(edge(0, 3), edge(1, 3), edge(2, 3), is_odd);
    if (highs == 2) {
      const std::int32_t a = edge(0, 2), b = edge(0, 3), c = edge(1, 3), d = edge(1, 2);
      add(a, b, c, is_odd), add(a, c, d, is_odd);
    }
  }

  void add(std::int32_t a, std::int32_t b, std::int32_t c, bool is_odd) {
    soup_.triangle.push_back(is_odd ? Triangle{a, c, b} : Triangle{a, b, c});
  }

  std::int32_t vertex_on(const Corner& p, const Corner& q) {
    const auto& [least, most] = std::minmax(p.index, q.index);
    const auto [found, is_new] =
        known_.try_emplace(std::uint64_t(least) << 32 | most, std::int32_t(soup_.vertex.size()));
    if (is_new) {
      // Away from the ends, so that no triangle is a needle.
      const double share = std::clamp(double(level_ - p.value) / double(q.value - p.value), 0.05, 0.95);
      const auto along = [&](std::size_t d) { return p.place[d] + share * (q.place[d] - p.place[d]); };
      soup_.vertex.push_back(field_.at(along(0), along(1), along(2)));
    }
    return found->second;
  }

  const Field& field_;
  float level_;
  bool is_mirrored_ = false;
  Soup soup_;
  std::unordered_map<std::uint64_t, std::int32_t> known_;  ///< vertex of an edge, by its ends
};

/// Evens out what is left of the lattice in a closed surface, without shrinking it: each round moves every vertex to
/// the mean of its neighbours and then away again (Taubin, "A signal processing approach to fair surface design",
/// 1995).
void even_out(Soup& soup) {
  constexpr int kRounds = 12;
  constexpr double kTowards = 0.5, kAway = -0.53;  // lets pass what is longer than about ten edges
  std::vector<Vec3> sum(soup.vertex.size());
  std::vector<double> count(soup.vertex.size());
  for (int half = 0; half < 2 * kRounds; ++half) {
    std::fill(sum.begin(), sum.end(), Vec3{});
    std::fill(count.begin(), count.end(), 0.0);
    // Each neighbour is met in two triangles.
    for (const Triangle& t : soup.triangle)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto v = std::size_t(t[c]);
        sum[v] += soup.vertex[std::size_t(t[(c + 1) % 3])] + soup.vertex[std::size_t(t[(c + 2) % 3])];
        count[v] += 2;
      }
    const double share = half % 2 == 0 ? kTowards : kAway;
    for (std::size_t v = 0; v < sum.size(); ++v)
      soup.vertex[v] = soup.vertex[v] + share * (sum[v] / count[v] - soup.vertex[v]);
  }
}

double volume_of(const Soup& soup) {
  return soup.vertex.empty() ? 0 : signed_volume(soup.vertex, soup.triangle, soup.vertex.front());
}

/// The surface where the field has the value at which it encloses `wanted` [mm^3].
Soup surface_of_volume(const Field& field, double wanted) {
  // The volume falls with the level.
  float low = 0, high = *std::max_element(field.value.begin(), field.value.end());
  float level = std::min(0.5f, 0.5f * high);
  for (int round = 0;; ++round) {
    Soup soup = Marching(field, level).take();
    const double volume = volume_of(soup);
    if (std::abs(volume / wanted - 1) <= 0.5 * kVolumeBound || round == kMostRounds) return soup;
    (volume > wanted ? low : high) = level;
    level = 0.5f * (low + high);
  }
}

}  // namespace

Soup label_surface(const LabelMap& map, const Label& label) {
  if (label.voxels == 0) return {};
  Field field = shares_of(map, label);
  smooth(field);
  constexpr double kCubicMillimetre = 1e-9;  // [m^3]
  const double volume = label.volume / kCubicMillimetre;
  // Evening out changes the volume a little; the next round allows for that.
  constexpr int kMostTries = 3;
  double wanted = volume;
  for (int round = 1;; ++round) {
    Soup soup = surface_of_volume(field, wanted);
    even_out(soup);
    const double got = volume_of(soup);
    if (std::abs(got / volume - 1) <= kVolumeBound || round == kMostTries || !(got > 0)) return soup;
    wanted *= volume / got;
  }
}

}  // namespace ctpm::importers
