#include "core/elements/axial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace ctpm::elements {
namespace {

/// Springs and Kelvin units at most this many spheres apart share a batch.
constexpr std::int32_t kBridged = 4;

/// Pool of parameter rows; equal rows are stored once.
class ParameterPool {
 public:
  explicit ParameterPool(std::vector<double>& pool) : pool_(pool) {}

  /// Offset of `rows` in the pool.
  std::int32_t offset_of(std::vector<double> rows) {
    const auto [place, is_new] = known_.emplace(std::move(rows), std::int32_t(pool_.size()));
    if (is_new) pool_.insert(pool_.end(), place->first.begin(), place->first.end());
    return place->second;
  }

 private:
  std::vector<double>& pool_;
  std::map<std::vector<double>, std::int32_t> known_;
};

/// Whether two elements can share a batch. Internal variables of a batch must be contiguous in State.
bool can_share(AxialLaw p, AxialLaw q) { return (p == AxialLaw::two_sphere_tpm) == (q == AxialLaw::two_sphere_tpm); }

}  // namespace

/// The longest run from row `first` on. A run of springs with at least one Kelvin unit has the law of Kelvin units.
AxialForces::Run AxialForces::find_run(std::size_t first, const parallel::Slabs& slabs) const {
  const AxialElements& axial = model_.axial;
  const std::int32_t bridged = axial.law[first] == AxialLaw::two_sphere_tpm ? 1 : kBridged;
  Run run{first, first + 1, {std::int32_t(first)}, axial.law[first]};
  const int slab_a = slabs.of(axial.a[first]), slab_b = slabs.of(axial.b[first]);
  for (; run.last < axial.size() && can_share(axial.law[run.last], run.law); ++run.last) {
    const std::int32_t gap = axial.a[run.last] - axial.a[run.last - 1];
    if (gap < 1 || gap > bridged || axial.b[run.last] - axial.b[run.last - 1] != gap) break;
    if (run.element.size() + std::size_t(gap) > std::size_t(kBatch)) break;
    if (slabs.of(axial.a[run.last]) != slab_a || slabs.of(axial.b[run.last]) != slab_b) break;
    run.element.insert(run.element.end(), std::size_t(gap - 1), -1);
    run.element.push_back(std::int32_t(run.last));
    run.law = std::max(run.law, axial.law[run.last]);
  }
  return run;
}

/// The rows of AxialBatch::parameters; a place without an element has k = 0.
std::vector<double> AxialForces::parameters_of(const Run& run) const {
  const AxialElements& axial = model_.axial;
  std::vector<double> rows;
  const auto add_row = [&](auto&& value) {
    for (const std::int32_t element : run.element) rows.push_back(element < 0 ? 0.0 : value(std::size_t(element)));
  };
  add_row([&](std::size_t i) { return axial.rest_length[i]; });
  add_row([&](std::size_t i) { return axial.k[i]; });
  if (run.law == AxialLaw::kelvin_unit) add_row([&](std::size_t i) { return axial.damping(i); });
  return rows;
}

void AxialForces::add_places(const Run& run) {
  const AxialElements& axial = model_.axial;
  auto last = std::int32_t(run.first);
  for (const std::int32_t element : run.element) {
    if (element >= 0) last = element;
    const auto row = std::size_t(last);
    if (model_.has_softening) third_.push_back(axial.third[row] >= 0 ? axial.third[row] : axial.a[row]);
    if (model_.has_scalpel()) element_.push_back(last);
  }
  place_count_ += run.element.size();
}

AxialForces::AxialForces(const Model& model, const parallel::Slabs& slabs, const Kernels& kernels)
    : model_(model), slabs_(slabs), kernels_(kernels), of_slab_(std::size_t(slabs.count())) {
  const AxialElements& axial = model.axial;
  of_internal_.resize(axial.internal_count());
  for (std::size_t i = 0; i < axial.internal.size(); ++i)
    if (axial.internal[i] >= 0) of_internal_[std::size_t(axial.internal[i])] = std::int32_t(i);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < axial.size(); i = runs.back().last) runs.push_back(find_run(i, slabs));
  // Sorts all directions of a lattice row together, so that its spheres stay in the cache.
  std::stable_sort(runs.begin(), runs.end(),
                   [&](const Run& r, const Run& s) { return axial.a[r.first] < axial.a[s.first]; });
  ParameterPool pool(parameters_);
  for (int slab = 0; slab < slabs.count(); ++slab) {
    for (const Run& run : runs) {
      const std::int32_t a = axial.a[run.first], b = axial.b[run.first];
      const bool adds_a = slabs.of(a) == slab, adds_b = slabs.of(b) == slab;
      if (!adds_a && !adds_b) continue;
      const std::int32_t internal = run.law == AxialLaw::two_sphere_tpm ? axial.internal[run.first] : 0;
      of_slab_[std::size_t(slab)].push_back({std::int32_t(run.element.size()), std::int32_t(place_count_), a, b,
                                             pool.offset_of(parameters_of(run)), internal, adds_a, adds_b, run.law});
      add_places(run);
    }
    of_slab_[std::size_t(slab)].shrink_to_fit();
  }
}

