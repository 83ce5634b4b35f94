// Loops of the solver that sweep through chunks of spheres; part of loops.h.

namespace ctpm::elements::CTPM_KERNELS {
namespace {

/// Bytes of a vector that the instruction set has: wider ones would go through memory in pieces.
#if defined(__AVX512F__)
constexpr size_t kVectorBytes = 64;
#elif defined(__AVX__)
constexpr size_t kVectorBytes = 32;
#else
constexpr size_t kVectorBytes = 16;
#endif

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

/// Vectors of Real, of which a chunk has kLanes / kCount, and those of as many float and integers.
template <class Real>
struct Part {
  static constexpr int32_t kCount = int32_t(kVectorBytes / sizeof(Real));
  using Int = typename LaneBits<Real>::Int;
  using Vector __attribute__((vector_size(kVectorBytes))) = Real;
  using Unaligned __attribute__((vector_size(kVectorBytes), aligned(alignof(Real)), may_alias)) = Real;
  using Bits __attribute__((vector_size(kVectorBytes))) = Int;
  using UnalignedBits __attribute__((vector_size(kVectorBytes), aligned(alignof(Int)), may_alias)) = Int;
  using Floats __attribute__((vector_size(kCount * sizeof(float)))) = float;
  using UnalignedFloats __attribute__((vector_size(kCount * sizeof(float)), aligned(alignof(float)), may_alias)) =
      float;
  using FloatBits __attribute__((vector_size(kCount * sizeof(int32_t)))) = int32_t;
  using UnalignedFloatBits
      __attribute__((vector_size(kCount * sizeof(int32_t)), aligned(alignof(int32_t)), may_alias)) = int32_t;

  CTPM_INLINE static Vector load(const Real* from) { return *(const Unaligned*)from; }
  CTPM_INLINE static void store(Real* to, const Vector& v) { *(Unaligned*)to = v; }
};

/// All bits of the numbers [begin, end) of a row set, of all others clear; begin and end in [0, kLanes].
template <class Int>
struct RowMask {
  const Int *from, *until;

  CTPM_INLINE RowMask(int32_t begin, int32_t end) {
    static constexpr Int kWindow[3 * kLanes] = {0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,
                                                -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1,
                                                0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0,  0};
    from = kWindow + kLanes - begin, until = kWindow + 2 * kLanes - end;
  }
};

/// Three coordinates of consecutive spheres, one sphere a lane; as many as a vector has.
template <class Real>
struct Wide {
  using P = Part<Real>;
  using Vector = typename P::Vector;
  Vector x, y, z;

  /// Loads the spheres from `first` on. What lies outside the slab, where another one may write, is 0.
  CTPM_INLINE void load(const Real* from, size_t stride, const Sweep& slab, int32_t first) {
    if (__builtin_expect(first >= slab.begin && first + P::kCount <= slab.end, 1)) return load(from + first, stride);
    Real staged[3][P::kCount] = {};
    for (int32_t i = 0; i < P::kCount; ++i)
      if (first + i >= slab.begin && first + i < slab.end)
        for (size_t axis = 0; axis < 3; ++axis) staged[axis][i] = from[axis * stride + size_t(first + i)];
    load(staged[0], size_t(P::kCount));
  }
  /// Stores `count` spheres from `first` on, or all lanes if there are more.
  CTPM_INLINE void store(Real* to, size_t stride, const Sweep& slab, int32_t first, int32_t count) const {
    to += first;
    if (count >= P::kCount) return store(to, stride);
    if (__builtin_expect(first + P::kCount > slab.end, 0)) {
      Real staged[3][P::kCount];
      store(staged[0], size_t(P::kCount));
      for (size_t axis = 0; axis < 3; ++axis)
        for (int32_t i = 0; i < count; ++i) to[axis * stride + size_t(i)] = staged[axis][i];
      return;
    }
    Wide all;
    all.load(to, stride);
    const typename P::Bits bits = bits_until(count);
    all.x = blend(bits, x, all.x), all.y = blend(bits, y, all.y), all.z = blend(bits, z, all.z);
    all.store(to, stride);
  }
  /// Clears the lanes from `count` on.
  CTPM_INLINE void keep(int32_t count) {
    if (count >= P::kCount) return;
    const typename P::Bits bits = bits_until(count);
    const Vector none{};
    x = blend(bits, x, none), y = blend(bits, y, none), z = blend(bits, z, none);
  }

