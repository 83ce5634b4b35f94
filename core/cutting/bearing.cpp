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

Bearing::Bearing(const Model& model, const RestElements& elements) : model_(model), elements_(elements) {}

double Bearing::share_of(std::size_t sphere) const {
  const auto all = elements_.of(sphere);
  if (all.empty()) return 1;
  const auto whole =
      std::count_if(all.begin(), all.end(), [&](std::int32_t e) { return severed_[std::size_t(e)] == 0; });
  return std::clamp((double(whole) / double(all.size()) - kCrumb) / (kWhole - kCrumb), kLeast, 1.0);
}

void Bearing::update(const State& state) {
  if (state.axial_severed == severed_) return;
  if (severed_.size() != state.axial_severed.size()) severed_.assign(state.axial_severed.size(), 0);
  if (share_.empty()) share_.assign(model_.sphere_count(), 1.0);
  const std::vector<std::uint8_t> before = severed_;
  severed_ = state.axial_severed;
  for (std::size_t e = 0; e < severed_.size(); ++e)
    if (severed_[e] != before[e])
      for (const std::int32_t sphere : {model_.axial.a[e], model_.axial.b[e]})
        share_[std::size_t(sphere)] = share_of(std::size_t(sphere));
}

double BladeAt::share(std::int32_t sphere, double rest_distance, double spacing) const {
  const double distance = norm(position[std::size_t(sphere)] - point), near = 2 * rest_distance + spacing,
               far = 3 * rest_distance + 2 * spacing;
  return bearing.share(sphere) * std::clamp((far - distance) / (far - near), 0.0, 1.0);
}

}  // namespace ctpm::cutting
