// The inner loops, included once per instruction set with CTPM_KERNELS naming the namespace. No pragma once: it is meant
// to be included several times. Nothing here may be an inline function of a header: compiled for a wider instruction
// set, the linker could pick it for code that runs everywhere.

#include "core/kernels/kernels.h"

// The passes of the next loop do not depend on each other, whatever the compiler can prove about its pointers.
#undef CTPM_INDEPENDENT
#ifdef __clang__
#define CTPM_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define CTPM_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace ctpm::CTPM_KERNELS {
namespace {

using std::int32_t;
using std::size_t;

/// Below this length [m] an element has no direction and gives no force.
constexpr double kShortest = 1e-12;

/// Couplings below this part of the sphere's mass change the matrix by less than any solver tolerance.
constexpr double kNegligibleCoupling = 1e-6;

/// Couplings of lines below this part of the sphere's mass are left out of the preconditioner, where they save less than
/// they cost.
constexpr double kLeadingCoupling = 0.05;

/// Accumulators of a sum; as many whatever the instruction set.
constexpr size_t kLanes = 8;

double smaller(double a, double b) { return b < a ? b : a; }
double larger(double a, double b) { return b > a ? b : a; }
double root_of(double a) { return __builtin_sqrt(a); }

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

double sum_of(const Lanes& lane) {
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

/// sum += a * b for kLanes or fewer numbers, each into its own lane.
void add_products(Lanes& sum, const double* a, const double* b, size_t count) {
  Lanes first{}, second{};
  __builtin_memcpy(&first, a, count * sizeof(double));
  __builtin_memcpy(&second, b, count * sizeof(double));
  sum += first * second;
}

/// a . b over spheres [begin, end), three coordinates each.
double dot(size_t spheres, const double* a, const double* b, size_t begin, size_t end) {
  Lanes sum{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double *first = a + axis * spheres, *second = b + axis * spheres;
    size_t i = begin;
    for (; i + kLanes <= end; i += kLanes) add_products(sum, first + i, second + i, kLanes);
    add_products(sum, first + i, second + i, end - i);
  }
  return sum_of(sum);
}

/// Unit vectors from a to b and lengths of a batch.
struct Directions {
  alignas(64) double x[kBatch], y[kBatch], z[kBatch], length[kBatch], inverse[kBatch];
};

void find_directions(const AxialArrays& m, const AxialBatch& batch, Directions& d) {
  const double *xa = m.x + batch.a, *ya = m.y + batch.a, *za = m.z + batch.a;
  const double *xb = m.x + batch.b, *yb = m.y + batch.b, *zb = m.z + batch.b;
  double *__restrict nx = d.x, *__restrict ny = d.y, *__restrict nz = d.z, *__restrict length = d.length,
         *__restrict inverse = d.inverse;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) {
    const double dx = xb[i] - xa[i], dy = yb[i] - ya[i], dz = zb[i] - za[i];
    const double l = root_of(dx * dx + dy * dy + dz * dz);
    const double shrink = l > kShortest ? 1 / l : 0.0;
    nx[i] = dx * shrink, ny[i] = dy * shrink, nz[i] = dz * shrink, length[i] = l, inverse[i] = shrink;
  }
}

/// What tension is multiplied by: Eq. 8's factor of a whole triple, from the largest tilt of its spheres, and nothing
/// where the element is severed. False: by one everywhere.
bool find_factors(const AxialArrays& m, const AxialBatch& batch, double* __restrict factor) {
  const std::uint8_t* severed =
      batch.law == AxialLaw::two_sphere_tpm ? m.tpm_severed : m.edge_severed;
  if (m.softness == nullptr && severed == nullptr) return false;
  if (m.softness != nullptr) {
    const double *sa = m.softness + batch.a, *sb = m.softness + batch.b, *all = m.softness;
    const int32_t* third = m.third + batch.first;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) factor[i] = smaller(smaller(sa[i], sb[i]), all[third[i]]);
  } else {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) factor[i] = 1;
  }
  if (severed != nullptr) {
    severed += batch.law == AxialLaw::two_sphere_tpm ? batch.first - m.edge_count : batch.first;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) factor[i] = severed[i] != 0 ? 0.0 : factor[i];
  }
  return true;
}

