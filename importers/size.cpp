#include "importers/size.h"

namespace ctpm::importers {

double spacing_of(const FillOptions& options) {
  return 2 * options.sphere_radius + (options.gap < 0 ? options.sphere_radius : options.gap);
}

double expected_spheres(const CheckedMesh& mesh, double spacing) {
  return mesh.volume / (spacing * spacing * spacing) + 0.5 * mesh.area / (spacing * spacing);
}

}  // namespace ctpm::importers
