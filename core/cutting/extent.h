#pragma once

#include <span>
#include <string>

#include "core/model/box.h"
#include "core/model/organ.h"

namespace ctpm::cutting {

// Cutting lays grids over the tissue at rest: of cells of 4 mm over all of it, and of 2.4 mm over an organ's surface
// (edges [m]). Each may have so many cells: some 200 MB.
inline constexpr double kRestCell = 4e-3, kSurfaceCell = 2.4e-3, kMostCells = 5e7;

/// Number of cells of edge `cell` [m] that cover a box.
double cells_in(const Box& box, double cell);

/// Whether the grid over all tissue fits: `box` is that of all spheres at rest [m], `spacing` the largest of the
/// organs.
bool rest_fits(const Box& box, double spacing);

/// Why the grids do not fit over some organs, in words; empty if they do.
std::string extent_problem(std::span<const FilledOrgan> organs);

}  // namespace ctpm::cutting
