#include "studio/render/element_values.h"

#include <algorithm>
#include <cmath>

namespace ctpm::render {
namespace {

bool is_severed(const std::vector<std::uint8_t>& severed, std::size_t i) { return i < severed.size() && severed[i]; }

/// tan theta of one five-sphere line.
double tan_tilt(const Constraints& lines, const State& state, std::size_t i) {
  const Vec3 a = state.position[std::size_t(lines.a[i])], c = state.position[std::size_t(lines.c[i])],
             e = state.position[std::size_t(lines.e[i])];
  const double half = 0.5 * norm(e - a);
  return half > 0 ? norm(c - 0.5 * (a + e)) / half : 0;
}

/// The largest tan theta of the unsevered lines centred on each sphere (Eq. 8); zero without softening.
std::vector<double> tilt_of_spheres(const Model& model, const State& state) {
  std::vector<double> tilt(model.sphere_count(), 0.0);
  if (!model.has_softening) return tilt;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    double& largest = tilt[std::size_t(model.constraints.c[i])];
    if (!is_severed(state.constraint_severed, i)) largest = std::max(largest, tan_tilt(model.constraints, state, i));
  }
  return tilt;
}

Vec3 apart(const Model& model, const Vec3Array& of, std::size_t i) {
  return of[std::size_t(model.axial.b[i])] - of[std::size_t(model.axial.a[i])];
}

/// Elongation of an axial element [m].
double elongation(const Model& model, const State& state, std::size_t i) {
  return norm(apart(model, state.position, i)) - model.axial.rest_length[i];
}

/// Magnitude of the force of an axial element [N], softened by the largest tilt of its spheres (Eq. 8). The force of a
/// two-sphere TPM is that of its spring.
double axial_force(const Model& model, const State& state, const std::vector<double>& tilt, std::size_t i) {
  const AxialElements& axial = model.axial;
  double worst = std::max(tilt[std::size_t(axial.a[i])], tilt[std::size_t(axial.b[i])]);
  if (i < axial.third.size() && axial.third[i] >= 0) worst = std::max(worst, tilt[std::size_t(axial.third[i])]);
  double x = elongation(model, state, i), damping = 0;
  if (axial.law[i] == AxialLaw::two_sphere_tpm) {
    x -= state.kelvin_elongation[std::size_t(axial.internal[i])];
  } else if (const Vec3 d = apart(model, state.position, i); norm(d) > 0) {
    damping = axial.damping(i) * dot(apart(model, state.velocity, i), d) / norm(d);
  }
  return std::abs(axial.k[i] * x + damping) / (1 + worst);
}

}  // namespace

void measure_elements(const Model& model, const State& state, ElementQuantity quantity,
                      std::vector<ElementValue>& values) {
  values.clear();
  if (quantity == ElementQuantity::tilt) {
    const Constraints& lines = model.constraints;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (is_severed(state.constraint_severed, i)) continue;
      const double tilt = std::atan(tan_tilt(lines, state, i));
      values.push_back({lines.a[i], lines.c[i], tilt}), values.push_back({lines.c[i], lines.e[i], tilt});
    }
    // The most tilted lines come last, so that lines on the same spheres do not hide them.
    std::stable_sort(values.begin(), values.end(),
                     [](const ElementValue& x, const ElementValue& y) { return x.value < y.value; });
    return;
  }
  const std::vector<double> tilt = tilt_of_spheres(model, state);
  const AxialElements& axial = model.axial;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    if (is_severed(state.axial_severed, i)) continue;
    const double value = quantity == ElementQuantity::force ? axial_force(model, state, tilt, i)
                                                            : elongation(model, state, i) / axial.rest_length[i];
    values.push_back({axial.a[i], axial.b[i], value});
  }
}

}  // namespace ctpm::render
