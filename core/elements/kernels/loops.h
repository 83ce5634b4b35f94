// The inner loops, included once per instruction set with CTPM_KERNELS naming the namespace. No pragma once: it is
// meant to be included several times. Nothing here may be an inline function of a header: compiled for a wider
// instruction set, the linker could pick it for code that runs everywhere.

#include "core/elements/kernels/kernels.h"

// The iterations of the next loop are independent, whatever the compiler can prove about its pointers.
#undef CTPM_INDEPENDENT
#ifdef __clang__
#define CTPM_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define CTPM_INDEPENDENT _Pragma("GCC ivdep")
#endif

// Functions of whole vectors, which a call would send through memory.
#undef CTPM_INLINE
#define CTPM_INLINE __attribute__((always_inline)) inline

namespace ctpm::elements::CTPM_KERNELS {
namespace {

using std::int32_t;
using std::int64_t;
using std::size_t;

/// Below this length [m] an element has no direction and gives no force.
constexpr double kShortest = 1e-12;

double smaller(double a, double b) { return b < a ? b : a; }
double larger(double a, double b) { return b > a ? b : a; }
double root_of(double a) { return __builtin_sqrt(a); }

/// Rounds to the precision of float (Veltkamp's split, in Dekker, "A floating-point technique for extending the
/// available precision", 1971), without leaving a loop over numbers of double.
double in_single(double a) {
  const double spread = a * 536870913.0;  // 2^29 + 1
  return spread - (spread - a);
}

/// Converts the numbers of a batch to another precision. This loop stands alone, because a loop that mixes precisions
/// is vectorised only for the wider count of the narrower one.
template <class From, class To>
void convert(const From* __restrict from, To* __restrict to, int32_t count) {
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < count; ++i) to[i] = To(from[i]);
}

/// Linearised coupling of a batch: the root of the part along one direction, and the part equal in all directions.
/// Single precision is far more accurate than a linearisation.
template <class Real>
struct Coupling {
  const Real *x, *y, *z, *all;
  alignas(64) Real converted[4][kBatch];

  void find(const float* along_x, const float* along_y, const float* along_z, const float* in_all, int32_t first,
            int32_t count) {
    const float* const kept[4] = {along_x + first, along_y + first, along_z + first, in_all + first};
    if constexpr (sizeof(Real) == sizeof(float)) {
      x = kept[0], y = kept[1], z = kept[2], all = kept[3];
    } else {
      for (int32_t k = 0; k < 4; ++k) convert(kept[k], converted[k], count);
      x = converted[0], y = converted[1], z = converted[2], all = converted[3];
    }
  }
};

/// target += q for all three coordinates of a row of spheres from `sphere` on.
template <class Real>
void add_to(const SlabTarget<Real>& target, int32_t sphere, int32_t count, const Real* __restrict qx,
            const Real* __restrict qy, const Real* __restrict qz) {
  Real *__restrict x = target.data + (sphere - target.begin), *__restrict y = x + target.stride,
       *__restrict z = y + target.stride;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < count; ++i) x[i] += qx[i], y[i] += qy[i], z[i] += qz[i];
}

template <class Real>
void subtract_from(const SlabTarget<Real>& target, int32_t sphere, int32_t count, const Real* __restrict qx,
                   const Real* __restrict qy, const Real* __restrict qz) {
  Real *__restrict x = target.data + (sphere - target.begin), *__restrict y = x + target.stride,
       *__restrict z = y + target.stride;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < count; ++i) x[i] -= qx[i], y[i] -= qy[i], z[i] -= qz[i];
}

/// blocks += q for a row of spheres.
void add_to_blocks(const SlabTarget<double>& blocks, int32_t sphere, int32_t count,
                   const double (*__restrict q)[kBatch]) {
  const size_t stride = blocks.stride;
  double *xx = blocks.data + (sphere - blocks.begin), *xy = xx + stride, *xz = xy + stride, *yy = xz + stride,
         *yz = yy + stride, *zz = yz + stride;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < count; ++i) {
    xx[i] += q[0][i], xy[i] += q[1][i], xz[i] += q[2][i];
    yy[i] += q[3][i], yz[i] += q[4][i], zz[i] += q[5][i];
  }
}

}  // namespace
}  // namespace ctpm::elements::CTPM_KERNELS

#include "core/elements/kernels/axial_loops.h"
#include "core/elements/kernels/cell_loops.h"
#include "core/elements/kernels/line_loops.h"
#include "core/elements/kernels/solver_loops.h"
#include "core/elements/kernels/sweep_loops.h"

namespace ctpm::elements::CTPM_KERNELS {

template <class Real>
constexpr SolverKernels<Real> solver{apply_axial_across<Real>, apply_line<Real>,  take_line_blocks<Real>,
                                     factor_blocks<Real>,      begin_solve<Real>, sweep_up<Real>,
                                     sweep_down<Real>,         descend<Real>};

extern const Kernels kernels;
const Kernels kernels{add_axial_forces, linearise_axial, apply_axial,     find_kelvin,    measure_line,
                      add_line_forces,  linearise_line,  solver<float>,   solver<double>, multiply_mass,
                      residual_from,    nearest_squared, fastest_squared, least_of_edges, least_of_cells};

}  // namespace ctpm::elements::CTPM_KERNELS
