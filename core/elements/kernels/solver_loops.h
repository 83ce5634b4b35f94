// Loops of the solver over spheres; part of loops.h.

namespace ctpm::elements::CTPM_KERNELS {
namespace {

/// One accumulator for each number of a 64-byte cache line, whatever the instruction set.
template <class Real>
struct Lanes {
  static constexpr size_t kCount = 64 / sizeof(Real);
  using Vector __attribute__((vector_size(64))) = Real;
  Vector sum{};

  /// Adds a * b of kCount or fewer numbers, each to its own lane.
  void add_products(const Real* a, const Real* b, size_t count) {
    Vector first{}, second{};
    __builtin_memcpy(&first, a, count * sizeof(Real));
    __builtin_memcpy(&second, b, count * sizeof(Real));
    sum += first * second;
  }

  double total() const {
    double parts[kCount];
    for (size_t i = 0; i < kCount; ++i) parts[i] = double(sum[i]);
    for (size_t width = kCount / 2; width > 0; width /= 2)
      for (size_t i = 0; i < width; ++i) parts[i] += parts[i + width];
    return parts[0];
  }
};

/// a . b over spheres [begin, end), three coordinates each.
template <class Real>
double dot(size_t spheres, const Real* a, const Real* b, size_t begin, size_t end) {
  Lanes<Real> lanes;
  constexpr size_t kCount = Lanes<Real>::kCount;
  for (size_t axis = 0; axis < 3; ++axis) {
    const Real *first = a + axis * spheres, *second = b + axis * spheres;
    size_t i = begin;
    for (; i + kCount <= end; i += kCount) lanes.add_products(first + i, second + i, kCount);
    lanes.add_products(first + i, second + i, end - i);
  }
  return lanes.total();
}

template <class Real>
void invert_blocks(size_t n, const double* blocks, Real* inverse, size_t begin, size_t end) {
  const double *xx = blocks, *xy = xx + n, *xz = xy + n, *yy = xz + n, *yz = yy + n, *zz = yz + n;
  // Adjugate over determinant. The blocks are sums of a mass and of positive semidefinite parts, so the determinant is
  // positive.
  for (size_t first = begin; first < end; first += size_t(kBatch)) {
    const size_t count = end - first < size_t(kBatch) ? end - first : size_t(kBatch);
    alignas(64) double own[6][kBatch];
    CTPM_INDEPENDENT
    for (size_t j = 0; j < count; ++j) {
      const size_t i = first + j;
      const double cxx = yy[i] * zz[i] - yz[i] * yz[i], cxy = xz[i] * yz[i] - xy[i] * zz[i],
                   cxz = xy[i] * yz[i] - xz[i] * yy[i];
      const double shrink = 1 / (xx[i] * cxx + xy[i] * cxy + xz[i] * cxz);
      own[0][j] = cxx * shrink, own[1][j] = cxy * shrink, own[2][j] = cxz * shrink;
      own[3][j] = (xx[i] * zz[i] - xz[i] * xz[i]) * shrink;
      own[4][j] = (xy[i] * xz[i] - xx[i] * yz[i]) * shrink;
      own[5][j] = (xx[i] * yy[i] - xy[i] * xy[i]) * shrink;
    }
    for (size_t k = 0; k < 6; ++k) convert(own[k], inverse + k * n + first, int32_t(count));
  }
}

/// preconditioned = inverse blocks times residual; returns residual . preconditioned.
template <class Real>
double precondition(const SolverArrays<Real>& m, size_t begin, size_t end) {
  const size_t n = m.spheres;
  const Real *xx = m.inverse, *xy = xx + n, *xz = xy + n, *yy = xz + n, *yz = yy + n, *zz = yz + n;
  const Real *rx = m.residual, *ry = rx + n, *rz = ry + n;
  Real* __restrict px = m.preconditioned, * __restrict py = px + n, * __restrict pz = py + n;
  CTPM_INDEPENDENT
  for (size_t i = begin; i < end; ++i) {
    px[i] = xx[i] * rx[i] + xy[i] * ry[i] + xz[i] * rz[i];
    py[i] = xy[i] * rx[i] + yy[i] * ry[i] + yz[i] * rz[i];
    pz[i] = xz[i] * rx[i] + yz[i] * ry[i] + zz[i] * rz[i];
  }
  return dot(n, m.residual, m.preconditioned, begin, end);
}

template <class Real>
double begin_solve(const SolverArrays<Real>& m, const double* first, double scale, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    const double* in = first + axis * m.spheres;
    Real* __restrict residual = m.residual + axis * m.spheres, * __restrict solution = m.solution + axis * m.spheres, * __restrict direction = m.direction + axis * m.spheres;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) residual[i] = Real(scale * in[i]);
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) solution[i] = 0, direction[i] = 0;
  }
  return precondition(m, begin, end);
}

