#include "studio/render/organ_mesh.h"

#include <cmath>
#include <cstdint>

#include "studio/render/noise.h"

namespace ctpm::render {
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
  corrections_ = corrections_of(surface, per_neighbour_, at_rest);
}

void OrganMesh::update(contact::DrawnSurfaces& drawn, std::size_t organ, const Surface& surface, const State& state) {
  drawn.place(organ, surface, state, position_);
  const std::size_t count = position_.size();
  find_normals(surface, position_, shading_), find_crevices(surface, position_, per_neighbour_, shading_);
  correct(corrections_, position_, shading_.normal);
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
