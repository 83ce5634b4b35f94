#include "core/axial.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ctpm {
namespace {

double distance(const Vec3Array& p, std::int32_t a, std::int32_t b) {
  return norm(p[std::size_t(b)] - p[std::size_t(a)]);
}

/// Elements of one kind that follow each other in the Model.
struct Kind {
  const std::vector<std::int32_t>&a, &b;
  std::int32_t first;                                      ///< number of its first element
  std::vector<const std::vector<double>*> parameters;      ///< rows of a batch
  AxialLaw law;
};

/// Rows of one batch's parameters, one copy of each content.
class ParameterPool {
 public:
  explicit ParameterPool(std::vector<double>& pool) : pool_(pool) {}

  std::int32_t offset_of(const Kind& kind, std::size_t first, std::size_t count, bool has_dashpots) {
    std::vector<double> rows;
    for (const std::vector<double>* row : kind.parameters) {
      if (kind.law != AxialLaw::two_sphere_tpm && row == kind.parameters.back() && !has_dashpots) break;
      rows.insert(rows.end(), row->begin() + std::ptrdiff_t(first), row->begin() + std::ptrdiff_t(first + count));
    }
    const auto [place, is_new] = known_.emplace(std::move(rows), std::int32_t(pool_.size()));
    if (is_new) pool_.insert(pool_.end(), place->first.begin(), place->first.end());
    return place->second;
  }

 private:
  std::vector<double>& pool_;
  std::map<std::vector<double>, std::int32_t> known_;
};

bool has_dashpots(const Kind& kind, std::size_t first, std::size_t count) {
  if (kind.law != AxialLaw::spring_and_dashpot) return false;
  const std::vector<double>& c = *kind.parameters.back();
  return std::any_of(c.begin() + std::ptrdiff_t(first), c.begin() + std::ptrdiff_t(first + count),
                     [](double value) { return value != 0; });
}

}  // namespace

AxialElements::AxialElements(const Model& model, const Slabs& slabs, const Schedule& schedule, const Kernels& kernels)
    : model_(model), kernels_(kernels) {
  for (int step = 0; step < Schedule::kSteps; ++step)
    tasks_[std::size_t(step)].resize(std::size_t(schedule.task_count(step)));
  ParameterPool pool(parameters_);
  const auto place_of = [&](const Kind& kind, std::size_t i) {
    const auto [low, high] = std::minmax({slabs.of(kind.a[i]), slabs.of(kind.b[i])});
    return schedule.place(low, high);
  };
  const auto add = [&](const Kind& kind) {
    for (std::size_t i = 0, end; i < kind.a.size(); i = end) {
      const auto place = place_of(kind, i);
      for (end = i + 1; end < kind.a.size() && end - i < std::size_t(kBatch); ++end)
        if (kind.a[end] != kind.a[end - 1] + 1 || kind.b[end] != kind.b[end - 1] + 1 || place_of(kind, end) != place) break;
      AxialBatch batch{std::int32_t(end - i), kind.first + std::int32_t(i), kind.a[i], kind.b[i], 0, kind.law};
      const bool viscous = has_dashpots(kind, i, end - i);
      if (kind.law == AxialLaw::spring_and_dashpot && !viscous) batch.law = AxialLaw::spring;
      batch.parameters = pool.offset_of(kind, i, end - i, viscous);
      tasks_[std::size_t(place.first)][std::size_t(place.second)].push_back(batch);
    }
  };
  const Edges& edges = model.edges;
  const TwoSphereTpms& tpms = model.tpms;
  const std::vector<double> none(edges.c.empty() ? edges.size() : 0);
  add({edges.a, edges.b, 0, {&edges.rest_length, &edges.k, edges.c.empty() ? &none : &edges.c},
       AxialLaw::spring_and_dashpot});
  add({tpms.a, tpms.b, std::int32_t(edges.size()), {&tpms.rest_length, &tpms.spring_k, &tpms.kelvin_k, &tpms.kelvin_c},
       AxialLaw::two_sphere_tpm});
  if (model.has_softening) {
    third_ = edges.third;
    for (std::size_t i = 0; i < third_.size(); ++i)
      if (third_[i] < 0) third_[i] = edges.a[i];
    third_.insert(third_.end(), tpms.a.begin(), tpms.a.end());
  }
}

AxialArrays AxialElements::arrays(const State& state, const double* softness, double* force) const {
  const auto or_null = [](const auto& array) { return array.empty() ? nullptr : array.data(); };
  AxialArrays m{};
  m.spheres = state.position.size();
  m.x = state.position.x.data(), m.y = state.position.y.data(), m.z = state.position.z.data();
  m.vx = state.velocity.x.data(), m.vy = state.velocity.y.data(), m.vz = state.velocity.z.data();
  m.parameters = parameters_.data();
  m.softness = softness, m.third = or_null(third_);
  m.edge_severed = or_null(state.edge_severed), m.tpm_severed = or_null(state.tpm_severed);
  m.kelvin_elongation = state.kelvin_elongation.data();
  m.edge_count = std::int32_t(model_.edges.size());
  m.force = force;
  return m;
}

void AxialElements::add_forces(const AxialArrays& m, int step, int task) const {
  const Task& batches = tasks_[std::size_t(step)][std::size_t(task)];
  kernels_.add_axial_forces(m, batches.data(), batches.data() + batches.size());
}

void AxialElements::prepare_linearise() {
  const std::size_t count = model_.edges.size() + model_.tpms.size();
  if (across_.size() == count) return;
  for (auto* array : {&root_[0], &root_[1], &root_[2], &across_}) array->assign(count, 0.0);
}

void AxialElements::linearise(AxialArrays m, int step, int task) {
  m.root_x = root_[0].data(), m.root_y = root_[1].data(), m.root_z = root_[2].data(), m.across = across_.data();
  const Task& batches = tasks_[std::size_t(step)][std::size_t(task)];
  kernels_.linearise_axial(m, batches.data(), batches.data() + batches.size());
}

void AxialElements::apply(int step, int task, const double* v, double* result) const {
  AxialArrays m{};
  m.spheres = model_.sphere_count();
  // The loops only read these here.
  m.root_x = const_cast<double*>(root_[0].data()), m.root_y = const_cast<double*>(root_[1].data());
  m.root_z = const_cast<double*>(root_[2].data()), m.across = const_cast<double*>(across_.data());
  const Task& batches = tasks_[std::size_t(step)][std::size_t(task)];
  kernels_.apply_axial(m, batches.data(), batches.data() + batches.size(), v, result);
}

void AxialElements::advance_kelvin(double h, State& state) const {
  const TwoSphereTpms& m = model_.tpms;
  for (std::size_t t = 0; t < m.size(); ++t) {
    const double x = distance(state.position, m.a[t], m.b[t]) - m.rest_length[t];
    const double damping = m.kelvin_c[t] / h;
    state.kelvin_elongation[t] = (damping * state.kelvin_elongation[t] + m.spring_k[t] * x) /
                                 (m.spring_k[t] + m.kelvin_k[t] + damping);
  }
}

}  // namespace ctpm
