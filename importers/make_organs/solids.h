#pragma once

#include "core/model/vec3.h"

namespace ctpm::importers {

// Solids as functions of a point: negative inside, positive outside, zero on the surface. Near the surface the value
// approximates the distance. All lengths are in [mm]. Formulas after I. Quilez, "Distance functions".

/// Ellipsoid at `centre` with half axes `half` along x, y, z. The distance is first order, the sign exact.
double ellipsoid(Vec3 point, Vec3 centre, Vec3 half);

/// Superellipsoid with the surface |x/a|^exponent + |y/b|^exponent + |z/c|^exponent = 1; exponents above 2 make blunter
/// ends.
double blunt_ellipsoid(Vec3 point, Vec3 centre, Vec3 half, double exponent);

/// Balls of radius `radius_a` at `a` and `radius_b` at `b`, joined by a body whose radius changes linearly along the
/// axis. a != b.
double tapered_capsule(Vec3 point, Vec3 a, double radius_a, Vec3 b, double radius_b);

/// Box at the origin with half sides `half`, edges and corners rounded with `radius` <= the smallest half
/// side.
double rounded_box(Vec3 point, Vec3 half, double radius);

/// Union of both solids. Where their distances differ by less than `blend` > 0, the joint is filled smoothly (C2).
double join(double a, double b, double blend);

/// Intersection of both solids, with the edge rounded over `blend` > 0.
double common(double a, double b, double blend);

/// The first solid minus the second, with the edge rounded over `blend` > 0.
double cut_out(double solid, double hole, double blend);

/// `v` turned about the x, y or z axis by `degrees`, counter-clockwise seen from the axis' positive end.
Vec3 turn_x(Vec3 v, double degrees);
Vec3 turn_y(Vec3 v, double degrees);
Vec3 turn_z(Vec3 v, double degrees);

}  // namespace ctpm::importers
