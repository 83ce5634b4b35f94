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

/// Smoothness as logarithm of the dimensionless jerk (LDLJ): -ln(T^3 / v^2 times the integral of the square of the
/// speed's second derivative), with the duration T and the largest speed v; larger values are smoother.
/// Balasubramanian et al. 2015. None for fewer than 4 values, a hand that does not move or one of even speed.
std::optional<double> log_dimensionless_jerk(std::span<const double> speed, double rate_hz);

/// Frequency of which half the power is left [Hz]: a hand moves and trembles below, devices and rounding are above.
inline constexpr double kHandCutoff = 10;

/// The path without what is faster than a hand: its mean under a Gaussian bell, and beyond its ends the path turned
/// about them, so that it begins and ends where it did.
std::vector<Vec3> low_passed(std::span<const Vec3> path, double rate_hz);

/// What a movement is, as shares of what the hand itself does: so it is the same at any pace.
inline constexpr double kStillSpeed = 0.05;  ///< of the largest speed: slower is standing still
inline constexpr double kRestTime = 0.05;    ///< of the time in motion: standing still for longer parts two movements

/// An interval of indices, [first, last).
struct Spell {
  std::size_t first = 0, last = 0;
  friend bool operator==(const Spell&, const Spell&) = default;
};

/// The runs of at least `least` values in which `holds` is true. Runs with fewer than `least_gap` values between them
/// are merged.
std::vector<Spell> spells_of(const std::vector<bool>& holds, std::size_t least, std::size_t least_gap = 1);

/// The movements between two rests, without standing still before and after; indices into `speed`. What lasts no longer
/// than a rest is none.
std::vector<Spell> movements_of(std::span<const double> speed);

}  // namespace ctpm::compare
