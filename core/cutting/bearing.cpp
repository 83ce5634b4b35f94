#include "core/cutting/bearing.h"

#include <algorithm>

#include "core/cutting/cutting.h"

namespace ctpm::cutting {
namespace {

/// Up to the first part of its elements a sphere is a crumb, from the second on it bears in full (our choice). Next to
/// a cut some two thirds are whole, between two cuts a spacing apart less than a half.
constexpr double kCrumb = 0.12, kWhole = 0.35;

/// What a crumb bears beside others: where there is nothing else, it bears all. Less than a pivot that counts in
/// RestMap, so that crumbs never make out what other spheres do not span.
constexpr double kLeast = 1e-9;

}  // namespace

Bearing::Bearing(const Model& model, const RestElements& elements)
    : model_(model), severed_(model.axial.size(), 0), share_(model.sphere_count(), 1.0) {
  for (std::size_t i = 0; i < model.sphere_count(); ++i) all_.push_back(std::int32_t(elements.of(i).size()));
  whole_ = all_;
}

void Bearing::count(std::int32_t sphere, int change) {
  const auto i = std::size_t(sphere);
  whole_[i] += change;
  share_[i] = std::clamp((double(whole_[i]) / double(all_[i]) - kCrumb) / (kWhole - kCrumb), kLeast, 1.0);
}

void Bearing::update(const State& state) {
  if (state.axial_severed.size() != severed_.size() || state.axial_severed == severed_) return;
  for (std::size_t e = 0; e < severed_.size(); ++e) {
    if (severed_[e] == state.axial_severed[e]) continue;
    severed_[e] = state.axial_severed[e];
    for (const std::int32_t sphere : {model_.axial.a[e], model_.axial.b[e]}) count(sphere, severed_[e] == 0 ? 1 : -1);
  }
}

double BladeAt::share(std::int32_t sphere, double rest_distance, double spacing) const {
  const double distance = norm(position[std::size_t(sphere)] - point), near = 2 * rest_distance + spacing,
               far = 3 * rest_distance + 2 * spacing;
  return bearing.share(sphere) * std::clamp((far - distance) / (far - near), 0.0, 1.0);
}

}  // namespace ctpm::cutting
