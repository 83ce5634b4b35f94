#include "studio/render/element_values.h"

#include <algorithm>
#include <cmath>

namespace ctpm {
namespace {

bool is_severed(const std::vector<std::uint8_t>& severed, std::size_t i) { return i < severed.size() && severed[i]; }

/// tan theta of one five-sphere line.
double tan_tilt(const Constraints& lines, const State& state, std::size_t i) {
  const Vec3 a = state.position[std::size_t(lines.a[i])], c = state.position[std::size_t(lines.c[i])],
             e = state.position[std::size_t(lines.e[i])];
  const double half = 0.5 * norm(e - a);
  return half > 0 ? norm(c - 0.5 * (a + e)) / half : 0;
}

/// The largest tan theta of the living lines centred on each sphere (Eq. 8); zero without softening.
std::vector<double> tilt_of_spheres(const Model& model, const State& state) {
  std::vector<double> tilt(model.sphere_count(), 0.0);
  if (!model.has_softening) return tilt;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    double& largest = tilt[std::size_t(model.constraints.c[i])];
    if (!is_severed(state.constraint_severed, i)) largest = std::max(largest, tan_tilt(model.constraints, state, i));
  }
  return tilt;
}

/// Length and its rate of change between two spheres.
struct Gauge {
  double length, rate;
};

Gauge gauge(const State& state, std::int32_t a, std::int32_t b) {
  const Vec3 d = state.position[std::size_t(b)] - state.position[std::size_t(a)];
  const double length = norm(d);
  return {length, length > 0 ? dot(state.velocity[std::size_t(b)] - state.velocity[std::size_t(a)], d) / length : 0};
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
    // The most tilted last, so that they are not hidden by those that lie on the same spheres.
    std::stable_sort(values.begin(), values.end(),
                     [](const ElementValue& x, const ElementValue& y) { return x.value < y.value; });
    return;
  }
  const std::vector<double> tilt = tilt_of_spheres(model, state);
  const Edges& edges = model.edges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (is_severed(state.edge_severed, i)) continue;
    const auto [length, rate] = gauge(state, edges.a[i], edges.b[i]);
    double value = (length - edges.rest_length[i]) / edges.rest_length[i];
    if (quantity == ElementQuantity::force) {
      double worst = std::max(tilt[std::size_t(edges.a[i])], tilt[std::size_t(edges.b[i])]);
      if (i < edges.third.size() && edges.third[i] >= 0) worst = std::max(worst, tilt[std::size_t(edges.third[i])]);
      const double damping = edges.c.empty() ? 0 : edges.c[i] * rate;
      value = std::abs(edges.k[i] * (length - edges.rest_length[i]) + damping) / (1 + worst);
    }
    values.push_back({edges.a[i], edges.b[i], value});
  }
  const TwoSphereTpms& tpms = model.tpms;
  for (std::size_t i = 0; i < tpms.size(); ++i) {
    if (is_severed(state.tpm_severed, i)) continue;
    const double elongation = gauge(state, tpms.a[i], tpms.b[i]).length - tpms.rest_length[i];
    double value = elongation / tpms.rest_length[i];
    if (quantity == ElementQuantity::force) {
      // In series: the spring carries what the whole carries.
      const double worst = std::max(tilt[std::size_t(tpms.a[i])], tilt[std::size_t(tpms.b[i])]);
      value = std::abs(tpms.spring_k[i] * (elongation - state.kelvin_elongation[i])) / (1 + worst);
    }
    values.push_back({tpms.a[i], tpms.b[i], value});
  }
}

}  // namespace ctpm