/// target += q for all three coordinates of a row of spheres.
void add_to(double* target, size_t spheres, int32_t count, const double* __restrict qx, const double* __restrict qy,
            const double* __restrict qz) {
  double *__restrict x = target, *__restrict y = target + spheres, *__restrict z = target + 2 * spheres;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < count; ++i) x[i] += qx[i], y[i] += qy[i], z[i] += qz[i];
}

void subtract_from(double* target, size_t spheres, int32_t count, const double* __restrict qx,
                   const double* __restrict qy, const double* __restrict qz) {
  double *__restrict x = target, *__restrict y = target + spheres, *__restrict z = target + 2 * spheres;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < count; ++i) x[i] -= qx[i], y[i] -= qy[i], z[i] -= qz[i];
}

/// blocks += q for a row of spheres.
void add_to_blocks(double* blocks, size_t spheres, int32_t count, const double (*__restrict q)[kBatch]) {
  double *xx = blocks, *xy = xx + spheres, *xz = xy + spheres, *yy = xz + spheres, *yz = yy + spheres, *zz = yz + spheres;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < count; ++i) {
    xx[i] += q[0][i], xy[i] += q[1][i], xz[i] += q[2][i];
    yy[i] += q[3][i], yz[i] += q[4][i], zz[i] += q[5][i];
  }
}

void add_axial_forces_of(const AxialArrays& m, const AxialBatch& batch) {
  const int32_t n = batch.count;
  Directions d;
  find_directions(m, batch, d);
  alignas(64) double tension[kBatch], factor[kBatch], qx[kBatch], qy[kBatch], qz[kBatch];
  const double *rest = m.parameters + batch.parameters, *k = rest + n, *c = k + n;
  if (batch.law == AxialLaw::two_sphere_tpm) {
    const double* kelvin = m.kelvin_elongation + (batch.first - m.edge_count);
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) tension[i] = k[i] * (d.length[i] - rest[i] - kelvin[i]);
  } else {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) tension[i] = k[i] * (d.length[i] - rest[i]);
  }
  if (batch.law == AxialLaw::spring_and_dashpot) {
    const double *xa = m.vx + batch.a, *ya = m.vy + batch.a, *za = m.vz + batch.a;
    const double *xb = m.vx + batch.b, *yb = m.vy + batch.b, *zb = m.vz + batch.b;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i)
      tension[i] += c[i] * (d.x[i] * (xb[i] - xa[i]) + d.y[i] * (yb[i] - ya[i]) + d.z[i] * (zb[i] - za[i]));
  }
  if (find_factors(m, batch, factor))
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) tension[i] *= factor[i];
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i)
    qx[i] = tension[i] * d.x[i], qy[i] = tension[i] * d.y[i], qz[i] = tension[i] * d.z[i];
  add_to(m.force + batch.a, m.spheres, n, qx, qy, qz);
  subtract_from(m.force + batch.b, m.spheres, n, qx, qy, qz);
}

void add_axial_forces(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last) {
  for (; first != last; ++first) add_axial_forces_of(m, *first);
}

