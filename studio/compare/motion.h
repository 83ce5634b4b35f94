#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::compare {

/// The mean of each `count` neighbours, >= 1; what is left over at the end is dropped.
std::vector<Vec3> mean_of_each(std::span<const Vec3> path, std::size_t count);

/// Length of the line through the points, in their unit. Cotin et al. 2002, path length.
double path_length(std::span<const Vec3> path);

/// Length of the straight lines from station to station, divided by the length of the path between the first
/// and the last of them: 1 for a hand that goes straight, less for detours; in [0, 1]. `stations`: ascending
/// indices of points where the hand had to be. Nothing if the hand did not move. Gallagher and Satava
/// 2002.
std::optional<double> economy_of_motion(std::span<const Vec3> path, std::span<const std::size_t> stations);

/// Speed between neighbours, in units of the path a second (point_count - 1).
std::vector<double> speed_along(std::span<const Vec3> path, double rate_hz);

/// Constants of the spectral arc length as they were published.
inline constexpr int kSpectralPadding = 4;          ///< zeros up to 2^4 times the next power of two
inline constexpr double kSpectralCutoff = 10;       ///< largest frequency [Hz]
inline constexpr double kSpectralAmplitude = 0.05;  ///< share of the largest amplitude below which the tail is cut

/// Smoothness as spectral arc length (SPARC), dimensionless and negative: the nearer to 0 the smoother.
/// Balasubramanian, Melendez-Calderon, Roby-Brami and Burdet 2015. Nothing for fewer than 4 values or a hand
/// that does not move.
std::optional<double> spectral_arc_length(std::span<const double> speed, double rate_hz);

/// Smoothness as logarithm of the dimensionless jerk (LDLJ): -ln(T^3 / v^2 times the integral of |jerk|^2),
/// with the duration T and the largest speed v; the larger the smoother. Balasubramanian et al. 2015. Nothing
/// for fewer than 4 points or a hand that does not move.
std::optional<double> log_dimensionless_jerk(std::span<const Vec3> path, double rate_hz);

/// Indices [first, last) of something that lasts.
struct Spell {
  std::size_t first = 0, last = 0;
  friend bool operator==(const Spell&, const Spell&) = default;
};

/// The runs in which `holds` is true, of at least `least` values; those with fewer than `least_gap` values
/// between them are one.
std::vector<Spell> spells_of(const std::vector<bool>& holds, std::size_t least, std::size_t least_gap = 1);

}  // namespace ctpm::compare
