#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::compare {

/// Means of successive groups of `count` points, >= 1; an incomplete last group is dropped.
std::vector<Vec3> mean_of_each(std::span<const Vec3> path, std::size_t count);

/// Length of the polyline through the points, in their unit. Cotin et al. 2002, path length.
double path_length(std::span<const Vec3> path);

/// Length of the straight lines from station to station, divided by the length of the path between the first and the
/// last station; in [0, 1], 1 for a straight path. `stations`: ascending indices of points that the hand had to visit.
/// None if the hand did not move. Gallagher and Satava 2002.
std::optional<double> economy_of_motion(std::span<const Vec3> path, std::span<const std::size_t> stations);

/// Speed between neighbours, in units of the path per second (point_count - 1).
std::vector<double> speed_along(std::span<const Vec3> path, double rate_hz);

/// Constants of the spectral arc length as published.
inline constexpr int kSpectralPadding = 4;          ///< zeros up to 2^4 times the next power of two
inline constexpr double kSpectralCutoff = 10;       ///< largest frequency [Hz]
inline constexpr double kSpectralAmplitude = 0.05;  ///< share of the largest amplitude below which the tail is cut

/// Smoothness as spectral arc length (SPARC) [1], negative; values nearer to 0 are smoother. Balasubramanian,
/// Melendez-Calderon, Roby-Brami and Burdet 2015. None for fewer than 4 values or a hand that does not move.
std::optional<double> spectral_arc_length(std::span<const double> speed, double rate_hz);

/// Smoothness as logarithm of the dimensionless jerk (LDLJ): -ln(T^3 / v^2 times the integral of |jerk|^2), with the
/// duration T and the largest speed v; larger values are smoother. Balasubramanian et al. 2015. None for fewer than 4
/// points or a hand that does not move.
std::optional<double> log_dimensionless_jerk(std::span<const Vec3> path, double rate_hz);

/// An interval of indices, [first, last).
struct Spell {
  std::size_t first = 0, last = 0;
  friend bool operator==(const Spell&, const Spell&) = default;
};

/// The runs of at least `least` values in which `holds` is true. Runs with fewer than `least_gap` values between them
/// are merged.
std::vector<Spell> spells_of(const std::vector<bool>& holds, std::size_t least, std::size_t least_gap = 1);

}  // namespace ctpm::compare