/// Elastic tension [N] and axial coupling [kg] that act in a step of h.
void find_tension(const AxialArrays& m, const AxialBatch& batch, const double* length, double* __restrict tension,
                  double* __restrict coupling) {
  const int32_t n = batch.count;
  const double h = m.h;
  const double *rest = m.parameters + batch.parameters, *k = rest + n, *c = k + n;
  if (batch.law == AxialLaw::two_sphere_tpm) {
    const double *spring = k, *unit = c, *viscosity = c + n;
    const double* kelvin = m.kelvin_elongation + (batch.first - m.edge_count);
    // The implicit step of c z' + k1 z = k2 (x - z) is solved for z, which leaves a spring with an offset.
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) {
      const double damping = viscosity[i] / h, sum = spring[i] + unit[i] + damping;
      const double stiffness = spring[i] * (unit[i] + damping) / sum;
      tension[i] = stiffness * (length[i] - rest[i]) - spring[i] * damping * kelvin[i] / sum;
      coupling[i] = h * h * stiffness;
    }
  } else if (batch.law == AxialLaw::spring_and_dashpot) {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i)
      tension[i] = k[i] * (length[i] - rest[i]), coupling[i] = h * (h * k[i] + c[i]);
  } else {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) tension[i] = k[i] * (length[i] - rest[i]), coupling[i] = h * h * k[i];
  }
}

void linearise_axial_of(const AxialArrays& m, const AxialBatch& batch) {
  const int32_t n = batch.count;
  Directions d;
  find_directions(m, batch, d);
  alignas(64) double tension[kBatch], coupling[kBatch], factor[kBatch];
  find_tension(m, batch, d.length, tension, coupling);
  if (find_factors(m, batch, factor))
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) tension[i] *= factor[i], coupling[i] *= factor[i];

  // Tension stiffens across the element; compression would soften and is left out, which keeps the matrix positive
  // definite.
  double *__restrict mx = m.root_x + batch.first, *__restrict my = m.root_y + batch.first,
         *__restrict mz = m.root_z + batch.first, *__restrict across = m.across + batch.first;
  alignas(64) double q[6][kBatch], pull[3][kBatch];
  const double hh = m.h * m.h;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const double beside = hh * larger(tension[i], 0.0) * d.inverse[i];
    const double root = root_of(larger(coupling[i] - beside, 0.0));
    const double x = d.x[i] * root, y = d.y[i] * root, z = d.z[i] * root;
    mx[i] = x, my[i] = y, mz[i] = z, across[i] = beside;
    q[0][i] = x * x + beside, q[1][i] = x * y, q[2][i] = x * z;
    q[3][i] = y * y + beside, q[4][i] = y * z, q[5][i] = z * z + beside;
    pull[0][i] = tension[i] * d.x[i], pull[1][i] = tension[i] * d.y[i], pull[2][i] = tension[i] * d.z[i];
  }
  add_to(m.force + batch.a, m.spheres, n, pull[0], pull[1], pull[2]);
  subtract_from(m.force + batch.b, m.spheres, n, pull[0], pull[1], pull[2]);
  add_to_blocks(m.blocks + batch.a, m.spheres, n, q);
  add_to_blocks(m.blocks + batch.b, m.spheres, n, q);
}

void linearise_axial(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last) {
  for (; first != last; ++first) linearise_axial_of(m, *first);
}

void apply_axial(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last, const double* v,
                 double* result) {
  alignas(64) double qx[kBatch], qy[kBatch], qz[kBatch];
  const size_t spheres = m.spheres;
  for (; first != last; ++first) {
    const AxialBatch& batch = *first;
    const double *mx = m.root_x + batch.first, *my = m.root_y + batch.first, *mz = m.root_z + batch.first,
                 *across = m.across + batch.first;
    const double *va = v + batch.a, *vb = v + batch.b;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) {
      const double dx = vb[i] - va[i], dy = vb[spheres + size_t(i)] - va[spheres + size_t(i)],
                   dz = vb[2 * spheres + size_t(i)] - va[2 * spheres + size_t(i)];
      const double t = mx[i] * dx + my[i] * dy + mz[i] * dz;
      qx[i] = mx[i] * t + across[i] * dx, qy[i] = my[i] * t + across[i] * dy, qz[i] = mz[i] * t + across[i] * dz;
    }
    subtract_from(result + batch.a, spheres, batch.count, qx, qy, qz);
    add_to(result + batch.b, spheres, batch.count, qx, qy, qz);
  }
}

