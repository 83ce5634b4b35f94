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
  double gap = -1;                        ///< between neighbours' surfaces [m], >= 0; negative: r
  bool keep_islands = false;              ///< keep spheres that are not joined to the largest network
  std::int64_t most_spheres = 2'000'000;  ///< more are refused before memory is spent on them, > 0
  std::int64_t most_triangles = 0;        ///< of the drawn surface, which is coarsened if it has more; 0: never
  int threads = 2;                        ///< >= 1; the result does not depend on it
  Progress progress;
};

/// What the filling is worth.
struct FillReport {
  std::int64_t spheres = 0;
  std::int64_t edges = 0;                       ///< pairs of neighbours over the 18 directions of the lattice
  std::vector<std::int64_t> spheres_per_layer;  ///< layer 1 first (layer_count)
  double filled_volume = 0;                     ///< spheres times spacing cubed [m^3]
  double largest_distance = 0;                  ///< from a surface vertex to the nearest sphere's centre [m]
  double mean_distance = 0;                     ///< the same, mean over the surface vertices [m]
  std::int64_t surface_triangles = 0;           ///< of the drawn surface
  std::vector<Finding> findings;
};

struct Filling {
  FilledOrgan organ;
  FillReport report;
};

/// Fills the inside of a closed mesh with equal spheres on a cubic lattice and binds the mesh to them. The
/// lattice is symmetric about the centre of the bounding box; a sphere is kept where its centre is inside.
/// Layers count spacings of depth. Errors: options out of range, no sphere fits, more spheres than allowed.
Result<Filling> fill_organ(const CheckedMesh& mesh, const FillOptions& options);

}  // namespace ctpm::importers
