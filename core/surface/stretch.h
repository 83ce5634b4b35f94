#pragma once

#include <vector>

#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// How many times as long as at rest spread_stretch() lets a triangle become. Soft tissue that elements hold stays well
/// below it.
inline constexpr double kMostStretch = 5;

/// What is shorter than this at rest is a place rather than a length, in spacings: a fifth of a step of the grid on
/// which cuts are meshed.
inline constexpr double kShort = 0.05;

/// How many times as long as at rest the longest edge of a triangle is; one that is short counts as kShort spacings.
/// `spacing` [m].
double stretch_of(const Vec3 (&rest)[3], const Vec3 (&now)[3], double spacing);

/// Spreads a stretch that no element carries. In front of a cut under a flap that folds over, both sides of the cut go
/// by several spacings while the elements around its end hold; the drawn tissue between them, which follows spheres of
/// either side, would be drawn out into spikes within a part of a spacing. Neighbouring places on `surface`, which lies
/// in an organ of that `spacing` [m], are moved until no triangle is more than kMostStretch times as long as at rest;
/// places two spacings away stay. Places that are together, at rest and now, stay so. Nothing changes where nothing is
/// stretched as much. Our choice. `vertex` [m] (vertex_count).
void spread_stretch(const Surface& surface, double spacing, std::vector<Vec3>& vertex);

}  // namespace ctpm::surface