/// Positions or velocities of the three spheres of a batch's lines, gathered where they are not in a row.
struct LinePoints {
  const double *ax, *ay, *az, *cx, *cy, *cz, *ex, *ey, *ez;
  alignas(64) double gathered[9][kBatch];

  void find(const LineArrays& m, const LineBatch& batch, const double* x, const double* y, const double* z) {
    if (batch.a >= 0) {
      ax = x + batch.a, ay = y + batch.a, az = z + batch.a;
      cx = x + batch.c, cy = y + batch.c, cz = z + batch.c;
      ex = x + batch.e, ey = y + batch.e, ez = z + batch.e;
      return;
    }
    const int32_t *a = m.a + batch.first, *c = m.c + batch.first, *e = m.e + batch.first;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) {
      gathered[0][i] = x[a[i]], gathered[1][i] = y[a[i]], gathered[2][i] = z[a[i]];
      gathered[3][i] = x[c[i]], gathered[4][i] = y[c[i]], gathered[5][i] = z[c[i]];
      gathered[6][i] = x[e[i]], gathered[7][i] = y[e[i]], gathered[8][i] = z[e[i]];
    }
    ax = gathered[0], ay = gathered[1], az = gathered[2];
    cx = gathered[3], cy = gathered[4], cz = gathered[5];
    ex = gathered[6], ey = gathered[7], ez = gathered[8];
  }
};

/// Adds q to the middle spheres of a batch's lines and takes half of it from each end.
void scatter_line(const LineArrays& m, const LineBatch& batch, double* target, double (*q)[kBatch]) {
  const int32_t n = batch.count;
  const size_t spheres = m.spheres;
  if (batch.a >= 0) {
    add_to(target + batch.c, spheres, n, q[0], q[1], q[2]);
    for (int axis = 0; axis < 3; ++axis)
      CTPM_INDEPENDENT
      for (int32_t i = 0; i < n; ++i) q[axis][i] *= 0.5;
    subtract_from(target + batch.a, spheres, n, q[0], q[1], q[2]);
    subtract_from(target + batch.e, spheres, n, q[0], q[1], q[2]);
    return;
  }
  const int32_t *a = m.a + batch.first, *c = m.c + batch.first, *e = m.e + batch.first;
  for (size_t axis = 0; axis < 3; ++axis) {
    double* of_axis = target + axis * spheres;
    for (int32_t i = 0; i < n; ++i) {
      const double whole = q[axis][i], half = 0.5 * whole;
      of_axis[c[i]] += whole, of_axis[a[i]] -= half, of_axis[e[i]] -= half;
    }
  }
}

void measure_line(const LineArrays& m, const LineBatch& batch) {
  const int32_t n = batch.count;
  LinePoints p;
  p.find(m, batch, m.x, m.y, m.z);
  double *__restrict ux = m.ux + batch.first, *__restrict uy = m.uy + batch.first, *__restrict uz = m.uz + batch.first,
         *__restrict half = m.half + batch.first;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    ux[i] = p.cx[i] - 0.5 * (p.ax[i] + p.ex[i]), uy[i] = p.cy[i] - 0.5 * (p.ay[i] + p.ey[i]),
    uz[i] = p.cz[i] - 0.5 * (p.az[i] + p.ez[i]);
    const double dx = p.ex[i] - p.ax[i], dy = p.ey[i] - p.ay[i], dz = p.ez[i] - p.az[i];
    half[i] = 0.5 * root_of(dx * dx + dy * dy + dz * dz);
  }
  if (m.severed != nullptr) {
    const std::uint8_t* severed = m.severed + batch.first;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) {
      const double lives = severed[i] != 0 ? 0.0 : 1.0;
      ux[i] *= lives, uy[i] *= lives, uz[i] *= lives, half[i] *= lives;
    }
  }
  if (m.softness == nullptr) return;
  // 1 / (1 + tan theta) written so that it stays finite when A and E meet.
  alignas(64) double softness[kBatch];
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const double sum = half[i] + root_of(ux[i] * ux[i] + uy[i] * uy[i] + uz[i] * uz[i]);
    softness[i] = sum > 0 ? half[i] / sum : 1.0;
  }
  if (batch.a >= 0) {
    double* of = m.softness + batch.c;
    for (int32_t i = 0; i < n; ++i) of[i] = smaller(of[i], softness[i]);
  } else {
    const int32_t* c = m.c + batch.first;
    for (int32_t i = 0; i < n; ++i) m.softness[c[i]] = smaller(m.softness[c[i]], softness[i]);
  }
}

