#pragma once

#include <cstdint>
#include <span>

#include "core/model/model.h"
#include "core/model/organ.h"

namespace ctpm::network {

/// Young's modulus of the lattice is this times k / s (LatticeKind::cubic_18).
inline constexpr double kYoungOverEdge = 2.5;

/// Part of a lattice cube that tissue fills, in [0, 1]. `lowest`: the sphere at the cube's corner of smallest i, j, k.
double filled_share(const FilledOrgan& organ, std::size_t lowest);

/// Appends the tissue cells of an organ whose spheres begin at `first_sphere` of the Model, in the order of their
/// lowest corners. kappa is `inversion_resistance` times Young's modulus 2.5 k / s. k is the mean over the eight
/// corners of `edge_k`: static stiffness of an element along a lattice axis of each sphere's material [N/m]
/// (sphere_count).
void add_tissue_cells(Model& model, const FilledOrgan& organ, std::int32_t first_sphere, double inversion_resistance,
                      std::span<const double> edge_k);

}  // namespace ctpm::network
