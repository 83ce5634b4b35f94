#include "studio/render/shading_correction.h"

#include <cstdint>
#include <utility>

namespace ctpm::render {
namespace {

/// Unit vectors in the surface at a vertex: towards a neighbour, and across that.
std::pair<Vec3, Vec3> tangents(Vec3 normal, Vec3 to_neighbour) {
  const Vec3 along = to_neighbour - dot(to_neighbour, normal) * normal;
  const double length = norm(along);
  if (!(length > 0)) return {};
  return {along / length, cross(normal, along / length)};
}

}  // namespace

ShadingCorrections corrections_of(const Surface& surface, const std::vector<float>& per_neighbour,
                                  const Shading& at_rest) {
  ShadingCorrections corrections;
  if (at_rest.normal.empty()) return corrections;
  Shading own;
  find_normals(surface, surface.vertex, own), find_crevices(surface, surface.vertex, per_neighbour, own);
  constexpr double kFolded = 0.5;  // cosine
  const std::size_t count = at_rest.normal.size();
  std::vector<std::uint8_t> is_steady(count, 0);
  for (std::size_t v = 0; v < count; ++v) is_steady[v] = dot(at_rest.normal[v], own.normal[v]) > kFolded;
  // The farthest neighbour gives the steadiest direction.
  corrections.assign(count, {});
  std::vector<double> farthest(count, 0.0);
  const auto for_each_pair = [&](auto&& visit) {
    for (const auto& t : surface.triangle)
      for (std::size_t i = 0; i < 3; ++i)
        for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3})
          if (std::size_t(t[i]) < count) visit(std::size_t(t[i]), std::size_t(t[j]));
  };
  for_each_pair([&](std::size_t v, std::size_t other) {
    const double distance = norm(surface.vertex[other] - surface.vertex[v]);
    if (is_steady[v] && distance > farthest[v]) farthest[v] = distance, corrections[v].neighbour = other;
  });
  // A folded vertex goes by a steady one near it.
  constexpr int kRounds = 4;
  std::vector<std::uint8_t> is_known = is_steady;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<std::uint8_t> before = is_known;
    for_each_pair([&](std::size_t v, std::size_t other) {
      if (is_known[v] || other >= count || !before[other]) return;
      corrections[v].neighbour = corrections[other].is_copy ? corrections[other].neighbour : other;
      corrections[v].is_copy = true, is_known[v] = 1;
    });
  }
  for (std::size_t v = 0; v < count; ++v) {
    ShadingCorrection& correction = corrections[v];
    correction.crevice = at_rest.crevice[v] - own.crevice[v];
    if (!is_steady[v]) continue;
    const Vec3 wanted = at_rest.normal[v];
    const double facing = dot(wanted, own.normal[v]);
    const auto [along, across] = tangents(own.normal[v], surface.vertex[correction.neighbour] - surface.vertex[v]);
    correction.along = dot(wanted, along) / facing, correction.across = dot(wanted, across) / facing;
  }
  return corrections;
}

void correct(const ShadingCorrections& corrections, const std::vector<Vec3>& position, std::vector<Vec3>& normals) {
  for (std::size_t v = 0; v < corrections.size(); ++v) {
    const ShadingCorrection& correction = corrections[v];
    if (correction.is_copy) continue;
    Vec3& normal = normals[v];
    const auto [along, across] = tangents(normal, position[correction.neighbour] - position[v]);
    normal += correction.along * along + correction.across * across;
    normal = normal / norm(normal);
  }
  for (std::size_t v = 0; v < corrections.size(); ++v)
    if (corrections[v].is_copy) normals[v] = normals[corrections[v].neighbour];
}

}  // namespace ctpm::render
