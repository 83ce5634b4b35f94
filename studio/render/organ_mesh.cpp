#include "studio/render/organ_mesh.h"

#include <cmath>

#include "studio/render/noise.h"

namespace ctpm::render {

void OrganMesh::set_surface(const Surface& surface, const std::vector<std::uint8_t>& is_lip,
                            const std::vector<float>& rind) {
  constexpr double kStainsPerMetre = 72;
  lip_.assign(is_lip.begin(), is_lip.end());
  lip_.resize(surface.vertex.size(), 0.0f);
  rind_ = rind;
  rind_.resize(surface.vertex.size(), 0.0f);
  // While a cut grows, most vertices keep their stain.
  stain_.resize(surface.vertex.size()), stained_.resize(surface.vertex.size(), Vec3{INFINITY, 0, 0});
  for (std::size_t v = 0; v < stain_.size(); ++v)
    if (!(stained_[v] == surface.vertex[v]))
      stain_[v] = float(noise_at(kStainsPerMetre * surface.vertex[v])), stained_[v] = surface.vertex[v];
  per_neighbour_.assign(surface.vertex.size(), 0.0f);
  for (const auto& t : surface.triangle)
    for (const std::int32_t v : t) per_neighbour_[std::size_t(v)] += 1;
  for (float& x : per_neighbour_) x = x > 0 ? 1 / x : 0;
}

void OrganMesh::update(contact::DrawnSurfaces& drawn, std::size_t organ, const Surface& surface, const State& state) {
  drawn.place(organ, surface, state, position_);
  const std::size_t count = position_.size();
  // Normals: the sum over the triangles at a vertex, weighted by their area.
  normal_.assign(count, Vec3{});
  for (const auto& t : surface.triangle) {
    const std::size_t a = std::size_t(t[0]), b = std::size_t(t[1]), c = std::size_t(t[2]);
    const Vec3 n = cross(position_[b] - position_[a], position_[c] - position_[a]);
    normal_[a] += n, normal_[b] += n, normal_[c] += n;
  }
  for (Vec3& n : normal_) {
    const double length = norm(n);
    n = length > 0 ? n / length : Vec3{0, 0, 1};
  }
  // Crevice: height of the neighbours below the tangent plane over their distance.
  crevice_.assign(count, 0.0f);
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = std::size_t(t[i]), b = std::size_t(t[(i + 1) % 3]);
      const Vec3 d = position_[b] - position_[a];
      const double square = dot(d, d);
      if (square > 0) crevice_[a] -= float(dot(d, normal_[a]) / std::sqrt(square));
    }
  data_.resize(count * kOrganVertexFloats);
  float* to = data_.data();
  for (std::size_t v = 0; v < count; ++v, to += kOrganVertexFloats) {
    const Vec3 p = position_[v], n = normal_[v], q = surface.vertex[v];
    to[0] = float(p.x), to[1] = float(p.y), to[2] = float(p.z), to[3] = float(n.x), to[4] = float(n.y),
    to[5] = float(n.z);
    to[6] = float(q.x), to[7] = float(q.y), to[8] = float(q.z), to[9] = crevice_[v] * per_neighbour_[v],
    to[10] = stain_[v], to[11] = lip_[v], to[12] = rind_[v];
  }
}

}  // namespace ctpm::render