template <class Real>
double curvature(const SolverArrays<Real>& m, size_t begin, size_t end) {
  return dot<Real>(m.spheres, m.direction, m.product, begin, end);
}

template <class Real>
double descend(const SolverArrays<Real>& m, Real step, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    Real* __restrict solution = m.solution + axis * m.spheres, * __restrict residual = m.residual + axis * m.spheres;
    const Real *direction = m.direction + axis * m.spheres, *product = m.product + axis * m.spheres;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) solution[i] += step * direction[i], residual[i] -= step * product[i];
  }
  return precondition(m, begin, end);
}

template <class Real>
void turn(const SolverArrays<Real>& m, Real turn, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    Real* __restrict direction = m.direction + axis * m.spheres, * __restrict product = m.product + axis * m.spheres;
    const Real* preconditioned = m.preconditioned + axis * m.spheres;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) {
      const Real next = preconditioned[i] + turn * direction[i];
      direction[i] = next, product[i] = m.mass[i] * next;
    }
  }
}

double multiply_mass(size_t n, const double* mass, const double* v, double* product, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double* __restrict out = product + axis * n;
    const double* in = v + axis * n;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) out[i] = mass[i] * in[i];
  }
  return dot<double>(n, v, product, begin, end);
}

double residual_from(size_t n, const double* b, double* product, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double* __restrict out = product + axis * n;
    const double* wanted = b + axis * n;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) out[i] = wanted[i] - out[i];
  }
  return dot<double>(n, product, product, begin, end);
}

double nearest_squared(const double* x, const double* y, const double* z, const double* centre, size_t begin,
                       size_t end) {
  constexpr size_t kLanes = 8;
  double lane[kLanes];
  for (size_t l = 0; l < kLanes; ++l) lane[l] = __builtin_huge_val();
  for (size_t i = begin; i < end; i += kLanes) {
    const size_t count = end - i < kLanes ? end - i : kLanes;
    for (size_t l = 0; l < count; ++l) {
      const double dx = x[i + l] - centre[0], dy = y[i + l] - centre[1], dz = z[i + l] - centre[2];
      lane[l] = smaller(lane[l], dx * dx + dy * dy + dz * dz);
    }
  }
  double nearest = lane[0];
  for (size_t l = 1; l < kLanes; ++l) nearest = smaller(nearest, lane[l]);
  return nearest;
}

double fastest_squared(const double* x, const double* y, const double* z, size_t begin, size_t end) {
  constexpr size_t kLanes = 8;
  double lane[kLanes] = {};
  int32_t lost = 0;
  for (size_t i = begin; i < end; i += kLanes) {
    const size_t count = end - i < kLanes ? end - i : kLanes;
    for (size_t l = 0; l < count; ++l) {
      const double squared = x[i + l] * x[i + l] + y[i + l] * y[i + l] + z[i + l] * z[i + l];
      lost |= squared <= __DBL_MAX__ ? 0 : 1;
      lane[l] = larger(lane[l], squared);
    }
  }
  double fastest = 0;
  for (size_t l = 0; l < kLanes; ++l) fastest = larger(fastest, lane[l]);
  return lost != 0 ? __builtin_huge_val() : fastest;
}

}  // namespace
}  // namespace ctpm::elements::CTPM_KERNELS
