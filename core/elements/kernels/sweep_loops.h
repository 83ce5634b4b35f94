// Loops of the solver that sweep through chunks of spheres; part of loops.h.

namespace ctpm::elements::CTPM_KERNELS {
namespace {

/// Integers as wide as Real.
template <class Real>
struct LaneBits;
template <>
struct LaneBits<float> {
  using Int = int32_t;
};
template <>
struct LaneBits<double> {
  using Int = int64_t;
};

/// Bits of the lanes [begin, end) set, of all others clear.
template <class Int>
struct LaneMask {
  using Vector __attribute__((vector_size(kLanes * sizeof(Int)))) = Int;
  using Unaligned __attribute__((vector_size(kLanes * sizeof(Int)), aligned(alignof(Int)), may_alias)) = Int;
  Vector bits;

  CTPM_INLINE LaneMask(int32_t begin, int32_t end) {
    static constexpr Int kWindow[3 * kLanes] = {0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,
                                                -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1,
                                                0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0};
    bits = *(const Unaligned*)(kWindow + kLanes - begin) & *(const Unaligned*)(kWindow + 2 * kLanes - end);
  }
};

/// Three coordinates of consecutive spheres, one sphere a lane.
template <class Real>
struct Wide {
  using Vector __attribute__((vector_size(kLanes * sizeof(Real)))) = Real;
  using Unaligned __attribute__((vector_size(kLanes * sizeof(Real)), aligned(alignof(Real)), may_alias)) = Real;
  using Mask = LaneMask<typename LaneBits<Real>::Int>;
  Vector x, y, z;

  /// Loads the spheres from `first` on. What lies outside the slab, where another one may write, is 0.
  CTPM_INLINE void load(const Real* from, size_t stride, const Sweep& slab, int32_t first) {
    if (__builtin_expect(first >= slab.begin && first + kLanes <= slab.end, 1)) return load(from + first, stride);
    Real staged[3][kLanes] = {};
    for (int32_t i = 0; i < kLanes; ++i)
      if (first + i >= slab.begin && first + i < slab.end)
        for (size_t axis = 0; axis < 3; ++axis) staged[axis][i] = from[axis * stride + size_t(first + i)];
    load(staged[0], kLanes);
  }
  /// Stores the spheres of a chunk.
  CTPM_INLINE void store(Real* to, size_t stride, const Sweep& slab, const SweepChunk& chunk) const {
    to += chunk.first;
    if (chunk.count == kLanes) return store(to, stride);
    if (__builtin_expect(chunk.first + kLanes > slab.end, 0)) {
      Real staged[3][kLanes];
      store(staged[0], kLanes);
      for (size_t axis = 0; axis < 3; ++axis)
        for (int32_t i = 0; i < chunk.count; ++i) to[axis * stride + size_t(i)] = staged[axis][i];
      return;
    }
    Wide all;
    all.load(to, stride);
    const Mask mask(0, chunk.count);
    blend(mask, x, all.x), blend(mask, y, all.y), blend(mask, z, all.z);
    all.store(to, stride);
  }
  /// Clears the lanes from `count` on.
  CTPM_INLINE void keep(int32_t count) {
    if (count == kLanes) return;
    const Mask mask(0, count);
    const Vector none{};
    Wide kept{none, none, none};
    blend(mask, x, kept.x), blend(mask, y, kept.y), blend(mask, z, kept.z);
    *this = kept;
  }

  CTPM_INLINE void add(const Wide& other) { x += other.x, y += other.y, z += other.z; }
  CTPM_INLINE void subtract(const Wide& other) { x -= other.x, y -= other.y, z -= other.z; }

