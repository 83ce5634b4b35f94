// Loops over lines of three spheres; part of loops.h.

namespace ctpm::CTPM_KERNELS {
namespace {

/// Couplings below this part of the sphere's mass change the matrix by less than any solver tolerance.
constexpr double kNegligibleCoupling = 1e-6;

/// Couplings of lines below this part of the sphere's mass are left out of the preconditioner, where they save less than
/// they cost.
constexpr double kLeadingCoupling = 0.05;

/// Positions or velocities of the three spheres of a batch's lines, gathered where they are not in a row.
template <class Real>
struct LinePoints {
  const Real *ax, *ay, *az, *cx, *cy, *cz, *ex, *ey, *ez;
  alignas(64) Real gathered[9][kBatch];

  void find(const LineArrays& m, const LineBatch& batch, const Real* x, const Real* y, const Real* z) {
    if (batch.a >= 0) {
      ax = x + batch.a, ay = y + batch.a, az = z + batch.a;
      cx = x + batch.c, cy = y + batch.c, cz = z + batch.c;
      ex = x + batch.e, ey = y + batch.e, ez = z + batch.e;
      return;
    }
    const int32_t *a = m.a + batch.place, *c = m.c + batch.place, *e = m.e + batch.place;
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
template <class Real>
void scatter_line(const LineArrays& m, const LineBatch& batch, const SlabTarget<Real>& target, Real (*q)[kBatch]) {
  const int32_t n = batch.count;
  alignas(64) Real half[3][kBatch];
  for (int axis = 0; axis < 3; ++axis)
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) half[axis][i] = Real(0.5) * q[axis][i];
  if (batch.a >= 0) {
    if (batch.adds_c) add_to(target, batch.c, n, q[0], q[1], q[2]);
    if (batch.adds_a) subtract_from(target, batch.a, n, half[0], half[1], half[2]);
    if (batch.adds_e) subtract_from(target, batch.e, n, half[0], half[1], half[2]);
    return;
  }
  const int32_t *a = m.a + batch.place, *c = m.c + batch.place, *e = m.e + batch.place;
  for (size_t axis = 0; axis < 3; ++axis) {
    Real* of_axis = target.data + axis * target.stride;
    if (batch.adds_c)
      for (int32_t i = 0; i < n; ++i) of_axis[c[i] - target.begin] += q[axis][i];
    if (batch.adds_a)
      for (int32_t i = 0; i < n; ++i) of_axis[a[i] - target.begin] -= half[axis][i];
    if (batch.adds_e)
      for (int32_t i = 0; i < n; ++i) of_axis[e[i] - target.begin] -= half[axis][i];
  }
}

/// Adds q to the blocks of the middle spheres and a quarter of it to those of the ends.
void scatter_line_blocks(const LineArrays& m, const LineBatch& batch, const double (*q)[kBatch]) {
  const int32_t *a = m.a + batch.place, *c = m.c + batch.place, *e = m.e + batch.place;
  for (size_t k = 0; k < 6; ++k) {
    double* of = m.blocks.data + k * m.blocks.stride;
    if (batch.adds_c)
      for (int32_t i = 0; i < batch.count; ++i) of[c[i] - m.blocks.begin] += q[k][i];
    if (batch.adds_a)
      for (int32_t i = 0; i < batch.count; ++i) of[a[i] - m.blocks.begin] += 0.25 * q[k][i];
    if (batch.adds_e)
      for (int32_t i = 0; i < batch.count; ++i) of[e[i] - m.blocks.begin] += 0.25 * q[k][i];
  }
}

void measure_line(const LineArrays& m, const LineBatch& batch) {
  const int32_t n = batch.count;
  LinePoints<double> p;
  p.find(m, batch, m.x, m.y, m.z);
  double *__restrict ux = m.ux + batch.place, *__restrict uy = m.uy + batch.place, *__restrict uz = m.uz + batch.place,
         *__restrict half = m.half + batch.place;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    ux[i] = p.cx[i] - 0.5 * (p.ax[i] + p.ex[i]), uy[i] = p.cy[i] - 0.5 * (p.ay[i] + p.ey[i]),
    uz[i] = p.cz[i] - 0.5 * (p.az[i] + p.ez[i]);
    const double dx = p.ex[i] - p.ax[i], dy = p.ey[i] - p.ay[i], dz = p.ez[i] - p.az[i];
    half[i] = 0.5 * root_of(dx * dx + dy * dy + dz * dz);
  }
  if (m.severed != nullptr) {
    const int32_t* line = m.line + batch.place;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) {
      const double lives = m.severed[line[i]] != 0 ? 0.0 : 1.0;
      ux[i] *= lives, uy[i] *= lives, uz[i] *= lives, half[i] *= lives;
    }
  }
  if (m.softness == nullptr || !batch.adds_c) return;
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
    const int32_t* c = m.c + batch.place;
    for (int32_t i = 0; i < n; ++i) m.softness[c[i]] = smaller(m.softness[c[i]], softness[i]);
  }
}

