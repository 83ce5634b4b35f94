#include "core/inversion/resistance.h"

#include <algorithm>
#include <map>

#include "core/model/result.h"

namespace ctpm::inversion {

Resistance::Resistance(const Model& model, const parallel::Slabs& slabs, parallel::Team& team,
                       const elements::Kernels& kernels)
    : model_(model), slabs_(slabs), team_(team), check_(model, slabs, kernels) {
  if (!any()) return;
  if (model.has_scalpel()) find_edges();
  counts_.resize(std::size_t(slabs.count())), pressed_.resize(std::size_t(slabs.count()));
  for (int slab = 0; slab < slabs.count(); ++slab) pressed_[std::size_t(slab)].reserve(8 * check_.size(slab));
  saved_.reserve(model.sphere_count()), is_saved_.resize(model.sphere_count());
}

/// Finds the axial elements along the cells' edges.
void Resistance::find_edges() {
  const AxialElements& axial = model_.axial;
  const TissueCells& cells = model_.tissue_cells;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> element_between;
  for (std::size_t e = 0; e < axial.size(); ++e)
    element_between.emplace(std::minmax(axial.a[e], axial.b[e]), std::int32_t(e));
  edges_.resize(cells.size());
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    std::size_t edge = 0;
    for (std::size_t c = 0; c < 8; ++c)
      for (const std::size_t bit : {1u, 2u, 4u}) {
        if ((c & bit) != 0) continue;
        const auto found = element_between.find(std::minmax(cells.corner[c][cell], cells.corner[c | bit][cell]));
        edges_[cell][edge++] = found == element_between.end() ? -1 : found->second;
      }
  }
}

bool Resistance::is_cut(std::size_t cell, const std::vector<std::uint8_t>& axial_severed) const {
  if (axial_severed.empty() || edges_.empty()) return false;
  return std::any_of(edges_[cell].begin(), edges_[cell].end(),
                     [&](std::int32_t element) { return element >= 0 && axial_severed[std::size_t(element)] != 0; });
}

/// Finds the tetrahedra that resist, slab by slab.
void Resistance::find_pressed(const StateView& state) {
  const TissueCells& cells = model_.tissue_cells;
  const double threshold = model_.inversion_threshold;
  for (const int slab : slabs_.asleep()) pressed_[std::size_t(slab)].clear();
  slabs_.for_each_awake(team_, [&](int slab) {
    std::vector<Pressed>& own = pressed_[std::size_t(slab)];
    own.clear();
    check_.find(slab, state.position, threshold, [&](std::size_t cell) {
      if (is_cut(cell, state.axial_severed)) return;
      const double per_volume = 1 / rest_volume(model_, cell);
      for (std::size_t c = 0; c < 8; ++c) {
        const CornerSpheres spheres = spheres_of(cells, cell, c);
        const CornerVolume v = volume_of(spheres, c, state.position);
        const double lack = threshold - per_volume * v.volume;
        if (!(lack > 0)) continue;
        own.push_back({spheres,
                       {per_volume * v.gradient[0], per_volume * v.gradient[1], per_volume * v.gradient[2]},
                       lack,
                       cells.k[cell]});
      }
    });
  });
}

template <class Visit>
void Resistance::for_each_pressed(Visit&& visit) const {
  for (const std::vector<Pressed>& of_slab : pressed_)
    for (const Pressed& p : of_slab) visit(p);
}

double Resistance::energy(const StateView& state) {
  if (!any()) return 0;
  find_pressed(state);
  double energy = 0;
  for_each_pressed([&](const Pressed& p) { energy += 0.5 * p.k * p.lack * p.lack; });
  return energy;
}

std::int32_t Resistance::count_inverted(const StateView& state) {
  if (!any()) return 0;
  team_.for_each(slabs_.count(), [&](int slab) {
    std::int32_t count = 0;
    check_.find(slab, state.position, 0, [&](std::size_t cell) { count += !is_cut(cell, state.axial_severed); });
    counts_[std::size_t(slab)] = count;
  });
  std::int32_t all = 0;
  for (const std::int32_t count : counts_) all += count;
  return all;
}

