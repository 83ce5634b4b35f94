#include "core/elements/axial.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ctpm {
namespace {

double distance(const Vec3Array& p, std::int32_t a, std::int32_t b) {
  return norm(p[std::size_t(b)] - p[std::size_t(a)]);
}

/// Edges at most so many spheres apart share a batch.
constexpr std::int32_t kBridged = 4;

/// Elements of one kind.
struct Kind {
  const std::vector<std::int32_t>&a, &b;
  std::vector<const std::vector<double>*> parameters;  ///< rows of a batch
  AxialLaw law;
};

/// Rows of one batch's parameters, one copy of each content.
class ParameterPool {
 public:
  explicit ParameterPool(std::vector<double>& pool) : pool_(pool) {}

  /// Where the rows of `elements` begin; a place without an element has k = 0.
  std::int32_t offset_of(const Kind& kind, const std::vector<std::int32_t>& elements, bool has_dashpots) {
    std::vector<double> rows;
    for (const std::vector<double>* row : kind.parameters) {
      if (kind.law != AxialLaw::two_sphere_tpm && row == kind.parameters.back() && !has_dashpots) break;
      for (const std::int32_t element : elements) rows.push_back(element < 0 ? 0.0 : (*row)[std::size_t(element)]);
    }
    const auto [place, is_new] = known_.emplace(std::move(rows), std::int32_t(pool_.size()));
    if (is_new) pool_.insert(pool_.end(), place->first.begin(), place->first.end());
    return place->second;
  }

 private:
  std::vector<double>& pool_;
  std::map<std::vector<double>, std::int32_t> known_;
};

/// Elements of one kind that lie so that they can share a batch, and the places between them.
struct Run {
  std::size_t first, last;            ///< elements [first, last)
  std::vector<std::int32_t> element;  ///< of each place; -1: none (place_count)
};

/// The longest run from element `first` on.
Run find_run(const Kind& kind, std::size_t first, const Slabs& slabs) {
  const std::int32_t bridged = kind.law == AxialLaw::two_sphere_tpm ? 1 : kBridged;
  Run run{first, first + 1, {std::int32_t(first)}};
  const int slab_a = slabs.of(kind.a[first]), slab_b = slabs.of(kind.b[first]);
  for (; run.last < kind.a.size(); ++run.last) {
    const std::int32_t gap = kind.a[run.last] - kind.a[run.last - 1];
    if (gap < 1 || gap > bridged || kind.b[run.last] - kind.b[run.last - 1] != gap) break;
    if (run.element.size() + std::size_t(gap) > std::size_t(kBatch)) break;
    if (slabs.of(kind.a[run.last]) != slab_a || slabs.of(kind.b[run.last]) != slab_b) break;
    run.element.insert(run.element.end(), std::size_t(gap - 1), -1);
    run.element.push_back(std::int32_t(run.last));
  }
  return run;
}

bool has_dashpots(const Kind& kind, const Run& run) {
  if (kind.law != AxialLaw::spring_and_dashpot) return false;
  const std::vector<double>& c = *kind.parameters.back();
  return std::any_of(c.begin() + std::ptrdiff_t(run.first), c.begin() + std::ptrdiff_t(run.last),
                     [](double value) { return value != 0; });
}

}  // namespace

AxialElements::AxialElements(const Model& model, const Slabs& slabs, const Kernels& kernels)
    : model_(model), kernels_(kernels), of_slab_(std::size_t(slabs.count())) {
  ParameterPool pool(parameters_);
  const Edges& edges = model.edges;
  const TwoSphereTpms& tpms = model.tpms;
  const auto third_of = [&](const Kind& kind, std::int32_t element) {
    const bool has_third = kind.law != AxialLaw::two_sphere_tpm && edges.third[std::size_t(element)] >= 0;
    return has_third ? edges.third[std::size_t(element)] : kind.a[std::size_t(element)];
  };
  const auto add_places = [&](const Kind& kind, const Run& run) {
    std::int32_t last = std::int32_t(run.first);
    for (const std::int32_t element : run.element) {
      if (element >= 0) last = element;
      if (model.has_softening) third_.push_back(third_of(kind, last));
      if (model.has_scalpel()) edge_.push_back(kind.law == AxialLaw::two_sphere_tpm ? 0 : last);
    }
    place_count_ += run.element.size();
  };
  std::vector<std::pair<const Kind*, Run>> runs;
  const std::vector<double> none(edges.c.empty() ? edges.size() : 0);
  const Kind kinds[] = {
      {edges.a,
       edges.b,
       {&edges.rest_length, &edges.k, edges.c.empty() ? &none : &edges.c},
       AxialLaw::spring_and_dashpot},
      {tpms.a, tpms.b, {&tpms.rest_length, &tpms.spring_k, &tpms.kelvin_k, &tpms.kelvin_c}, AxialLaw::two_sphere_tpm}};
  for (const Kind& kind : kinds)
    for (std::size_t i = 0; i < kind.a.size(); i = runs.back().second.last)
      runs.emplace_back(&kind, find_run(kind, i, slabs));
  // All directions of a row together, so that its spheres are at hand for all of them.
  std::stable_sort(runs.begin(), runs.end(), [](const auto& r, const auto& s) {
    return r.first->a[r.second.first] < s.first->a[s.second.first];
  });
  for (int slab = 0; slab < slabs.count(); ++slab) {
    for (const auto& [kind, run] : runs) {
      const std::int32_t a = kind->a[run.first], b = kind->b[run.first];
      const bool adds_a = slabs.of(a) == slab, adds_b = slabs.of(b) == slab;
      if (!adds_a && !adds_b) continue;
      const bool viscous = has_dashpots(*kind, run);
      const bool is_spring = kind->law == AxialLaw::spring_and_dashpot && !viscous;
      of_slab_[std::size_t(slab)].push_back({std::int32_t(run.element.size()), std::int32_t(place_count_), a, b,
                                             pool.offset_of(*kind, run.element, viscous), std::int32_t(run.first),
                                             adds_a, adds_b, is_spring ? AxialLaw::spring : kind->law});
      add_places(*kind, run);
    }
    of_slab_[std::size_t(slab)].shrink_to_fit();
  }
}

