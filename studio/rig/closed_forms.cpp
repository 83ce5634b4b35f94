#include "studio/rig/closed_forms.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ctpm::rig {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kAgreement = 1e-8;  ///< between two runs, against the largest value
constexpr int kMostHalvings = 24;

using Eigen::Vector2d;

double size_of(double y) { return std::abs(y); }
double size_of(const Vector2d& y) { return y.cwiseAbs().maxCoeff(); }

/// Time derivative of one unknown or of two.
template <class Y>
using Slope = std::function<Y(double t, const Y& y)>;

/// Integrates y' = slope(t, y) from y0 by classical Runge-Kutta with `steps` steps between two samples.
template <class Y>
std::vector<Y> integrate(const Slope<Y>& slope, Y y, std::size_t sample_count, double interval, long steps) {
  std::vector<Y> samples{y};
  // Loads may have kinks at samples; no step crosses one.
  const double h = interval / double(steps), inside = 1e-9 * h;
  for (std::size_t s = 1; s < sample_count; ++s) {
    for (long i = 0; i < steps; ++i) {
      const double t = double(s - 1) * interval + double(i) * h;
      const Y k1 = slope(t + inside, y), k2 = slope(t + h / 2, Y(y + h / 2 * k1)),
              k3 = slope(t + h / 2, Y(y + h / 2 * k2)), k4 = slope(t + h - inside, Y(y + h * k3));
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    samples.push_back(y);
  }
  return samples;
}

/// Halves the step until two runs agree to kAgreement. `fastest` [s] is the shortest time constant of the equation.
template <class Y>
std::vector<Y> integrate_to_agreement(const Slope<Y>& slope, Y y0, std::size_t sample_count, double interval,
                                      double fastest) {
  long steps = std::max(1L, long(std::ceil(2 * interval / fastest)));
  std::vector<Y> coarse = integrate<Y>(slope, y0, sample_count, interval, steps);
  for (int halving = 0; halving < kMostHalvings; ++halving) {
    steps *= 2;
    std::vector<Y> fine = integrate<Y>(slope, y0, sample_count, interval, steps);
    double largest = 0, change = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      largest = std::max(largest, size_of(fine[i]));
      change = std::max(change, size_of(Y(fine[i] - coarse[i])));
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

namespace {

double cos_theta(const Site& site, double depth) { return site.arm / std::hypot(site.arm, depth); }

/// The part of lambda without delay: all of it, or the rest after the share of the line's own triples.
double lambda_at_once(const Site& site, double depth, Law law) {
  const double modulus = law == Law::eqs_3_to_8_rig ? site.constraint - p2(site) : site.constraint;
  return 2 * modulus * (1 - cos_theta(site, depth));
}

/// Elongation of the line's triples [mm]; Eqs. 3-8 of the paper have lambda instead.
double stretch_of_line(const Site& site, double depth, Law law) {
  return law == Law::eqs_3_to_8_rig ? std::hypot(site.arm, depth) - site.arm : 0.0;
}

/// Stress over time of the spring and the Kelvin unit of one triple, sigma + P1 sigma' = P2 x + P3 x' (Eq.
/// 6).
std::vector<double> stress_of_triple(const Site& site, const std::function<double(double)>& x,
                                     const std::function<double(double)>& rate, std::size_t count, double interval) {
  const auto slow = [&](double t) { return p2(site) * x(t) + p3(site) * rate(t); };
  if (site.viscosity > 0)
    return integrate_to_agreement<double>([&](double t, double s) { return (slow(t) - s) / p1(site); },
                                          site.spring * x(0), count, interval, p1(site));
  std::vector<double> stress;
  for (std::size_t i = 0; i < count; ++i) stress.push_back(slow(double(i) * interval));
  return stress;
}

/// Eq. 10, a first-order equation for the stress itself.
std::vector<double> stress_of_eq_10(const Site& site, const std::function<double(double)>& depth,
                                    const std::function<double(double)>& rate, std::size_t count, double interval) {
  const auto followed = [&](double t) {
    const double x = depth(t), l = lambda(site, x);
    return ((p2(site) + l) * x + (p3(site) + l * p1(site)) * rate(t)) / (1 + tan_theta(site, x));
  };
  if (site.viscosity > 0)
    return integrate_to_agreement<double>([&](double t, double s) { return (followed(t) - s) / p1(site); },
                                          relaxation_stress(site, depth(0), 0), count, interval, p1(site));
  std::vector<double> stress;
  for (std::size_t i = 0; i < count; ++i) stress.push_back(followed(double(i) * interval));
  return stress;
}

}  // namespace

std::vector<Sample> relaxation(const Site& site, const std::function<double(double)>& depth,
                               const std::function<double(double)>& rate, double duration, double interval, Law law) {
  const std::size_t count = count_samples(duration, interval);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i) samples.push_back({double(i) * interval, depth(double(i) * interval), 0});
  if (law == Law::eq_10) {
    const std::vector<double> stress = stress_of_eq_10(site, depth, rate, count, interval);
    for (std::size_t i = 0; i < count; ++i) samples[i].stress = stress[i];
    return samples;
  }
  const auto sine = [&](double x) { return tan_theta(site, x) * cos_theta(site, x); };
  const std::vector<double> below = stress_of_triple(site, depth, rate, count, interval),
                            line = stress_of_triple(
                                site, [&](double t) { return stretch_of_line(site, depth(t), law); },
                                [&](double t) { return law == Law::eqs_3_to_8_rig ? sine(depth(t)) * rate(t) : 0.0; },
                                count, interval);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = samples[i].depth;
    samples[i].stress =
        (below[i] + lambda_at_once(site, x, law) * x + 2 * sine(x) * line[i]) / (1 + tan_theta(site, x));
  }
  return samples;
}

namespace {

/// Elongations of the Kelvin units below C and of each of the line's two triples [mm].
struct Crept {
  double below, line;
};

/// Depth at which springs, Kelvin units and constraint balance the stress, by Newton's method:
/// K2 (eps - eps1) + lambda eps + 2 sin theta K2 (e - e1) = sigma (1 + tan theta), Eqs. 4-8.
double depth_of(const Site& site, double stress, Crept crept, Law law) {
  const bool is_rig = law == Law::eqs_3_to_8_rig;
  const double modulus = site.constraint - (is_rig ? p2(site) : 0.0);
  double x = crept.below + stress / site.spring;
  for (int i = 0; i < 50; ++i) {
    const double cosine = cos_theta(site, x), sine = tan_theta(site, x) * cosine, square = sine * sine;
    const double pull = is_rig ? site.spring * (stretch_of_line(site, x, law) - crept.line) : 0.0;
    const double miss = site.spring * (x - crept.below) + lambda_at_once(site, x, law) * x + 2 * sine * pull -
                        stress * (1 + tan_theta(site, x));
    double slope = site.spring + lambda_at_once(site, x, law) + 2 * modulus * cosine * square - stress / site.arm;
    if (is_rig) slope += 2 * site.spring * square + 2 * pull * cosine * cosine * cosine / site.arm;
    const double step = miss / slope;
    x -= step;
    if (std::abs(step) < 1e-14 * site.arm) break;
  }
  return x;
}

/// Eqs. 3-8 for the elongations of the Kelvin units: v1 eps1' = K2 (eps - eps1) - K1 eps1.
std::vector<double> creep_of_kelvin_units(const Site& site, const std::function<double(double)>& stress,
                                          std::size_t count, double interval, double fastest, Law law) {
  const auto depth_at = [&](double t, const Vector2d& e) { return depth_of(site, stress(t), {e[0], e[1]}, law); };
  const auto slope = [&](double t, const Vector2d& crept) {
    const double x = depth_at(t, crept);
    const Vector2d length(x, stretch_of_line(site, x, law));
    return Vector2d((site.spring * (length - crept) - site.kelvin * crept) / site.viscosity);
  };
  const std::vector<Vector2d> crept =
      integrate_to_agreement<Vector2d>(slope, Vector2d::Zero(), count, interval, fastest);
  std::vector<double> depth;
  for (std::size_t i = 0; i < count; ++i) depth.push_back(depth_at(double(i) * interval, crept[i]));
  return depth;
}

}  // namespace

std::vector<Sample> creep(const Site& site, const std::function<double(double)>& stress,
                          const std::function<double(double)>& rate, double duration, double interval, Law law) {
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
    // Eq. 15 at once.
    depth = integrate_to_agreement<double>(slope, depth_of(site, stress(0), {}, law), count, interval, fastest);
  } else {
    depth = creep_of_kelvin_units(site, stress, count, interval, fastest, law);
  }
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i)
    samples.push_back({double(i) * interval, depth[i], stress(double(i) * interval)});
  return samples;
}

}  // namespace ctpm::rig