/// k times the softness of the middle sphere.
void find_stiffness(const LineArrays& m, const LineBatch& batch, double* __restrict stiffness) {
  const double* k = m.k + batch.first;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) stiffness[i] = k[i];
  if (m.softness == nullptr) return;
  const int32_t* c = m.c + batch.first;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) stiffness[i] *= m.softness[c[i]];
}

/// Eq. 2 with Eq. 8: lambda = 2 k' (1 - cos theta) / (1 + tan theta); the constant k of an angle spring.
void find_lambda(const LineArrays& m, const LineBatch& batch, double* __restrict stiffness, double* __restrict lambda) {
  find_stiffness(m, batch, stiffness);
  const int32_t n = batch.count;
  const double *ux = m.ux + batch.first, *uy = m.uy + batch.first, *uz = m.uz + batch.first,
               *half = m.half + batch.first;
  if (!m.is_constraint) {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) lambda[i] = stiffness[i];
    return;
  }
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const double tilt_squared = ux[i] * ux[i] + uy[i] * uy[i] + uz[i] * uz[i];
    const double hypotenuse = root_of(tilt_squared + half[i] * half[i]);
    // 1 - cos theta without its cancellation at small tilt.
    const double drop = hypotenuse > 0 ? tilt_squared / (hypotenuse * (hypotenuse + half[i])) : 0.0;
    lambda[i] = 2 * stiffness[i] * drop;
  }
}

void add_line_forces(const LineArrays& m, const LineBatch& batch) {
  const int32_t n = batch.count;
  alignas(64) double stiffness[kBatch], lambda[kBatch], q[3][kBatch];
  find_lambda(m, batch, stiffness, lambda);
  const double *ux = m.ux + batch.first, *uy = m.uy + batch.first, *uz = m.uz + batch.first;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) q[0][i] = -lambda[i] * ux[i], q[1][i] = -lambda[i] * uy[i], q[2][i] = -lambda[i] * uz[i];
  scatter_line(m, batch, m.force, q);
}

/// d(lambda u)/du = lambda I + 2 k' cos sin^2 along u; the softening is held, which keeps it positive definite.
void find_coupling(const LineArrays& m, const LineBatch& batch, const double* stiffness, const double* lambda) {
  const int32_t n = batch.count;
  const double hh = m.h * m.h;
  double *__restrict x = m.along_x + batch.first, *__restrict y = m.along_y + batch.first,
         *__restrict z = m.along_z + batch.first, *__restrict isotropic = m.isotropic + batch.first;
  const double *ux = m.ux + batch.first, *uy = m.uy + batch.first, *uz = m.uz + batch.first,
               *half = m.half + batch.first;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) isotropic[i] = hh * lambda[i];
  if (!m.is_constraint) {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) x[i] = 0, y[i] = 0, z[i] = 0;
    if (m.severed == nullptr) return;
    const std::uint8_t* severed = m.severed + batch.first;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) isotropic[i] = severed[i] != 0 ? 0.0 : isotropic[i];
    return;
  }
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const double squared = ux[i] * ux[i] + uy[i] * uy[i] + uz[i] * uz[i] + half[i] * half[i];
    const double cube = squared * root_of(squared);
    const double root = root_of(cube > 0 ? hh * 2 * stiffness[i] * half[i] / cube : 0.0);
    x[i] = root * ux[i], y[i] = root * uy[i], z[i] = root * uz[i];
  }
}

