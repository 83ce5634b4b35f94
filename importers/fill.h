#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "importers/mesh.h"

namespace ctpm::importers {

struct FillOptions {
  double sphere_radius = 0.004;           ///< r [m], > 0
  double gap = -1;                        ///< between the surfaces of neighbours [m], >= 0; negative: r
  bool keep_islands = false;              ///< keeps spheres that are not connected to the largest network
  std::int64_t most_spheres = 2'000'000;  ///< limit, checked before memory is allocated, > 0
  std::int64_t most_triangles = 0;        ///< a drawn surface with more is coarsened; 0: never
  int threads = 2;                        ///< >= 1; the result does not depend on it
  Progress progress;
};

/// Quality figures of a filling.
struct FillReport {
  std::int64_t spheres = 0;
  std::int64_t edges = 0;                       ///< pairs of neighbours over the 18 directions of the lattice
  std::vector<std::int64_t> spheres_per_layer;  ///< layer 1 first (layer_count)
  double filled_volume = 0;                     ///< number of spheres times spacing cubed [m^3]
  double largest_distance = 0;         ///< largest distance from a surface vertex to the nearest sphere centre [m]
  double mean_distance = 0;            ///< mean of this distance over the surface vertices [m]
  std::int64_t surface_triangles = 0;  ///< triangles of the drawn surface
  std::vector<Finding> findings;
};

struct Filling {
  FilledOrgan organ;
  FillReport report;
};

/// Fills a closed mesh with equal spheres on a cubic lattice and binds the mesh to them. The lattice is symmetric about
/// the centre of the bounding box. A sphere is kept if its centre is inside. Its layer is 1 + the whole spacings of its
/// depth; empty layers are skipped. Errors: options out of range, no sphere fits, more spheres than allowed.
Result<Filling> fill_organ(const CheckedMesh& mesh, const FillOptions& options);

}  // namespace ctpm::importers