AxialArrays AxialForces::arrays(const StateView& state, const double* softness) const {
  const auto or_null = [](const auto& array) { return array.empty() ? nullptr : array.data(); };
  AxialArrays m{};
  m.spheres = state.position.size();
  m.x = state.position.x.data(), m.y = state.position.y.data(), m.z = state.position.z.data();
  m.vx = state.velocity.x.data(), m.vy = state.velocity.y.data(), m.vz = state.velocity.z.data();
  m.parameters = parameters_.data();
  m.softness = softness, m.third = or_null(third_), m.element = or_null(element_);
  m.severed = element_.empty() ? nullptr : or_null(state.axial_severed);
  m.kelvin_elongation = state.kelvin_elongation.data();
  m.kelvin_step = {kelvin_.damping.data(), kelvin_.sum.data(), kelvin_.stiffness.data()};
  return m;
}

void AxialForces::add_forces(const AxialArrays& m, int slab) const {
  const Batches& batches = of_slab_[std::size_t(slab)];
  kernels_.add_axial_forces(m, batches.data(), batches.data() + batches.size());
}

void AxialForces::prepare_linearise() {
  if (!sweeps_.empty()) return;
  for (auto* array : {&root_[0], &root_[1], &root_[2], &across_})
    array->assign(place_count_ + 2 * std::size_t(kLanes), 0.0f);
  for (int slab = 0; slab < slabs_.count(); ++slab)
    sweeps_.emplace_back(of_slab_[std::size_t(slab)], slabs_.begin(slab), slabs_.end(slab));
}

void AxialForces::linearise(AxialArrays m, int slab) {
  m.root_x = root_[0].data() + kLanes, m.root_y = root_[1].data() + kLanes, m.root_z = root_[2].data() + kLanes;
  m.across = across_.data() + kLanes;
  const Batches& batches = of_slab_[std::size_t(slab)];
  kernels_.linearise_axial(m, batches.data(), batches.data() + batches.size());
}

SweepCoupling AxialForces::sweep_coupling() const {
  return {root_[0].data() + kLanes, root_[1].data() + kLanes, root_[2].data() + kLanes, across_.data() + kLanes};
}

/// Arrays for loops that only read the coupling.
AxialArrays AxialForces::coupling_arrays() const {
  const SweepCoupling c = sweep_coupling();
  AxialArrays m{};
  m.spheres = model_.sphere_count();
  m.root_x = const_cast<float*>(c.root_x), m.root_y = const_cast<float*>(c.root_y);
  m.root_z = const_cast<float*>(c.root_z), m.across = const_cast<float*>(c.across);
  return m;
}

void AxialForces::apply(int slab, const double* v, SlabTarget<double> result) const {
  const Batches& batches = of_slab_[std::size_t(slab)];
  kernels_.apply_axial(coupling_arrays(), batches.data(), batches.data() + batches.size(), v, result);
}

template <class Real>
void AxialForces::apply_lagged(int slab, const Real* v, SlabTarget<Real> result) const {
  const Batches& batches = sweeps_[std::size_t(slab)].lagged();
  solver_kernels<Real>(kernels_).apply_axial_across(coupling_arrays(), batches.data(), batches.data() + batches.size(),
                                                    v, result);
}
template void AxialForces::apply_lagged(int slab, const float* v, SlabTarget<float> result) const;
template void AxialForces::apply_lagged(int slab, const double* v, SlabTarget<double> result) const;

/// Share of a step of `h` [s] after which the elongation of a TPM acts: 0.5 as in the midpoint rule, or more where that
/// would overshoot the limit.
double AxialForces::acting_part(double h, std::size_t variable) const {
  const AxialElements& m = model_.axial;
  const auto i = std::size_t(of_internal_[variable]);
  return std::max(0.5, 1 - m.damping(i) / (h * (m.k[i] + m.kelvin_k[i])));
}

void AxialForces::prepare_kelvin(double h, KelvinAt at) {
  const auto is_for = [&](const KelvinSteps& steps) { return steps.h == h && steps.at == at; };
  if (is_for(kelvin_)) return;
  std::swap(kelvin_, kelvin_before_);
  if (is_for(kelvin_)) return;
  for (KelvinSteps* steps : {&kelvin_, &kelvin_before_})
    for (auto* values : {&steps->share, &steps->damping, &steps->sum, &steps->stiffness})
      values->resize(of_internal_.size());
  kelvin_.h = h, kelvin_.at = at;
  fill(kelvin_);
}

void AxialForces::fill(KelvinSteps& steps) const {
  const AxialElements& m = model_.axial;
  for (std::size_t t = 0; t < of_internal_.size(); ++t) {
    const auto i = std::size_t(of_internal_[t]);
    steps.share[t] = steps.at == KelvinAt::end ? 1.0 : acting_part(steps.h, t);
    steps.damping[t] = m.damping(i) / (steps.share[t] * steps.h);
    steps.sum[t] = m.k[i] + m.kelvin_k[i] + steps.damping[t];
    steps.stiffness[t] = m.k[i] * (m.kelvin_k[i] + steps.damping[t]) / steps.sum[t];
  }
}

void AxialForces::find_kelvin(const StateView& state, std::vector<double>& kelvin, int slab) const {
  const Batches& batches = of_slab_[std::size_t(slab)];
  kernels_.find_kelvin(arrays(state, nullptr), batches.data(), batches.data() + batches.size(), kelvin.data());
}

void AxialForces::finish_kelvin(const std::vector<double>& before, std::vector<double>& kelvin, std::size_t first,
                                std::size_t last) const {
  const double *z = before.data(), *share = kelvin_.share.data();
  double* __restrict out = kelvin.data();
  for (std::size_t t = first; t < last; ++t) out[t] = z[t] + (out[t] - z[t]) / share[t];
}

}  // namespace ctpm::elements