bool linearise_line(const LineArrays& m, const LineBatch& batch) {
  const int32_t n = batch.count;
  alignas(64) double stiffness[kBatch], lambda[kBatch], q[6][kBatch];
  find_lambda(m, batch, stiffness, lambda);
  const double *ux = m.ux + batch.first, *uy = m.uy + batch.first, *uz = m.uz + batch.first;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) q[0][i] = -lambda[i] * ux[i], q[1][i] = -lambda[i] * uy[i], q[2][i] = -lambda[i] * uz[i];
  scatter_line(m, batch, m.force, q);
  find_coupling(m, batch, stiffness, lambda);

  const double *x = m.along_x + batch.first, *y = m.along_y + batch.first, *z = m.along_z + batch.first,
               *isotropic = m.isotropic + batch.first;
  const int32_t *a = m.a + batch.first, *c = m.c + batch.first, *e = m.e + batch.first;
  int32_t matters = 0, leads = 0;
  for (int32_t i = 0; i < n; ++i) {
    const double coupling = x[i] * x[i] + y[i] * y[i] + z[i] * z[i] + isotropic[i], mass = m.mass[c[i]];
    matters |= coupling >= kNegligibleCoupling * mass ? 1 : 0;
    leads |= coupling >= kLeadingCoupling * mass ? 1 : 0;
  }
  if (leads == 0) return matters != 0;
  for (int32_t i = 0; i < n; ++i) {
    q[0][i] = x[i] * x[i] + isotropic[i], q[1][i] = x[i] * y[i], q[2][i] = x[i] * z[i];
    q[3][i] = y[i] * y[i] + isotropic[i], q[4][i] = y[i] * z[i], q[5][i] = z[i] * z[i] + isotropic[i];
  }
  for (size_t k = 0; k < 6; ++k) {
    double* of = m.blocks + k * m.spheres;
    for (int32_t i = 0; i < n; ++i) {
      const double whole = q[k][i], quarter = 0.25 * whole;
      of[c[i]] += whole, of[a[i]] += quarter, of[e[i]] += quarter;
    }
  }
  return true;
}

void apply_line(const LineArrays& m, const LineBatch& batch, const double* v, double* result) {
  const int32_t n = batch.count;
  LinePoints p;
  p.find(m, batch, v, v + m.spheres, v + 2 * m.spheres);
  alignas(64) double q[3][kBatch];
  const double *x = m.along_x + batch.first, *y = m.along_y + batch.first, *z = m.along_z + batch.first,
               *isotropic = m.isotropic + batch.first;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const double rx = p.cx[i] - 0.5 * (p.ax[i] + p.ex[i]), ry = p.cy[i] - 0.5 * (p.ay[i] + p.ey[i]),
                 rz = p.cz[i] - 0.5 * (p.az[i] + p.ez[i]);
    const double t = x[i] * rx + y[i] * ry + z[i] * rz;
    q[0][i] = x[i] * t + isotropic[i] * rx, q[1][i] = y[i] * t + isotropic[i] * ry, q[2][i] = z[i] * t + isotropic[i] * rz;
  }
  scatter_line(m, batch, result, q);
}

