// Loops of the solver over spheres; part of loops.h.

namespace ctpm::elements::CTPM_KERNELS {
namespace {

/// Sum of `count` numbers, a power of 2, which it overwrites.
double total_of(double* parts, size_t count) {
  for (size_t width = count / 2; width > 0; width /= 2)
    for (size_t i = 0; i < width; ++i) parts[i] += parts[i + width];
  return parts[0];
}

/// One accumulator for each number of a 64-byte cache line, whatever the instruction set.
struct Lanes {
  static constexpr size_t kCount = 8;
  using Vector __attribute__((vector_size(64))) = double;
  Vector sum{};

  /// Adds a * b of kCount or fewer numbers, each to its own lane.
  void add_products(const double* a, const double* b, size_t count) {
    Vector first{}, second{};
    __builtin_memcpy(&first, a, count * sizeof(double));
    __builtin_memcpy(&second, b, count * sizeof(double));
    sum += first * second;
  }

  double total() const {
    double parts[kCount];
    for (size_t i = 0; i < kCount; ++i) parts[i] = sum[i];
    return total_of(parts, kCount);
  }
};

/// a . b over spheres [begin, end), three coordinates each.
double dot(size_t spheres, const double* a, const double* b, size_t begin, size_t end) {
  Lanes lanes;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double *first = a + axis * spheres, *second = b + axis * spheres;
    size_t i = begin;
    for (; i + Lanes::kCount <= end; i += Lanes::kCount) lanes.add_products(first + i, second + i, Lanes::kCount);
    lanes.add_products(first + i, second + i, end - i);
  }
  return lanes.total();
}

/// L and 1 / d of L diag(d) L^T. An inverse would be rounded by its largest entries, and be wrong where a block is far
/// stiffer along one direction than along another.
template <class Real>
void factor_blocks(size_t n, const double* blocks, Real* factor, size_t begin, size_t end) {
  const double *xx = blocks, *xy = xx + n, *xz = xy + n, *yy = xz + n, *yz = yy + n, *zz = yz + n;
  for (size_t first = begin; first < end; first += size_t(kBatch)) {
    const size_t count = end - first < size_t(kBatch) ? end - first : size_t(kBatch);
    alignas(64) double own[6][kBatch];
    CTPM_INDEPENDENT
    for (size_t j = 0; j < count; ++j) {
      const size_t i = first + j;
      const double ix = 1 / xx[i], lxy = xy[i] * ix, lxz = xz[i] * ix;
      const double iy = 1 / (yy[i] - lxy * xy[i]), dyz = yz[i] - lxy * xz[i], lyz = dyz * iy;
      own[0][j] = ix, own[1][j] = lxy, own[2][j] = lxz, own[3][j] = iy, own[4][j] = lyz;
      own[5][j] = 1 / (zz[i] - lxz * xz[i] - lyz * dyz);
    }
    for (size_t k = 0; k < 6; ++k) convert(own[k], factor + k * n + first, int32_t(count));
  }
}

double multiply_mass(size_t n, const double* mass, const double* v, double* product, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double* __restrict out = product + axis * n;
    const double* in = v + axis * n;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) out[i] = mass[i] * in[i];
  }
  return dot(n, v, product, begin, end);
}

double residual_from(size_t n, const double* b, double* product, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double* __restrict out = product + axis * n;
    const double* wanted = b + axis * n;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) out[i] = wanted[i] - out[i];
  }
  return dot(n, product, product, begin, end);
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