  CTPM_INLINE void add(const Wide& other) { x += other.x, y += other.y, z += other.z; }
  CTPM_INLINE void subtract(const Wide& other) { x -= other.x, y -= other.y, z -= other.z; }

 private:
  CTPM_INLINE void load(const Real* from, size_t stride) {
    x = P::load(from), y = P::load(from + stride), z = P::load(from + 2 * stride);
  }
  CTPM_INLINE void store(Real* to, size_t stride) const {
    P::store(to, x), P::store(to + stride, y), P::store(to + 2 * stride, z);
  }
  CTPM_INLINE static typename P::Bits bits_until(int32_t count) {
    const RowMask<typename P::Int> mask(0, count);
    return *(const typename P::UnalignedBits*)mask.until;
  }
  CTPM_INLINE static Vector blend(const typename P::Bits& bits, const Vector& inside, const Vector& outside) {
    using Bits = typename P::Bits;
    return (Vector)(((Bits)inside & bits) | ((Bits)outside & ~bits));
  }
};

/// Coupling of the lanes of a piece from `lane` on, 0 in those without an element.
template <class Real>
struct WideCoupling {
  using P = Part<Real>;
  using Vector = typename P::Vector;
  Vector x, y, z, all;

  CTPM_INLINE WideCoupling(const SweepCoupling& c, const SweepPiece& piece, int32_t lane) {
    const RowMask<int32_t> mask(piece.begin, piece.end);
    const typename P::FloatBits bits = *(const typename P::UnalignedFloatBits*)(mask.from + lane) &
                                       *(const typename P::UnalignedFloatBits*)(mask.until + lane);
    const int32_t at = piece.place + lane;
    x = load(c.root_x + at, bits), y = load(c.root_y + at, bits), z = load(c.root_z + at, bits);
    all = load(c.across + at, bits);
  }

  /// sum += coupling times v.
  CTPM_INLINE void add_product(const Wide<Real>& v, Wide<Real>& sum) const {
    const Vector t = x * v.x + y * v.y + z * v.z;
    sum.x += x * t + all * v.x, sum.y += y * t + all * v.y, sum.z += z * t + all * v.z;
  }

 private:
  CTPM_INLINE static Vector load(const float* from, const typename P::FloatBits& bits) {
    using Floats = typename P::Floats;
    using FloatBits = typename P::FloatBits;
    const Floats every = *(const typename P::UnalignedFloats*)from;
    const Floats kept = (Floats)((FloatBits)every & bits);
    if constexpr (sizeof(Real) == sizeof(float))
      return kept;
    else
      return __builtin_convertvector(kept, Vector);
  }
};

/// x = D^-1 v of the spheres from `first` on.
template <class Real>
CTPM_INLINE void solve_blocks(const SolverArrays<Real>& m, int32_t first, const Wide<Real>& v, Wide<Real>& x) {
  using P = Part<Real>;
  using Vector = typename P::Vector;
  const Real* at = m.factor + first;
  const size_t n = m.spheres;
  const Vector lxy = P::load(at + n), lxz = P::load(at + 2 * n), lyz = P::load(at + 4 * n);
  const Vector y = v.y - lxy * v.x, z = v.z - lxz * v.x - lyz * y;
  x.z = P::load(at + 5 * n) * z;
  x.y = P::load(at + 3 * n) * y - lyz * x.z;
  x.x = P::load(at) * v.x - lxy * x.y - lxz * x.z;
}

/// Sum of a . b, one accumulator for each lane of a chunk.
template <class Real>
struct WideSum {
  using P = Part<Real>;
  typename P::Vector sum[kLanes / P::kCount]{};

