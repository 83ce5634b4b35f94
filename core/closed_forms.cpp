#include "core/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ctpm {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kAgreement = 1e-8;  ///< between two runs, against the largest value
constexpr int kMostHalvings = 24;

/// Integrates y' = slope(t, y) from y0 by classical Runge-Kutta with `steps` steps between two samples.
std::vector<double> integrate(const std::function<double(double, double)>& slope, double y0,
                              std::size_t sample_count, double interval, long steps) {
  std::vector<double> samples{y0};
  // Loads may have kinks at samples; every step stays on its own side of them.
  const double h = interval / double(steps), inside = 1e-9 * h;
  double y = y0;
  for (std::size_t s = 1; s < sample_count; ++s) {
    for (long i = 0; i < steps; ++i) {
      const double t = double(s - 1) * interval + double(i) * h;
      const double k1 = slope(t + inside, y), k2 = slope(t + h / 2, y + h / 2 * k1),
                   k3 = slope(t + h / 2, y + h / 2 * k2);
      const double k4 = slope(t + h - inside, y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    samples.push_back(y);
  }
  return samples;
}

/// Halves the step until it changes nothing any more. `fastest` [s] is the shortest time constant of the
/// equation.
std::vector<double> integrate_to_agreement(const std::function<double(double, double)>& slope, double y0,
                                           std::size_t sample_count, double interval, double fastest) {
  long steps = std::max(1L, long(std::ceil(2 * interval / fastest)));
  std::vector<double> coarse = integrate(slope, y0, sample_count, interval, steps);
  for (int halving = 0; halving < kMostHalvings; ++halving) {
    steps *= 2;
    std::vector<double> fine = integrate(slope, y0, sample_count, interval, steps);
    double largest = 0, change = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      largest = std::max(largest, std::abs(fine[i]));
      change = std::max(change, std::abs(fine[i] - coarse[i]));
    }
    coarse = std::move(fine);
    if (change <= kAgreement * largest) break;
  }
  return coarse;
}

std::size_t count_samples(double duration, double interval) {
  return std::size_t(std::llround(duration / interval)) + 1;
}

}  // namespace

double tan_theta(const Site& site, double depth) { return depth / site.arm; }

double lambda(const Site& site, double depth) {
  const double tangent = tan_theta(site, depth);
  return 2 * site.constraint * (1 - 1 / std::sqrt(1 + tangent * tangent));
}

double p1(const Site& site) { return site.viscosity / (site.kelvin + site.spring); }
double p2(const Site& site) { return site.kelvin * site.spring / (site.kelvin + site.spring); }
double p3(const Site& site) { return site.viscosity * site.spring / (site.kelvin + site.spring); }

double slow_stress(const Site& site, double depth) {
  return (p2(site) + lambda(site, depth)) * depth / (1 + tan_theta(site, depth));
}

double relaxation_stress(const Site& site, double depth, double t) {
  const double sum = site.kelvin + site.spring, k2 = site.spring;
  const double decay = site.viscosity > 0 ? std::exp(-t * sum / site.viscosity) : 0.0;
  return ((k2 + lambda(site, depth)) * depth - k2 * k2 * depth / sum * (1 - decay)) /
         (1 + tan_theta(site, depth));
}

double creep_depth(const Site& site, double stress, double depth, double t) {
  const double slow = p2(site) + lambda(site, depth), fast = p3(site) + lambda(site, depth) * p1(site);
  const double load = stress * (1 + tan_theta(site, depth));
  if (fast == 0) return load / slow;
  const double decay = std::exp(-t * slow / fast);
  return load / fast * (fast / slow * (1 - decay) + p1(site) * decay);
}