 private:
  CTPM_INLINE void load(const Real* from, size_t stride) {
    x = *(const Unaligned*)from, y = *(const Unaligned*)(from + stride), z = *(const Unaligned*)(from + 2 * stride);
  }
  CTPM_INLINE void store(Real* to, size_t stride) const {
    *(Unaligned*)to = x, *(Unaligned*)(to + stride) = y, *(Unaligned*)(to + 2 * stride) = z;
  }
  CTPM_INLINE static void blend(const Mask& mask, const Vector& inside, Vector& all) {
    using Bits = typename Mask::Vector;
    all = (Vector)(((Bits)inside & mask.bits) | ((Bits)all & ~mask.bits));
  }
};

/// Coupling of a piece, 0 in lanes without an element.
template <class Real>
struct WideCoupling {
  using Vector = typename Wide<Real>::Vector;
  Vector x, y, z, all;

  CTPM_INLINE void load(const SweepCoupling& c, const SweepPiece& piece) {
    const LaneMask<int32_t> mask(piece.begin, piece.end);
    load_one(c.root_x + piece.place, mask, x), load_one(c.root_y + piece.place, mask, y);
    load_one(c.root_z + piece.place, mask, z), load_one(c.across + piece.place, mask, all);
  }

  /// sum += coupling times v.
  CTPM_INLINE void add_product(const Wide<Real>& v, Wide<Real>& sum) const {
    const Vector t = x * v.x + y * v.y + z * v.z;
    sum.x += x * t + all * v.x, sum.y += y * t + all * v.y, sum.z += z * t + all * v.z;
  }

 private:
  CTPM_INLINE static void load_one(const float* from, const LaneMask<int32_t>& mask, Vector& to) {
    using Bits = LaneMask<int32_t>::Vector;
    using Floats = Wide<float>::Vector;
    const Floats all = *(const typename Wide<float>::Unaligned*)from;
    to = __builtin_convertvector((Floats)((Bits)all & mask.bits), Vector);
  }
};

/// x = D^-1 v of the spheres from `first` on.
template <class Real>
CTPM_INLINE void solve_blocks(const SolverArrays<Real>& m, int32_t first, const Wide<Real>& v, Wide<Real>& x) {
  using Unaligned = typename Wide<Real>::Unaligned;
  using Vector = typename Wide<Real>::Vector;
  const Real* at = m.factor + first;
  const size_t n = m.spheres;
  const Vector lxy = *(const Unaligned*)(at + n), lxz = *(const Unaligned*)(at + 2 * n),
               lyz = *(const Unaligned*)(at + 4 * n);
  const Vector y = v.y - lxy * v.x, z = v.z - lxz * v.x - lyz * y;
  x.z = *(const Unaligned*)(at + 5 * n) * z;
  x.y = *(const Unaligned*)(at + 3 * n) * y - lyz * x.z;
  x.x = *(const Unaligned*)at * v.x - lxy * x.y - lxz * x.z;
}

/// Sum of a . b, one accumulator for each lane.
template <class Real>
struct WideSum {
  typename Wide<Real>::Vector sum{};

