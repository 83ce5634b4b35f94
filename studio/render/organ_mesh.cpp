#include "studio/render/organ_mesh.h"

#include "core/surface.h"

namespace ctpm {

void OrganMesh::update(const Surface& surface, const State& state, std::int32_t first_sphere) {
  deform_surface(surface, state.position, first_sphere, position_);
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
  // Crevice: how far the neighbours stand below the tangent plane, in units of their distance.
  crevice_.assign(count, 0.0), valence_.assign(count, 0);
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = std::size_t(t[i]), b = std::size_t(t[(i + 1) % 3]);
      const Vec3 d = position_[b] - position_[a];
      const double length = norm(d);
      if (length > 0) crevice_[a] -= dot(d, normal_[a]) / length, ++valence_[a];
    }
  data_.clear(), data_.reserve(count * kOrganVertexFloats);
  const auto add = [&](Vec3 v) { data_.insert(data_.end(), {float(v.x), float(v.y), float(v.z)}); };
  for (std::size_t v = 0; v < count; ++v) {
    add(position_[v]), add(normal_[v]), add(surface.vertex[v]);
    data_.push_back(float(valence_[v] ? crevice_[v] / valence_[v] : 0));
  }
}

}  // namespace ctpm