void invert_blocks(size_t n, const double* blocks, double* inverse, size_t begin, size_t end) {
  const double *xx = blocks, *xy = xx + n, *xz = xy + n, *yy = xz + n, *yz = yy + n, *zz = yz + n;
  double *__restrict ixx = inverse, *__restrict ixy = ixx + n, *__restrict ixz = ixy + n, *__restrict iyy = ixz + n,
         *__restrict iyz = iyy + n, *__restrict izz = iyz + n;
  // Adjugate over determinant; the blocks are sums of a mass and of positive parts, so the determinant is positive.
  CTPM_INDEPENDENT
  for (size_t i = begin; i < end; ++i) {
    const double cxx = yy[i] * zz[i] - yz[i] * yz[i], cxy = xz[i] * yz[i] - xy[i] * zz[i],
                 cxz = xy[i] * yz[i] - xz[i] * yy[i];
    const double shrink = 1 / (xx[i] * cxx + xy[i] * cxy + xz[i] * cxz);
    ixx[i] = cxx * shrink, ixy[i] = cxy * shrink, ixz[i] = cxz * shrink;
    iyy[i] = (xx[i] * zz[i] - xz[i] * xz[i]) * shrink;
    iyz[i] = (xy[i] * xz[i] - xx[i] * yz[i]) * shrink;
    izz[i] = (xx[i] * yy[i] - xy[i] * xy[i]) * shrink;
  }
}

/// preconditioned = inverse blocks times residual; returns residual . preconditioned.
double precondition(const SolverArrays& m, size_t begin, size_t end) {
  const size_t n = m.spheres;
  const double *xx = m.inverse, *xy = xx + n, *xz = xy + n, *yy = xz + n, *yz = yy + n, *zz = yz + n;
  const double *rx = m.residual, *ry = rx + n, *rz = ry + n;
  double *__restrict px = m.preconditioned, *__restrict py = px + n, *__restrict pz = py + n;
  CTPM_INDEPENDENT
  for (size_t i = begin; i < end; ++i) {
    px[i] = xx[i] * rx[i] + xy[i] * ry[i] + xz[i] * rz[i];
    py[i] = xy[i] * rx[i] + yy[i] * ry[i] + yz[i] * rz[i];
    pz[i] = xz[i] * rx[i] + yz[i] * ry[i] + zz[i] * rz[i];
  }
  return dot(n, m.residual, m.preconditioned, begin, end);
}

double begin_solve(const SolverArrays& m, const double* b, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double* __restrict residual = m.residual + axis * m.spheres;
    const double *product = m.product + axis * m.spheres, *wanted = b + axis * m.spheres;
    double* __restrict direction = m.direction + axis * m.spheres;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) residual[i] = wanted[i] - product[i], direction[i] = 0;
  }
  return precondition(m, begin, end);
}

double curvature(const SolverArrays& m, size_t begin, size_t end) {
  return dot(m.spheres, m.direction, m.product, begin, end);
}

double descend(const SolverArrays& m, double step, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double *__restrict solution = m.solution + axis * m.spheres, *__restrict residual = m.residual + axis * m.spheres;
    const double *direction = m.direction + axis * m.spheres, *product = m.product + axis * m.spheres;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i)
      solution[i] += step * direction[i], residual[i] -= step * product[i];
  }
  return precondition(m, begin, end);
}

void turn(const SolverArrays& m, double turn, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double *__restrict direction = m.direction + axis * m.spheres, *__restrict product = m.product + axis * m.spheres;
    const double* preconditioned = m.preconditioned + axis * m.spheres;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) {
      const double next = preconditioned[i] + turn * direction[i];
      direction[i] = next, product[i] = m.mass[i] * next;
    }
  }
}

void multiply_mass(const SolverArrays& m, const double* v, size_t begin, size_t end) {
  for (size_t axis = 0; axis < 3; ++axis) {
    double* __restrict product = m.product + axis * m.spheres;
    const double* in = v + axis * m.spheres;
    CTPM_INDEPENDENT
    for (size_t i = begin; i < end; ++i) product[i] = m.mass[i] * in[i];
  }
}

double fastest_squared(size_t n, const double* v, size_t begin, size_t end) {
  const double *x = v, *y = x + n, *z = y + n;
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

extern const Kernels kernels;
const Kernels kernels{add_axial_forces, linearise_axial, apply_axial,   measure_line, add_line_forces,
                      linearise_line,   apply_line,      invert_blocks, begin_solve,  curvature,
                      descend,          turn,            multiply_mass, fastest_squared};

}  // namespace ctpm::CTPM_KERNELS
