#pragma once

#include "importers/fill.h"

// What the size of a mesh says before it is filled.
namespace ctpm::importers {

/// An organ that is so many times smaller or larger than usual has a wrong unit.
inline constexpr double kWrongSize = 4;

/// Distance between neighbours [m].
double spacing_of(const FillOptions& options);

/// About how many spheres that distance [m] apart cover a mesh: those of its volume, and half a cell's for each at its
/// surface, which a thin wall has most of.
double expected_spheres(const CheckedMesh& mesh, double spacing);

}  // namespace ctpm::importers