AxialArrays AxialElements::arrays(const StateView& state, const double* softness) const {
  const auto or_null = [](const auto& array) { return array.empty() ? nullptr : array.data(); };
  AxialArrays m{};
  m.spheres = state.position.size();
  m.x = state.position.x.data(), m.y = state.position.y.data(), m.z = state.position.z.data();
  m.vx = state.velocity.x.data(), m.vy = state.velocity.y.data(), m.vz = state.velocity.z.data();
  m.parameters = parameters_.data();
  m.softness = softness, m.third = or_null(third_), m.edge = or_null(edge_);
  m.edge_severed = or_null(state.edge_severed), m.tpm_severed = or_null(state.tpm_severed);
  m.kelvin_elongation = state.kelvin_elongation.data();
  return m;
}

void AxialElements::add_forces(const AxialArrays& m, int slab) const {
  const Batches& batches = of_slab_[std::size_t(slab)];
  kernels_.add_axial_forces(m, batches.data(), batches.data() + batches.size());
}

void AxialElements::prepare_linearise() {
  if (across_.size() == place_count_) return;
  for (auto* array : {&root_[0], &root_[1], &root_[2], &across_}) array->assign(place_count_, 0.0f);
}

void AxialElements::linearise(AxialArrays m, int slab) {
  m.root_x = root_[0].data(), m.root_y = root_[1].data(), m.root_z = root_[2].data(), m.across = across_.data();
  const Batches& batches = of_slab_[std::size_t(slab)];
  kernels_.linearise_axial(m, batches.data(), batches.data() + batches.size());
}

template <class Real>
void AxialElements::apply(int slab, const Real* v, SlabTarget<Real> result) const {
  AxialArrays m{};
  m.spheres = model_.sphere_count();
  // The loops only read these here.
  m.root_x = const_cast<float*>(root_[0].data()), m.root_y = const_cast<float*>(root_[1].data());
  m.root_z = const_cast<float*>(root_[2].data()), m.across = const_cast<float*>(across_.data());
  const Batches& batches = of_slab_[std::size_t(slab)];
  solver_kernels<Real>(kernels_).apply_axial(m, batches.data(), batches.data() + batches.size(), v, result);
}
template void AxialElements::apply(int slab, const float* v, SlabTarget<float> result) const;
template void AxialElements::apply(int slab, const double* v, SlabTarget<double> result) const;

/// The implicit step of c z' = k2 (x - z) - k1 z of `h` [s] to a moment at which the TPM is x longer than at rest.
double AxialElements::kelvin_after(double h, const StateView& state, std::size_t t) const {
  const TwoSphereTpms& m = model_.tpms;
  const double x = distance(state.position, m.a[t], m.b[t]) - m.rest_length[t];
  const double damping = m.kelvin_c[t] / h;
  return (damping * state.kelvin_elongation[t] + m.spring_k[t] * x) / (m.spring_k[t] + m.kelvin_k[t] + damping);
}

/// Part of a step of `h` [s] after which a TPM's elongation acts: half of it, as the midpoint rule has it, or so much
/// more that no step overshoots the limit.
double AxialElements::acting_part(double h, std::size_t t) const {
  const TwoSphereTpms& m = model_.tpms;
  return std::max(0.5, 1 - m.kelvin_c[t] / (h * (m.spring_k[t] + m.kelvin_k[t])));
}

void AxialElements::find_kelvin(double h, const StateView& state, std::vector<double>& after, std::size_t first,
                                std::size_t last) const {
  for (std::size_t t = first; t < last; ++t) after[t] = kelvin_after(h, state, t);
}

void AxialElements::find_acting_kelvin(double h, const StateView& state, std::vector<double>& acting, std::size_t first,
                                       std::size_t last) const {
  for (std::size_t t = first; t < last; ++t) acting[t] = kelvin_after(acting_part(h, t) * h, state, t);
}

void AxialElements::finish_kelvin(double h, const std::vector<double>& before, std::vector<double>& kelvin,
                                  std::size_t first, std::size_t last) const {
  for (std::size_t t = first; t < last; ++t) {
    const double z = before[t];
    kelvin[t] = z + (kelvin[t] - z) / acting_part(h, t);
  }
}

}  // namespace ctpm
