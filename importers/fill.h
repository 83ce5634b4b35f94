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
  Vec3 lattice_shift;                     ///< of the lattice against the mesh, in spacings, each in [-1/2, 1/2]
  bool keep_islands = false;              ///< keeps spheres that are not connected to the largest network
  std::int64_t most_spheres = 2'000'000;  ///< limit, checked before memory is allocated, > 0
  std::int64_t most_triangles = 0;        ///< a drawn surface with more is coarsened; 0: never
  int threads = 2;                        ///< >= 1; the result does not depend on it
  Progress progress;
};

/// How far the outer boundary of spheres and the surface of the mesh that they fill lie from each other.
struct ShapeError {
  double p95 = 0;      ///< 95 % of both lie within it [m]
  double largest = 0;  ///< all of both lies within it [m]
};

/// "from the spheres' outer boundary to the surface: 95 % within 4.2 mm, all within 6.8 mm".
std::string to_text(const ShapeError& error);

/// Quality figures of a filling.
struct FillReport {
  std::int64_t spheres = 0;
  std::int64_t edges = 0;                       ///< elements between neighbours
  std::vector<std::int64_t> spheres_per_layer;  ///< layer 1 first (layer_count)
  double filled_volume = 0;                     ///< tissue that the spheres stand for [m^3]
  double largest_distance = 0;         ///< largest distance from a surface vertex to the nearest sphere centre [m]
  double mean_distance = 0;            ///< mean of this distance over the surface vertices [m]
  ShapeError shape;                    ///< see measure_shape() in shape_error.h
  std::int64_t surface_triangles = 0;  ///< triangles of the drawn surface
  std::vector<Finding> findings;
};

struct Filling {
  FilledOrgan organ;
  FillReport report;
};

/// Radius [m] with which about `spheres` > 0 spheres fill a mesh if the gap is the radius.
double radius_for(const CheckedMesh& mesh, std::int64_t spheres);

/// Fills a closed mesh with equal spheres on a cubic lattice that covers it, and binds the mesh to them. The lattice is
/// symmetric about the centre of the bounding box. Spheres and elements at the surface have the share of tissue that
/// they stand for (cover_lattice.h). A sphere's layer is 1 + the whole spacings of its depth; empty layers are skipped,
/// and spheres outside are in layer 1. The drawn surface is refined until its edges are at most a third of a spacing.
/// Errors: options out of range, no sphere fits, more spheres than allowed.
Result<Filling> fill_organ(const CheckedMesh& mesh, const FillOptions& options);

}  // namespace ctpm::importers