  CTPM_INLINE void add_products(const Wide<Real>& a, const Wide<Real>& b) { sum += a.x * b.x + a.y * b.y + a.z * b.z; }
  double total() const {
    double parts[kLanes];
    for (int32_t i = 0; i < kLanes; ++i) parts[i] = double(sum[i]);
    return total_of(parts, size_t(kLanes));
  }
};

/// sum += what the spheres across hand over through their pieces: coupling times `v`.
template <class Real>
CTPM_INLINE void pull(const SweepCoupling& coupling, const SweepPiece* first, const SweepPiece* last, const Real* v,
                      size_t stride, const Sweep& slab, Wide<Real>& sum) {
  for (; first != last; ++first) {
    WideCoupling<Real> c;
    c.load(coupling, *first);
    Wide<Real> across;
    across.load(v, stride, slab, first->across);
    c.add_product(across, sum);
  }
}

template <class Real>
void sweep_up(const SolverArrays<Real>& m, const SweepCoupling& coupling, const Sweep& sweep, Real turn) {
  const size_t n = m.spheres;
  for (const SweepChunk* chunk = sweep.last; chunk-- != sweep.first;) {
    Wide<Real> sum, residual, upward;
    sum.load(m.direction, n, sweep, chunk->first), residual.load(m.residual, n, sweep, chunk->first);
    sum.x = residual.x + turn * sum.x, sum.y = residual.y + turn * sum.y, sum.z = residual.z + turn * sum.z;
    sum.store(m.direction, n, sweep, *chunk);
    pull(coupling, chunk->later, chunk->earlier, m.upward, n, sweep, sum);
    solve_blocks(m, chunk->first, sum, upward);
    sum.store(m.change, n, sweep, *chunk), upward.store(m.upward, n, sweep, *chunk);
  }
}

template <class Real>
double sweep_down(const SolverArrays<Real>& m, const SweepCoupling& coupling, const Sweep& sweep) {
  const size_t n = m.spheres;
  WideSum<Real> curvature;
  for (const SweepChunk* chunk = sweep.first; chunk != sweep.last; ++chunk) {
    Wide<Real> direction, change, lagged, upward, downward;
    direction.load(m.direction, n, sweep, chunk->first), change.load(m.change, n, sweep, chunk->first);
    lagged.load(m.lagged, n, sweep, chunk->first);
    Wide<Real> sum = direction;
    sum.subtract(change), sum.add(lagged);
    pull(coupling, chunk->earlier, chunk->beside, m.downward, n, sweep, sum);
    Wide<Real> beside{};
    pull(coupling, chunk->beside, chunk->end, m.upward, n, sweep, beside);
    sum.subtract(beside);
    solve_blocks(m, chunk->first, sum, downward);
    change.add(sum);
    change.store(m.change, n, sweep, *chunk), downward.store(m.downward, n, sweep, *chunk);
    upward.load(m.upward, n, sweep, chunk->first);
    downward.add(upward), downward.keep(chunk->count);
    curvature.add_products(direction, downward);
  }
  return curvature.total();
}

template <class Real>
double begin_solve(const SolverArrays<Real>& m, const SweepCoupling& coupling, const Sweep& sweep, const double* first,
                   double scale) {
  const size_t n = m.spheres;
  const auto begin = size_t(sweep.begin), end = size_t(sweep.end);
  for (size_t axis = 0; axis < 3; ++axis) {
    const double* in = first + axis * n;
    Real* __restrict residual = m.residual + axis * n;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) residual[i] = Real(scale * in[i]);
  }
  // Also what sweeps overwrite: lanes without an element multiply what is there by 0, which may be no number after a
  // step that failed.
  Real* const cleared[] = {m.solution, m.direction, m.upward, m.downward};
  for (Real* vector : cleared)
    for (size_t axis = 0; axis < 3; ++axis)
      __builtin_memset(vector + axis * n + begin, 0, (end - begin) * sizeof(Real));
  WideSum<Real> energy;
  for (const SweepChunk* chunk = sweep.first; chunk != sweep.last; ++chunk) {
    Wide<Real> sum, downward;
    sum.load(m.residual, n, sweep, chunk->first);
    pull(coupling, chunk->earlier, chunk->beside, m.downward, n, sweep, sum);
    solve_blocks(m, chunk->first, sum, downward);
    sum.store(m.residual, n, sweep, *chunk), downward.store(m.downward, n, sweep, *chunk);
    sum.keep(chunk->count);
    energy.add_products(sum, downward);
  }
  return energy.total();
}

template <class Real>
double descend(const SolverArrays<Real>& m, const Sweep& sweep, Real step) {
  const size_t n = m.spheres;
  const auto begin = size_t(sweep.begin), end = size_t(sweep.end);
  for (size_t axis = 0; axis < 3; ++axis) {
    Real* __restrict solution = m.solution + axis * n, * __restrict residual = m.residual + axis * n;
    const Real *upward = m.upward + axis * n, *change = m.change + axis * n;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) solution[i] += step * upward[i], residual[i] -= step * change[i];
  }
  WideSum<Real> energy;
  for (int32_t i = sweep.begin; i < sweep.end; i += kLanes) {
    Wide<Real> residual, product;
    residual.load(m.residual, n, sweep, i);
    solve_blocks(m, i, residual, product);
    energy.add_products(residual, product);
  }
  return energy.total();
}

}  // namespace
}  // namespace ctpm::elements::CTPM_KERNELS
