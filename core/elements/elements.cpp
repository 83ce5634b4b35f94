#include "core/elements/elements.h"

#include <algorithm>
#include <type_traits>

#include "core/elements/parts.h"

namespace ctpm::elements {
namespace {

/// Numbers between the rows of two slabs: more than a core prefetches.
constexpr std::size_t kApart = 256;

/// Slabs of more spheres add forces directly to the arrays of all spheres: copying would cost more than the few cache
/// lines that threads then share.
constexpr std::int32_t kThick = 4096;

}  // namespace

Elements::Elements(const Model& model, parallel::Team& team, InstructionSet set)
    : team_(team),
      slabs_(model.solver.sleep_bound > 0 ? parallel::Slabs(parts_of(model)) : parallel::Slabs(model.sphere_count())),
      axial_(model, slabs_, kernels_for(set)),
      constraints_(model, model.constraints, slabs_, kernels_for(set)),
      angles_(model, model.angle_springs, slabs_, kernels_for(set)),
      softness_(model.has_softening ? model.sphere_count() : 0),
      workbenches_(std::size_t(slabs_.count())) {}

void Elements::make_room(std::size_t full_rows, std::size_t single_rows) {
  if (slabs_.count() == 1) return;
  for (int slab = 0; slab < slabs_.count(); ++slab) {
    const auto size = std::size_t(slabs_.end(slab) - slabs_.begin(slab));
    Workbench& workbench = workbenches_[std::size_t(slab)];
    if (workbench.full.size() < full_rows * size) workbench.full.resize(full_rows * size + kApart);
    if (workbench.single.size() < single_rows * size) workbench.single.resize(single_rows * size + kApart);
  }
}

template <class Real>
SlabTarget<Real> Elements::target_for(int slab, std::size_t rows, Real* all, std::size_t after) const {
  const auto size = std::size_t(slabs_.end(slab) - slabs_.begin(slab));
  if (slabs_.count() == 1) return {all, 0, size};
  Workbench& workbench = workbenches_[std::size_t(slab)];
  Real* room;
  if constexpr (std::is_same_v<Real, float>)
    room = workbench.single.data();
  else
    room = workbench.full.data() + after * size;
  std::fill_n(room, rows * size, Real(0));
  return {room, slabs_.begin(slab), size};
}
template SlabTarget<float> Elements::target_for(int slab, std::size_t rows, float* all, std::size_t after) const;
template SlabTarget<double> Elements::target_for(int slab, std::size_t rows, double* all, std::size_t after) const;

template <class Real>
void Elements::bring(const SlabTarget<Real>& own, std::size_t rows, Real* all) const {
  if (slabs_.count() == 1) return;
  const auto spheres = std::size_t(slabs_.end(slabs_.count() - 1));
  for (std::size_t row = 0; row < rows; ++row) {
    const Real* __restrict from = own.data + row * own.stride;
    Real* __restrict to = all + row * spheres + own.begin;
    for (std::size_t i = 0; i < own.stride; ++i) to[i] += from[i];
  }
}
template void Elements::bring(const SlabTarget<float>& own, std::size_t rows, float* all) const;
template void Elements::bring(const SlabTarget<double>& own, std::size_t rows, double* all) const;

Elements::Arrays Elements::arrays(const StateView& state) {
  double* softness = softness_.empty() ? nullptr : softness_.data();
  return {constraints_.arrays(state, softness), angles_.arrays(state, nullptr), axial_.arrays(state, softness)};
}

void Elements::measure(const Arrays& arrays) {
  if (constraints_.empty() && angles_.empty()) return;
  slabs_.for_each_awake(team_, [&](int slab) {
    if (!softness_.empty()) std::fill(&softness_[0] + slabs_.begin(slab), &softness_[0] + slabs_.end(slab), 1.0);
    constraints_.measure(arrays.constraints, slab);
    angles_.measure(arrays.angles, slab);
  });
}

void Elements::add_forces(const StateView& state, Coordinates& force) {
  add_forces(
      state, force, [](int) {}, [](int) {});
}

void Elements::add_forces_of(int slab, Arrays arrays, Coordinates& force) {
  const std::int32_t begin = slabs_.begin(slab);
  const bool is_thick = slabs_.end(slab) - begin > kThick;
  const SlabTarget<double> own =
      is_thick ? SlabTarget<double>{force.data() + begin, begin, force.size() / 3} : target_for(slab, 3, force.data());
  arrays.constraints.force = arrays.angles.force = arrays.axial.force = own;
  constraints_.add_forces(arrays.constraints, slab);
  angles_.add_forces(arrays.angles, slab);
  axial_.add_forces(arrays.axial, slab);
  if (!is_thick) bring(own, 3, force.data());
}

void Elements::prepare_linearise(double h) {
  constraints_.prepare_linearise(), angles_.prepare_linearise(), axial_.prepare_linearise();
  axial_.prepare_kelvin(h, AxialForces::KelvinAt::end);
  make_room(12, 3);
}

void Elements::linearise_of(int slab, Arrays arrays, Coordinates& force, DiagonalBlocks& blocks, double* product) {
  const SlabTarget<double> own = target_for(slab, 3, force.data()), own_blocks = target_for(slab, 6, blocks.data(), 3);
  arrays.constraints.force = arrays.angles.force = arrays.axial.force = own;
  arrays.constraints.blocks = arrays.angles.blocks = arrays.axial.blocks = own_blocks;
  SlabTarget<double> own_product{};
  if (product != nullptr) own_product = target_for(slab, 3, product, 9);
  for (Multiplied* of : {&arrays.constraints.multiplied, &arrays.angles.multiplied, &arrays.axial.multiplied})
    of->product = own_product;
  constraints_.linearise(arrays.constraints, slab);
  angles_.linearise(arrays.angles, slab);
  axial_.linearise(arrays.axial, slab);
  bring(own, 3, force.data()), bring(own_blocks, 6, blocks.data());
  if (product != nullptr) bring(own_product, 3, product);
}

void Elements::apply(const double* v, double* result) const {
  slabs_.for_each_awake(team_, [&](int slab) {
    const SlabTarget<double> own = target_for(slab, 3, result);
    constraints_.apply(slab, v, own);
    angles_.apply(slab, v, own);
    axial_.apply(slab, v, own);
    bring(own, 3, result);
  });
}

template <class Real>
void Elements::apply_lagged(const Real* v, Real* result) const {
  const std::size_t n = std::size_t(slabs_.end(slabs_.count() - 1));
  slabs_.for_each_awake(team_, [&](int slab) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::fill(result + axis * n + slabs_.begin(slab), result + axis * n + slabs_.end(slab), Real(0));
    const SlabTarget<Real> own = target_for(slab, 3, result);
    constraints_.apply_lagged(slab, v, own);
    angles_.apply_lagged(slab, v, own);
    axial_.apply_lagged(slab, v, own);
    bring(own, 3, result);
  });
}
template void Elements::apply_lagged(const float* v, float* result) const;
template void Elements::apply_lagged(const double* v, double* result) const;

void Elements::find_kelvin_of(double h, AxialForces::KelvinAt at, const StateView& state, std::vector<double>& kelvin) {
  if (state.kelvin_elongation.empty()) return;
  axial_.prepare_kelvin(h, at);
  slabs_.for_each_awake(team_, [&](int slab) { axial_.find_kelvin(state, kelvin, slab); });
}

void Elements::find_kelvin(double h, const StateView& state, std::vector<double>& after) {
  find_kelvin_of(h, AxialForces::KelvinAt::end, state, after);
}

void Elements::find_acting_kelvin(double h, const StateView& state, std::vector<double>& acting) {
  find_kelvin_of(h, AxialForces::KelvinAt::acting, state, acting);
}

void Elements::finish_kelvin(const std::vector<double>& before, std::vector<double>& kelvin) const {
  const std::size_t count = kelvin.size(), parts = std::size_t(slabs_.count());
  if (count == 0) return;
  team_.for_each(slabs_.count(), [&](int slab) {
    axial_.finish_kelvin(before, kelvin, count * std::size_t(slab) / parts, count * std::size_t(slab + 1) / parts);
  });
}

}  // namespace ctpm::elements
