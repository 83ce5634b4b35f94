#pragma once

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "importers/fill.h"
#include "zoo.h"

namespace ctpm::bench {

constexpr double kRing = 0.06, kTube = 0.025;  // [m]

/// A ring of about this many triangles.
inline importers::RawMesh ring_of(std::int64_t triangles) {
  const int across = int(std::lround(std::sqrt(double(triangles) / 2 * kTube / kRing)));
  return zoo::torus(kRing, kTube, int(triangles / 2 / across), across);
}

inline importers::CheckedMesh checked_ring_of(std::int64_t triangles) {
  Result<importers::CheckedMesh> mesh = importers::repair_mesh(ring_of(triangles), 1);
  if (!mesh) throw std::runtime_error(zoo::text_of(mesh.errors()));
  return std::move(*mesh);
}

/// The spacing [m] that gives the ring about this many spheres.
inline double spacing_for(std::int64_t spheres) {
  return std::cbrt(2 * std::numbers::pi * std::numbers::pi * kRing * kTube * kTube / double(spheres));
}

inline importers::FillOptions options_for(std::int64_t spheres) {
  importers::FillOptions options;
  options.sphere_radius = spacing_for(spheres) / 3;
  options.gap = spacing_for(spheres) / 3;
  options.threads = 2;
  return options;
}

}  // namespace ctpm::bench