double slow_depth(const Site& site, double stress) {
  // slow_stress rises with the depth for every K' >= 0 and depth below the arm; beyond it bisection still
  // brackets.
  double low = 0, high = 1;
  while (slow_stress(site, high) < stress && high < 1e6) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (slow_stress(site, middle) < stress ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double force_of_stress(const Site& site, double stress) {
  return stress * kPi * site.ball_radius * site.ball_radius * 1e-3;
}

double table_force(const Site& site, double depth, bool with_softening) {
  const double softening = with_softening ? 1 + tan_theta(site, depth) : 1.0;
  return force_of_stress(site, (p2(site) + lambda(site, depth)) * depth / softening);
}

std::vector<Sample> relaxation(const Site& site, const std::function<double(double)>& depth,
                               const std::function<double(double)>& rate, double duration, double interval,
                               Law law) {
  const std::size_t count = count_samples(duration, interval);
  const auto softening = [&](double t) { return 1 + tan_theta(site, depth(t)); };
  // Both laws are a first-order equation for a stress that follows a given one with the time constant P1: Eq.
  // 10 for sigma itself, Eqs. 3-8 for sigma_o, the part of the spring and the Kelvin unit.
  const auto followed = [&](double t) {
    const double x = depth(t), l = law == Law::eq_10 ? lambda(site, x) : 0.0;
    return ((p2(site) + l) * x + (p3(site) + l * p1(site)) * rate(t)) /
           (law == Law::eq_10 ? softening(t) : 1.0);
  };
  const auto stress_of = [&](double t, double y) {
    return law == Law::eq_10 ? y : (y + lambda(site, depth(t)) * depth(t)) / softening(t);
  };
  const double sudden = law == Law::eq_10 ? relaxation_stress(site, depth(0), 0) : site.spring * depth(0);
  std::vector<double> y;
  if (site.viscosity > 0)
    y = integrate_to_agreement([&](double t, double s) { return (followed(t) - s) / p1(site); }, sudden,
                               count, interval, p1(site));
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = double(i) * interval;
    samples.push_back({t, depth(t), stress_of(t, y.empty() ? followed(t) : y[i])});
  }
  return samples;
}

namespace {

/// Depth at which the spring K2 carries, beyond the Kelvin unit's `elongation`, what the constraint leaves of
/// the stress: K2 (eps - eps1) + lambda eps = sigma (1 + tan theta), Eqs. 4-8, by Newton's rule from the last
/// depth.
double depth_of(const Site& site, double stress, double elongation) {
  double x = elongation + stress / site.spring;
  for (int i = 0; i < 50; ++i) {
    const double miss =
        site.spring * (x - elongation) + lambda(site, x) * x - stress * (1 + tan_theta(site, x));
    const double cosine = 1 / std::sqrt(1 + tan_theta(site, x) * tan_theta(site, x));
    const double slope = site.spring + lambda(site, x) +
                         2 * site.constraint * cosine * (1 - cosine * cosine) - stress / site.arm;
    const double step = miss / slope;
    x -= step;
    if (std::abs(step) < 1e-14 * site.arm) break;
  }
  return x;
}

}  // namespace

std::vector<Sample> creep(const Site& site, const std::function<double(double)>& stress,
                          const std::function<double(double)>& rate, double duration, double interval,
                          Law law) {
  const std::size_t count = count_samples(duration, interval);
  const double fastest = p3(site) / (p2(site) + lambda(site, site.arm));
  std::vector<double> depth;
  if (site.viscosity == 0) {
    for (std::size_t i = 0; i < count; ++i) depth.push_back(slow_depth(site, stress(double(i) * interval)));
  } else if (law == Law::eq_10) {
    const auto slope = [&](double t, double x) {
      const double l = lambda(site, x);
      const double load = (stress(t) + p1(site) * rate(t)) * (1 + tan_theta(site, x));
      return (load - (p2(site) + l) * x) / (p3(site) + l * p1(site));
    };
    depth = integrate_to_agreement(slope, depth_of(site, stress(0), 0), count, interval,
                                   fastest);  // Eq. 15 at once
  } else {
    // The Kelvin unit's elongation eps1 is what creeps: v1 eps1' = K2 (eps - eps1) - K1 eps1.
    const auto slope = [&](double t, double elongation) {
      const double x = depth_of(site, stress(t), elongation);
      return (site.spring * (x - elongation) - site.kelvin * elongation) / site.viscosity;
    };
    depth = integrate_to_agreement(slope, 0, count, interval, fastest);
    for (std::size_t i = 0; i < count; ++i) depth[i] = depth_of(site, stress(double(i) * interval), depth[i]);
  }
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i)
    samples.push_back({double(i) * interval, depth[i], stress(double(i) * interval)});
  return samples;
}

}  // namespace ctpm
