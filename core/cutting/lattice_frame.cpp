#include "core/cutting/lattice_frame.h"

namespace ctpm::cutting {

LatticeFrame lattice_frame(const Model& model, const OrganRange& organ) {
  LatticeFrame frame;
  const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
  bool known[3] = {};
  for (std::size_t i = first; i + 1 < last; ++i) {
    const LatticeCell a = model.cell[i], b = model.cell[i + 1];
    if (b[0] == a[0] + 1 && b[1] == a[1] && b[2] == a[2] && !known[0])
      frame.axis[0] = model.rest_position[i + 1] - model.rest_position[i], known[0] = true;
  }
  for (std::size_t i = first; i < last && !(known[1] && known[2]); ++i)
    for (std::size_t j = i + 1; j < last && !(known[1] && known[2]); ++j) {
      const LatticeCell a = model.cell[i], b = model.cell[j];
      if (b[2] > a[2] + 1) break;  // sorted by (k, j, i)
      for (std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
        LatticeCell beside = a;
        ++beside[axis];
        if (known[axis] || b != beside) continue;
        frame.axis[axis] = model.rest_position[j] - model.rest_position[i], known[axis] = true;
      }
    }
  for (std::size_t a = 0; a < 3; ++a) {
    if (known[a]) frame.axis[a] = frame.axis[a] / norm(frame.axis[a]);
    const Vec3 own{a == 0 ? 1.0 : 0.0, a == 1 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0};
    if (!known[a]) frame.axis[a] = own;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t p = (a + 1) % 3, q = (a + 2) % 3;
    if (!known[a] && known[p] && known[q]) frame.axis[a] = cross(frame.axis[p], frame.axis[q]);
  }
  const LatticeCell c = model.cell[first];
  frame.origin =
      model.rest_position[first] - organ.spacing * (c[0] * frame.axis[0] + c[1] * frame.axis[1] + c[2] * frame.axis[2]);
  return frame;
}

}  // namespace ctpm::cutting
