#include "core/solver/conjugate_gradient.h"

namespace ctpm::solver {

template <class Real>
ConjugateGradient<Real>::ConjugateGradient(const std::vector<double>& mass, const parallel::Slabs& slabs,
                                           parallel::Team& team, const elements::Kernels& kernels)
    : slabs_(slabs),
      team_(team),
      kernels_(elements::solver_kernels<Real>(kernels)),
      mass_(mass.begin(), mass.end()),
      inverse_(6 * mass.size()),
      parts_(std::size_t(slabs.count())) {
  for (auto* vector : {&solution_, &residual_, &preconditioned_, &direction_, &product_})
    vector->resize(3 * mass.size());
}

template <class Real>
elements::SolverArrays<Real> ConjugateGradient<Real>::arrays() {
  return {mass_.size(),     mass_.data(),           inverse_.data(),   solution_.data(),
          residual_.data(), preconditioned_.data(), direction_.data(), product_.data()};
}

template <class Real>
double ConjugateGradient<Real>::begin(const elements::Coordinates& residual, double scale) {
  const elements::SolverArrays<Real> m = arrays();
  scale_ = scale;
  energy_ = sum_over_slabs(slabs_, team_, parts_, [&](std::size_t begin, std::size_t end) {
    return kernels_.begin_solve(m, residual.data(), scale, begin, end);
  });
  return energy_;
}

template <class Real>
void ConjugateGradient<Real>::add_to(elements::Coordinates& x) const {
  const std::size_t n = mass_.size();
  const double factor = 1 / scale_;
  team_.for_each(slabs_.count(), [&](int slab) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = axis * n + std::size_t(slabs_.begin(slab)); i < axis * n + std::size_t(slabs_.end(slab));
           ++i)
        x[i] += factor * double(solution_[i]);
  });
}

template class ConjugateGradient<float>;
template class ConjugateGradient<double>;

}  // namespace ctpm::solver