std::array<Vec3, kMostHands> Resistance::push_out(const StateView& middle, double h, const contact::Pins& pins,
                                                  Vec3Array& velocity) {
  std::array<Vec3, kMostHands> on_pin;
  if (!any()) return on_pin;
  find_pressed(middle);
  for_each_pressed([&](const Pressed& p) {
    Vec3 gain[4];  // change of velocity per impulse [1/(kg m)]
    double speed = 0, ease = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto sphere = std::size_t(p.sphere[i]);
      const Vec3 g = p.at(i);
      const std::uint8_t held = contact::held_axes(pins, model_, sphere);
      const auto free = [&](int axis) { return (held >> axis & 1) != 0 ? 0.0 : 1 / model_.mass[sphere]; };
      gain[i] = {free(0) * g.x, free(1) * g.y, free(2) * g.z};
      speed += dot(g, velocity[sphere]), ease += dot(g, gain[i]);
    }
    const double impulse = h * p.k * (p.lack - h * speed) / (1 + h * h * p.k * ease);
    if (!(impulse > 0)) return;
    for (std::size_t i = 0; i < 4; ++i) {
      velocity.add(std::size_t(p.sphere[i]), impulse * gain[i]);
      for (std::size_t hand = 0; hand < kMostHands; ++hand)
        if (p.sphere[i] == pins[hand].sphere) on_pin[hand] += impulse / h * p.at(i);
    }
  });
  return on_pin;
}

LinearisedResistance Resistance::linearise(const StateView& state, double h, elements::Coordinates& force,
                                           elements::DiagonalBlocks& blocks) {
  return {*this, state, h, force, blocks};
}

LinearisedResistance::LinearisedResistance(Resistance& resistance, const StateView& state, double h,
                                           elements::Coordinates& force, elements::DiagonalBlocks& blocks)
    : resistance_(resistance), h_(h), blocks_(blocks) {
  Resistance& r = resistance_;
  CTPM_CHECK(!r.is_linearised_, "the resistance is linearised while it is in a linear system");
  r.is_linearised_ = true;
  if (!r.any()) return;
  r.find_pressed(state);
  const std::size_t n = r.model_.sphere_count();
  r.for_each_pressed([&](const Resistance::Pressed& p) {
    const double hhk = h * h * p.k;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto sphere = std::size_t(p.sphere[i]);
      double* block = &blocks[sphere];
      if (r.is_saved_[sphere] == 0) {
        r.is_saved_[sphere] = 1;
        r.saved_.push_back({p.sphere[i], {block[0], block[n], block[2 * n], block[3 * n], block[4 * n], block[5 * n]}});
      }
      const Vec3 g = p.at(i), push = p.k * p.lack * g;
      force[sphere] += push.x, force[n + sphere] += push.y, force[2 * n + sphere] += push.z;
      block[0] += hhk * g.x * g.x, block[n] += hhk * g.x * g.y, block[2 * n] += hhk * g.x * g.z;
      block[3 * n] += hhk * g.y * g.y, block[4 * n] += hhk * g.y * g.z, block[5 * n] += hhk * g.z * g.z;
    }
  });
}

LinearisedResistance::~LinearisedResistance() {
  Resistance& r = resistance_;
  const std::size_t n = r.is_saved_.size();
  for (const Resistance::SavedBlock& saved : r.saved_) {
    const auto sphere = std::size_t(saved.sphere);
    for (std::size_t k = 0; k < 6; ++k) blocks_[k * n + sphere] = saved.block[k];
    r.is_saved_[sphere] = 0;
  }
  r.saved_.clear();
  r.is_linearised_ = false;
}

template <bool kLagged, class Real>
void LinearisedResistance::apply_of(const Real* v, Real* result) const {
  const std::size_t n = resistance_.model_.sphere_count();
  resistance_.for_each_pressed([&](const Resistance::Pressed& p) {
    const auto velocity_of = [&](std::int32_t sphere) {
      const auto i = std::size_t(sphere);
      return Vec3{v[i], v[n + i], v[2 * n + i]};
    };
    const Vec3 at_corner = velocity_of(p.sphere[0]);
    double rate = 0;
    for (std::size_t i = 0; i < 3; ++i) rate += dot(p.gradient[i], velocity_of(p.sphere[i + 1]) - at_corner);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto sphere = std::size_t(p.sphere[i]);
      const Vec3 g = p.at(i);
      const double own = kLagged ? dot(g, velocity_of(p.sphere[i])) : 0.0;
      const Vec3 q = h_ * h_ * p.k * (rate - own) * g;
      result[sphere] += Real(q.x), result[n + sphere] += Real(q.y), result[2 * n + sphere] += Real(q.z);
    }
  });
}
template void LinearisedResistance::apply_of<false>(const double* v, double* result) const;
template void LinearisedResistance::apply_of<true>(const float* v, float* result) const;
template void LinearisedResistance::apply_of<true>(const double* v, double* result) const;

}  // namespace ctpm::inversion
