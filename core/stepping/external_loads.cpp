#include "core/stepping/external_loads.h"

namespace ctpm::stepping {

void ExternalLoads::set(std::size_t begin, std::size_t end, elements::Coordinates& force) const {
  const std::size_t n = model.sphere_count();
  const double gravity[3] = {model.gravity.x, model.gravity.y, model.gravity.z};
  const double* mass = model.mass.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double* __restrict out = &force[axis * n];
    for (std::size_t i = begin; i < end; ++i) out[i] = mass[i] * gravity[axis];
  }
  if (has_loads) add_loads(begin, end, force);
}

void ExternalLoads::add_loads(std::size_t begin, std::size_t end, elements::Coordinates& force) const {
  const std::size_t n = model.sphere_count();
  const Loads& loads = model.loads;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const auto i = std::size_t(loads.sphere[l]);
    if (i < begin || i >= end) continue;
    const double since = time - loads.start[l];
    const double share = since <= 0 ? 0.0 : (since >= loads.ramp[l] ? 1.0 : since / loads.ramp[l]);
    const Vec3 pull = share * loads.force[l];
    force[i] += pull.x, force[n + i] += pull.y, force[2 * n + i] += pull.z;
  }
}

}  // namespace ctpm::stepping
