#include "studio/render/organ_mesh.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "studio/render/noise.h"

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

void OrganMesh::set_surface(const Surface& surface, const std::vector<float>& lip, const std::vector<float>& rind,
                            const Shading& at_rest) {
  lip_ = lip;
  lip_.resize(surface.vertex.size(), 0.0f);
  rind_ = rind;
  rind_.resize(surface.vertex.size(), 0.0f);
  // While a cut grows, most vertices keep their stain.
  stain_.resize(surface.vertex.size()), stained_.resize(surface.vertex.size(), Vec3{INFINITY, 0, 0});
  for (std::size_t v = 0; v < stain_.size(); ++v)
    if (!(stained_[v] == surface.vertex[v]))
      stain_[v] = float(noise_at(kStainsPerMetre * surface.vertex[v])), stained_[v] = surface.vertex[v];
  per_neighbour_ = count_neighbours(surface);
  find_corrections(surface, at_rest);
}

void OrganMesh::find_corrections(const Surface& surface, const Shading& at_rest) {
  corrections_.clear();
  if (at_rest.normal.empty()) return;
  Shading own;
  find_normals(surface, surface.vertex, own), find_crevices(surface, surface.vertex, per_neighbour_, own);
  constexpr double kFolded = 0.5;  // cosine
  const std::size_t count = at_rest.normal.size();
  std::vector<std::uint8_t> is_steady(count, 0);
  for (std::size_t v = 0; v < count; ++v) is_steady[v] = dot(at_rest.normal[v], own.normal[v]) > kFolded;
  // The farthest neighbour gives the steadiest direction.
  corrections_.assign(count, {});
  std::vector<double> farthest(count, 0.0);
  const auto for_each_pair = [&](auto&& visit) {
    for (const auto& t : surface.triangle)
      for (std::size_t i = 0; i < 3; ++i)
        for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3})
          if (std::size_t(t[i]) < count) visit(std::size_t(t[i]), std::size_t(t[j]));
  };
  for_each_pair([&](std::size_t v, std::size_t other) {
    const double distance = norm(surface.vertex[other] - surface.vertex[v]);
    if (is_steady[v] && distance > farthest[v]) farthest[v] = distance, corrections_[v].neighbour = other;
  });
  // A folded vertex goes by a steady one near it.
  constexpr int kRounds = 4;
  std::vector<std::uint8_t> is_known = is_steady;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<std::uint8_t> before = is_known;
    for_each_pair([&](std::size_t v, std::size_t other) {
      if (is_known[v] || other >= count || !before[other]) return;
      corrections_[v].neighbour = corrections_[other].is_copy ? corrections_[other].neighbour : other;
      corrections_[v].is_copy = true, is_known[v] = 1;
    });
  }
  for (std::size_t v = 0; v < count; ++v) {
    Correction& correction = corrections_[v];
    correction.crevice = at_rest.crevice[v] - own.crevice[v];
    if (!is_steady[v]) continue;
    const Vec3 wanted = at_rest.normal[v];
    const double facing = dot(wanted, own.normal[v]);
    const auto [along, across] = tangents(own.normal[v], surface.vertex[correction.neighbour] - surface.vertex[v]);
    correction.along = dot(wanted, along) / facing, correction.across = dot(wanted, across) / facing;
  }
}

void OrganMesh::correct() {
  for (std::size_t v = 0; v < corrections_.size(); ++v) {
    const Correction& correction = corrections_[v];
    if (correction.is_copy) continue;
    Vec3& normal = shading_.normal[v];
    const auto [along, across] = tangents(normal, position_[correction.neighbour] - position_[v]);
    normal += correction.along * along + correction.across * across;
    normal = normal / norm(normal);
  }
  for (std::size_t v = 0; v < corrections_.size(); ++v)
    if (corrections_[v].is_copy) shading_.normal[v] = shading_.normal[corrections_[v].neighbour];
}

void OrganMesh::update(contact::DrawnSurfaces& drawn, std::size_t organ, const Surface& surface, const State& state) {
  drawn.place(organ, surface, state, position_);
  const std::size_t count = position_.size();
  find_normals(surface, position_, shading_), find_crevices(surface, position_, per_neighbour_, shading_);
  correct();
  data_.resize(count * kOrganVertexFloats);
  float* to = data_.data();
  for (std::size_t v = 0; v < count; ++v, to += kOrganVertexFloats) {
    const Vec3 p = position_[v], n = shading_.normal[v], q = surface.vertex[v];
    to[0] = float(p.x), to[1] = float(p.y), to[2] = float(p.z), to[3] = float(n.x), to[4] = float(n.y),
    to[5] = float(n.z);
    to[6] = float(q.x), to[7] = float(q.y), to[8] = float(q.z),
    to[9] = shading_.crevice[v] + (v < corrections_.size() ? corrections_[v].crevice : 0.0f), to[10] = stain_[v],
    to[11] = lip_[v], to[12] = rind_[v];
  }
}

}  // namespace ctpm::render
