#include "importers/nesting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

namespace ctpm::importers {
namespace {

/// Turns of a surface around a point: 1 inside a closed one, 0 outside (Van Oosterom & Strackee, "The solid angle of a
/// plane triangle", IEEE Trans. Biomed. Eng. 30, 1983).
double winding_number(const Soup& soup, Vec3 point) {
  double sum = 0;
  for (const Triangle& t : soup.triangle) {
    const Vec3 a = soup.vertex[std::size_t(t[0])] - point, b = soup.vertex[std::size_t(t[1])] - point,
               c = soup.vertex[std::size_t(t[2])] - point;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

std::uint64_t hash_of(Vec3 p) {
  std::array<std::uint64_t, 3> bits;
  std::memcpy(bits.data(), &p, sizeof bits);
  std::uint64_t h = 0;
  for (const std::uint64_t b : bits) h = (h ^ b ^ (h >> 29)) * 0x9E3779B97F4A7C15u;
  return h ^ (h >> 32);
}

}  // namespace

bool is_inside(const Soup& inner, const Soup& outer) {
  const BoundingBox in = bounding_box(inner), out = bounding_box(outer);
  const bool fits = in.least.x > out.least.x && in.least.y > out.least.y && in.least.z > out.least.z &&
                    in.most.x < out.most.x && in.most.y < out.most.y && in.most.z < out.most.z;
  if (!fits) return false;
  constexpr std::size_t kPoints = 5;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Triangle& t = inner.triangle[i * (inner.triangle.size() - 1) / (kPoints - 1)];
    if (std::abs(winding_number(outer, inner.vertex[std::size_t(t[0])])) < 0.5) return false;
  }
  return true;
}

PartVote::PartVote(const RawMesh& mesh, double unit_in_metres)
    : part_count_(mesh.parts.size()), is_only_part_(part_count_ == 1 && !mesh.part_of_triangle.empty()) {
  if (is_only_part_) return;
  std::vector<char> has_voted(mesh.vertex.size(), 0);
  for (std::size_t t = 0; t < mesh.part_of_triangle.size(); ++t)
    for (const std::int32_t v : mesh.triangle[t])
      if (!std::exchange(has_voted[std::size_t(v)], 1))
        part_at_.emplace(hash_of(unit_in_metres * mesh.vertex[std::size_t(v)]), mesh.part_of_triangle[t]);
}

std::int32_t PartVote::part_of(const std::vector<Vec3>& vertex) const {
  if (is_only_part_) return 0;
  std::vector<std::int64_t> votes(part_count_, 0);
  for (const Vec3& p : vertex)
    if (const auto found = part_at_.find(hash_of(p)); found != part_at_.end()) ++votes[std::size_t(found->second)];
  const auto most = std::max_element(votes.begin(), votes.end());
  return most == votes.end() || *most == 0 ? -1 : std::int32_t(most - votes.begin());
}

}  // namespace ctpm::importers