  CTPM_INLINE void add_products(const Wide<Real>& a, const Wide<Real>& b, int32_t lane) {
    sum[lane / P::kCount] += a.x * b.x + a.y * b.y + a.z * b.z;
  }
  double total() const {
    double parts[kLanes];
    for (int32_t i = 0; i < kLanes; ++i) parts[i] = double(sum[i / P::kCount][i % P::kCount]);
    return total_of(parts, size_t(kLanes));
  }
};

// The vectors of a chunk do not depend on each other: pieces couple its spheres with other chunks, or are lagged.

/// sum += what the spheres across hand over through their pieces to the lanes from `lane` on: coupling times `v`.
template <class Real>
CTPM_INLINE void pull(const SweepCoupling& coupling, const SweepPiece* first, const SweepPiece* last, const Real* v,
                      size_t stride, const Sweep& slab, int32_t lane, Wide<Real>& sum) {
  for (; first != last; ++first) {
    const WideCoupling<Real> c(coupling, *first, lane);
    Wide<Real> across;
    across.load(v, stride, slab, first->across + lane);
    c.add_product(across, sum);
  }
}

template <class Real>
void sweep_up(const SolverArrays<Real>& m, const SweepCoupling& coupling, const Sweep& sweep, Real turn) {
  const size_t n = m.spheres;
  for (const SweepChunk* chunk = sweep.last; chunk-- != sweep.first;)
    for (int32_t lane = 0; lane < chunk->count; lane += Part<Real>::kCount) {
      const int32_t at = chunk->first + lane, count = chunk->count - lane;
      Wide<Real> sum, residual, upward;
      sum.load(m.direction, n, sweep, at), residual.load(m.residual, n, sweep, at);
      sum.x = residual.x + turn * sum.x, sum.y = residual.y + turn * sum.y, sum.z = residual.z + turn * sum.z;
      sum.store(m.direction, n, sweep, at, count);
      pull(coupling, chunk->later, chunk->earlier, m.upward, n, sweep, lane, sum);
      solve_blocks(m, at, sum, upward);
      sum.store(m.change, n, sweep, at, count), upward.store(m.upward, n, sweep, at, count);
    }
}

template <class Real>
double sweep_down(const SolverArrays<Real>& m, const SweepCoupling& coupling, const Sweep& sweep) {
  const size_t n = m.spheres;
  WideSum<Real> curvature;
  for (const SweepChunk* chunk = sweep.first; chunk != sweep.last; ++chunk)
    for (int32_t lane = 0; lane < chunk->count; lane += Part<Real>::kCount) {
      const int32_t at = chunk->first + lane, count = chunk->count - lane;
      Wide<Real> direction, change, lagged, upward, downward;
      direction.load(m.direction, n, sweep, at), change.load(m.change, n, sweep, at);
      lagged.load(m.lagged, n, sweep, at);
      Wide<Real> sum = direction;
      sum.subtract(change), sum.add(lagged);
      pull(coupling, chunk->earlier, chunk->beside, m.downward, n, sweep, lane, sum);
      Wide<Real> beside{};
      pull(coupling, chunk->beside, chunk->end, m.upward, n, sweep, lane, beside);
      sum.subtract(beside);
      solve_blocks(m, at, sum, downward);
      change.add(sum);
      change.store(m.change, n, sweep, at, count), downward.store(m.downward, n, sweep, at, count);
      upward.load(m.upward, n, sweep, at);
      downward.add(upward), downward.keep(count);
      curvature.add_products(direction, downward, lane);
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
  for (const SweepChunk* chunk = sweep.first; chunk != sweep.last; ++chunk)
    for (int32_t lane = 0; lane < chunk->count; lane += Part<Real>::kCount) {
      const int32_t at = chunk->first + lane, count = chunk->count - lane;
      Wide<Real> sum, downward;
      sum.load(m.residual, n, sweep, at);
      pull(coupling, chunk->earlier, chunk->beside, m.downward, n, sweep, lane, sum);
      solve_blocks(m, at, sum, downward);
      sum.store(m.residual, n, sweep, at, count), downward.store(m.downward, n, sweep, at, count);
      sum.keep(count);
      energy.add_products(sum, downward, lane);
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
  for (int32_t i = sweep.begin; i < sweep.end; i += Part<Real>::kCount) {
    Wide<Real> residual, product;
    residual.load(m.residual, n, sweep, i);
    solve_blocks(m, i, residual, product);
    energy.add_products(residual, product, (i - sweep.begin) % kLanes);
  }
  return energy.total();
}

}  // namespace
}  // namespace ctpm::elements::CTPM_KERNELS