/// k times the softness of the middle sphere.
void find_stiffness(const LineArrays& m, const LineBatch& batch, double* __restrict stiffness) {
  const double* k = m.k + batch.place;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) stiffness[i] = k[i];
  if (m.softness == nullptr) return;
  const int32_t* c = m.c + batch.place;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) stiffness[i] *= m.softness[c[i]];
}

/// Eq. 2 with Eq. 8: lambda = 2 k' (1 - cos theta) / (1 + tan theta); the constant k of an angle spring.
void find_lambda(const LineArrays& m, const LineBatch& batch, double* __restrict stiffness, double* __restrict lambda) {
  find_stiffness(m, batch, stiffness);
  const int32_t n = batch.count;
  const double *ux = m.ux + batch.place, *uy = m.uy + batch.place, *uz = m.uz + batch.place,
               *half = m.half + batch.place;
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

/// -lambda u on the middle spheres, half of the opposite on the ends.
void add_pull(const LineArrays& m, const LineBatch& batch, const double* lambda) {
  alignas(64) double q[3][kBatch];
  const double *ux = m.ux + batch.place, *uy = m.uy + batch.place, *uz = m.uz + batch.place;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i)
    q[0][i] = -lambda[i] * ux[i], q[1][i] = -lambda[i] * uy[i], q[2][i] = -lambda[i] * uz[i];
  scatter_line(m, batch, m.force, q);
}

void add_line_forces(const LineArrays& m, const LineBatch& batch) {
  alignas(64) double stiffness[kBatch], lambda[kBatch];
  find_lambda(m, batch, stiffness, lambda);
  add_pull(m, batch, lambda);
}

/// d(lambda u)/du = lambda I + 2 k' cos sin^2 along u; the softening is held, which keeps it positive definite.
void find_coupling(const LineArrays& m, const LineBatch& batch, const double* stiffness, const double* lambda,
                   double (*__restrict kept)[kBatch]) {
  const int32_t n = batch.count;
  const double hh = m.h * m.h;
  double *__restrict x = kept[0], *__restrict y = kept[1], *__restrict z = kept[2], *__restrict isotropic = kept[3];
  const double *ux = m.ux + batch.place, *uy = m.uy + batch.place, *uz = m.uz + batch.place,
               *half = m.half + batch.place;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) isotropic[i] = hh * lambda[i];
  if (!m.is_constraint) {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) x[i] = 0, y[i] = 0, z[i] = 0;
    if (m.severed == nullptr) return;
    const int32_t* line = m.line + batch.place;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) isotropic[i] = m.severed[line[i]] != 0 ? 0.0 : isotropic[i];
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
  alignas(64) double stiffness[kBatch], lambda[kBatch], q[6][kBatch], kept[4][kBatch];
  find_lambda(m, batch, stiffness, lambda);
  add_pull(m, batch, lambda);
  find_coupling(m, batch, stiffness, lambda, kept);
  float* const coupling_of[4] = {m.along_x, m.along_y, m.along_z, m.isotropic};
  for (int32_t k = 0; k < 4; ++k) convert(kept[k], coupling_of[k] + batch.place, n);

  const double *x = kept[0], *y = kept[1], *z = kept[2], *isotropic = kept[3];
  const int32_t* c = m.c + batch.place;
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
  scatter_line_blocks(m, batch, q);
  return true;
}

template <class Real>
void apply_line(const LineArrays& m, const LineBatch& batch, const Real* v, SlabTarget<Real> result) {
  LinePoints<Real> p;
  p.find(m, batch, v, v + m.spheres, v + 2 * m.spheres);
  Coupling<Real> c;
  c.find(m.along_x, m.along_y, m.along_z, m.isotropic, batch.place, batch.count);
  alignas(64) Real q[3][kBatch];
  const Real half = Real(0.5);
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) {
    const Real rx = p.cx[i] - half * (p.ax[i] + p.ex[i]), ry = p.cy[i] - half * (p.ay[i] + p.ey[i]),
               rz = p.cz[i] - half * (p.az[i] + p.ez[i]);
    const Real t = c.x[i] * rx + c.y[i] * ry + c.z[i] * rz;
    q[0][i] = c.x[i] * t + c.all[i] * rx, q[1][i] = c.y[i] * t + c.all[i] * ry, q[2][i] = c.z[i] * t + c.all[i] * rz;
  }
  scatter_line(m, batch, result, q);
}

}  // namespace
}  // namespace ctpm::CTPM_KERNELS
