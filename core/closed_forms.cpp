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
std::vector<double> integrate(const std::function<double(double, double)>& slope, double y0, std::size_t sample_count,
                              double interval, long steps) {
  std::vector<double> samples{y0};
  // Loads may have kinks at samples; every step stays on its own side of them.
  const double h = interval / double(steps), inside = 1e-9 * h;
  double y = y0;
  for (std::size_t s = 1; s < sample_count; ++s) {
    for (long i = 0; i < steps; ++i) {
      const double t = double(s - 1) * interval + double(i) * h;
      const double k1 = slope(t + inside, y), k2 = slope(t + h / 2, y + h / 2 * k1), k3 = slope(t + h / 2, y + h / 2 * k2);
      const double k4 = slope(t + h - inside, y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    samples.push_back(y);
  }
  return samples;
}

/// Halves the step until it changes nothing any more. `fastest` [s] is the shortest time constant of the equation.
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

std::size_t count_samples(double duration, double interval) { return std::size_t(std::llround(duration / interval)) + 1; }

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
  return ((k2 + lambda(site, depth)) * depth - k2 * k2 * depth / sum * (1 - decay)) / (1 + tan_theta(site, depth));
}

double creep_depth(const Site& site, double stress, double depth, double t) {
  const double slow = p2(site) + lambda(site, depth), fast = p3(site) + lambda(site, depth) * p1(site);
  const double load = stress * (1 + tan_theta(site, depth));
  if (fast == 0) return load / slow;
  const double decay = std::exp(-t * slow / fast);
  return load / fast * (fast / slow * (1 - decay) + p1(site) * decay);
}

double slow_depth(const Site& site, double stress) {
  // slow_stress rises with the depth for every K' >= 0 and depth below the arm; beyond it bisection still brackets.
  double low = 0, high = 1;
  while (slow_stress(site, high) < stress && high < 1e6) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (slow_stress(site, middle) < stress ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double force_of_stress(const Site& site, double stress) { return stress * kPi * site.ball_radius * site.ball_radius * 1e-3; }

double table_force(const Site& site, double depth, bool with_softening) {
  const double softening = with_softening ? 1 + tan_theta(site, depth) : 1.0;
  return force_of_stress(site, (p2(site) + lambda(site, depth)) * depth / softening);
}

std::vector<Sample> relaxation(const Site& site, const std::function<double(double)>& depth,
                               const std::function<double(double)>& rate, double duration, double interval) {
  const auto load = [&](double t) {
    const double x = depth(t), l = lambda(site, x);
    return ((p2(site) + l) * x + (p3(site) + l * p1(site)) * rate(t)) / (1 + tan_theta(site, x));
  };
  const std::size_t count = count_samples(duration, interval);
  std::vector<double> stress;
  if (site.viscosity == 0)
    for (std::size_t i = 0; i < count; ++i) stress.push_back(load(double(i) * interval));
  else
    stress = integrate_to_agreement([&](double t, double s) { return (load(t) - s) / p1(site); },
                                    relaxation_stress(site, depth(0), 0), count, interval, p1(site));
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i) samples.push_back({double(i) * interval, depth(double(i) * interval), stress[i]});
  return samples;
}

std::vector<Sample> creep(const Site& site, const std::function<double(double)>& stress,
                          const std::function<double(double)>& rate, double duration, double interval) {
  const std::size_t count = count_samples(duration, interval);
  std::vector<double> depth;
  if (site.viscosity == 0) {
    for (std::size_t i = 0; i < count; ++i) depth.push_back(slow_depth(site, stress(double(i) * interval)));
  } else {
    const auto slope = [&](double t, double x) {
      const double l = lambda(site, x);
      const double load = (stress(t) + p1(site) * rate(t)) * (1 + tan_theta(site, x));
      return (load - (p2(site) + l) * x) / (p3(site) + l * p1(site));
    };
    // A sudden stress finds the spring K2 alone (Eq. 15).
    Site sudden = site;
    sudden.kelvin = 1e12 * site.spring;
    const double x0 = stress(0) > 0 ? slow_depth(sudden, stress(0)) : 0.0;
    depth = integrate_to_agreement(slope, x0, count, interval, p3(site) / (p2(site) + lambda(site, site.arm)));
  }
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i) samples.push_back({double(i) * interval, depth[i], stress(double(i) * interval)});
  return samples;
}

}  // namespace ctpm
