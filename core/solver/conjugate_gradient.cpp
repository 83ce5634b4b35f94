#include "core/solver/conjugate_gradient.h"

#include <algorithm>

namespace ctpm::solver {

template <class Real>
ConjugateGradient<Real>::ConjugateGradient(const elements::Elements& elements, parallel::Team& team,
                                           const elements::Kernels& kernels)
    : elements_(elements),
      slabs_(elements.slabs()),
      team_(team),
      kernels_(elements::solver_kernels<Real>(kernels)),
      spheres_(std::size_t(slabs_.end(slabs_.count() - 1))),
      parts_(std::size_t(slabs_.count())) {
  constexpr auto kBeyond = std::size_t(elements::kLanes);
  factor_.resize(6 * spheres_ + kBeyond);
  for (auto* vector : {&solution_, &residual_, &direction_, &upward_, &downward_, &change_, &lagged_})
    vector->resize(3 * spheres_ + kBeyond);
}

template <class Real>
elements::SolverArrays<Real> ConjugateGradient<Real>::arrays() {
  return {spheres_,       factor_.data(),   solution_.data(), residual_.data(), direction_.data(),
          upward_.data(), downward_.data(), change_.data(),   lagged_.data()};
}

template <class Real>
double ConjugateGradient<Real>::begin(const elements::Coordinates& residual, double scale) {
  const elements::SolverArrays<Real> m = arrays();
  const elements::SweepCoupling coupling = elements_.sweep_coupling();
  scale_ = scale;
  energy_ = sum_over_slabs(slabs_, team_, parts_, [&](int slab) {
    return kernels_.begin_solve(m, coupling, elements_.sweep(slab), residual.data(), scale);
  });
  return energy_;
}

template <class Real>
void ConjugateGradient<Real>::add_to(elements::Coordinates& x) const {
  const double factor = 1 / scale_;
  slabs_.for_each_awake(team_, [&](int slab) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t from = axis * spheres_;
      for (std::size_t i = from + std::size_t(slabs_.begin(slab)); i < from + std::size_t(slabs_.end(slab)); ++i)
        x[i] += factor * double(solution_[i]);
    }
  });
}

template class ConjugateGradient<float>;
template class ConjugateGradient<double>;

}  // namespace ctpm::solver
