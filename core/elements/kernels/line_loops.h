// Loops over lines of three spheres; part of loops.h.

namespace ctpm::elements::CTPM_KERNELS {
namespace {

/// Couplings below this share of the mass of the sphere change the matrix by less than any solver tolerance.
constexpr double kNegligibleCoupling = 1e-6;

/// Couplings of lines below this share of the mass of the sphere are left out of the preconditioner: there they save
/// less than they cost.
constexpr double kLeadingCoupling = 0.05;

/// Below this product of four lengths [m^4] a line is degenerate.
constexpr double kLeastProduct = 1e-300;

/// Indices of one of the three spheres of each line of a batch.
template <bool kInRow>
struct Spheres {
  const int32_t* list;
  int32_t first;

  size_t operator[](int32_t i) const { return size_t(kInRow ? first + i : list[i]); }
};

/// u of a line, its squared length, and the square of half the length from A to E.
struct Tilt {
  double x, y, z, offset_squared, half_squared;
};

/// The tilts of a batch's lines.
template <bool kInRow>
struct Tilts {
  const double *x, *y, *z;
  Spheres<kInRow> a, c, e;

  Tilts(const LineArrays& m, const LineBatch& batch)
      : x(m.x),
        y(m.y),
        z(m.z),
        a{m.a + batch.place, batch.a},
        c{m.c + batch.place, batch.c},
        e{m.e + batch.place, batch.e} {}

  Tilt operator[](int32_t i) const {
    const size_t ia = a[i], ic = c[i], ie = e[i];
    const double ux = x[ic] - 0.5 * (x[ia] + x[ie]), uy = y[ic] - 0.5 * (y[ia] + y[ie]),
                 uz = z[ic] - 0.5 * (z[ia] + z[ie]);
    const double dx = x[ie] - x[ia], dy = y[ie] - y[ia], dz = z[ie] - z[ia];
    return {ux, uy, uz, ux * ux + uy * uy + uz * uz, 0.25 * (dx * dx + dy * dy + dz * dz)};
  }
};

template <class Real>
struct Three {
  Real x, y, z;
};

/// Adds the result of `act` on u, or on its rate, to the middle spheres of a batch's lines. Subtracts half of it from
/// each end.
template <class Real, class Act>
void act_in_row(const LineBatch& batch, const Real* x, const Real* y, const Real* z, const SlabTarget<Real>& target,
                const Act& act) {
  const int32_t n = batch.places;
  const Real *ax = x + batch.a, *ay = y + batch.a, *az = z + batch.a;
  const Real *cx = x + batch.c, *cy = y + batch.c, *cz = z + batch.c;
  const Real *ex = x + batch.e, *ey = y + batch.e, *ez = z + batch.e;
  const Real half = Real(0.5);
  const auto pull = [=](int32_t i) {
    return act(
        i, Three<Real>{cx[i] - half * (ax[i] + ex[i]), cy[i] - half * (ay[i] + ey[i]), cz[i] - half * (az[i] + ez[i])});
  };
  if (batch.adds_a && batch.adds_c && batch.adds_e) {
    // In one loop, so that nothing of a line is stored and read back.
    const size_t stride = target.stride;
    Real *tax = target.data + (batch.a - target.begin), *tay = tax + stride, *taz = tay + stride;
    Real *tcx = target.data + (batch.c - target.begin), *tcy = tcx + stride, *tcz = tcy + stride;
    Real *tex = target.data + (batch.e - target.begin), *tey = tex + stride, *tez = tey + stride;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) {
      const Three<Real> q = pull(i);
      tcx[i] += q.x, tcy[i] += q.y, tcz[i] += q.z;
      tax[i] -= half * q.x, tay[i] -= half * q.y, taz[i] -= half * q.z;
      tex[i] -= half * q.x, tey[i] -= half * q.y, tez[i] -= half * q.z;
    }
    return;
  }
  alignas(64) Real wholes[3][kBatch], halves[3][kBatch];
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const Three<Real> q = pull(i);
    wholes[0][i] = q.x, wholes[1][i] = q.y, wholes[2][i] = q.z;
    halves[0][i] = half * q.x, halves[1][i] = half * q.y, halves[2][i] = half * q.z;
  }
  if (batch.adds_c) add_to(target, batch.c, n, wholes[0], wholes[1], wholes[2]);
  if (batch.adds_a) subtract_from(target, batch.a, n, halves[0], halves[1], halves[2]);
  if (batch.adds_e) subtract_from(target, batch.e, n, halves[0], halves[1], halves[2]);
}

template <class Real, class Act>
void act_gathered(const LineArrays& m, const LineBatch& batch, const Real* x, const Real* y, const Real* z,
                  const SlabTarget<Real>& target, const Act& act) {
  Real *tx = target.data, *ty = tx + target.stride, *tz = ty + target.stride;
  const Real half = Real(0.5);
  for (int32_t i = 0; i < batch.places; ++i) {
    int32_t a = m.a[batch.place + i], c = m.c[batch.place + i], e = m.e[batch.place + i];
    const Three<Real> u{x[c] - half * (x[a] + x[e]), y[c] - half * (y[a] + y[e]), z[c] - half * (z[a] + z[e])};
    const Three<Real> q = act(i, u);
    a -= target.begin, c -= target.begin, e -= target.begin;
    if (batch.adds_c) tx[c] += q.x, ty[c] += q.y, tz[c] += q.z;
    if (batch.adds_a) tx[a] -= half * q.x, ty[a] -= half * q.y, tz[a] -= half * q.z;
    if (batch.adds_e) tx[e] -= half * q.x, ty[e] -= half * q.y, tz[e] -= half * q.z;
  }
}

template <class Real, class Act>
void act_on_offsets(const LineArrays& m, const LineBatch& batch, const Real* x, const Real* y, const Real* z,
                    const SlabTarget<Real>& target, const Act& act) {
  if (batch.a >= 0)
    act_in_row(batch, x, y, z, target, act);
  else
    act_gathered(m, batch, x, y, z, target, act);
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

/// k of a batch's lines, 0 where severed. The result is in `room` if any line of the Model may be severed.
const double* find_stiffness(const LineArrays& m, const LineBatch& batch, double* __restrict room) {
  const double* k = m.k + batch.place;
  if (m.severed == nullptr) return k;
  const int32_t* line = m.line + batch.place;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.places; ++i) room[i] = m.severed[line[i]] != 0 ? 0.0 : k[i];
  return room;
}

/// Eq. 2 with Eq. 8: lambda = 2 k' (1 - cos theta), and k' = k / (1 + tan theta) with the largest tilt of the lines
/// centred on the same sphere. Let l be half the vector from A to E, and r^2 = u^2 + l^2. Then
/// 1 / (1 + tan theta) = l^2 / (l^2 + root(u^2 l^2)) and 1 - cos theta = u^2 / (r^2 + root(r^2 l^2)),
/// without cancellation at small tilt.
template <bool kInRow>
void measure_constraints(const LineArrays& m, const LineBatch& batch) {
  const Tilts<kInRow> tilts(m, batch);
  alignas(64) double room[kBatch], softness[kBatch];
  const double* k = find_stiffness(m, batch, room);
  double* __restrict lambda = m.lambda + batch.place;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.places; ++i) {
    const Tilt u = tilts[i];
    const double uu = u.offset_squared, ll = u.half_squared, rr = uu + ll;
    const double soft = ll + root_of(uu * ll), drop = rr + root_of(rr * ll), product = soft * drop;
    // One division for both quotients. Where A and E meet, theta is a right angle.
    const bool is_line = product > kLeastProduct;
    const double inverse = 1 / product, right = uu > 0 ? 1.0 : 0.0;
    softness[i] = is_line ? ll * drop * inverse : 1 - right;
    lambda[i] = 2 * k[i] * (is_line ? uu * soft * inverse : right);
  }
  if (m.softness == nullptr) return;
  if (m.severed != nullptr) {
    const int32_t* line = m.line + batch.place;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.places; ++i) softness[i] = m.severed[line[i]] != 0 ? 1.0 : softness[i];
  }
  for (int32_t i = 0; i < batch.count; ++i) {
    double& least = m.softness[tilts.c[i]];
    least = smaller(least, softness[i]);
  }
}

void measure_line(const LineArrays& m, const LineBatch& batch) {
  if (m.is_constraint && batch.a >= 0) return measure_constraints<true>(m, batch);
  if (m.is_constraint) return measure_constraints<false>(m, batch);
  alignas(64) double room[kBatch];
  const double* k = find_stiffness(m, batch, room);
  for (int32_t i = 0; i < batch.places; ++i) m.lambda[batch.place + i] = k[i];
}

/// Softness of the middle spheres of a batch's lines.
struct Softness {
  const double* of;  ///< (places)
  alignas(64) double gathered[kBatch];

  void find(const LineArrays& m, const LineBatch& batch) {
    of = m.softness != nullptr && batch.a >= 0 ? m.softness + batch.c : gathered;
    if (of != gathered) return;
    const int32_t* c = m.c + batch.place;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.places; ++i) gathered[i] = m.softness != nullptr ? m.softness[c[i]] : 1.0;
  }
};

/// Adds -lambda u to the middle spheres and half of the opposite to each end.
void add_pull(const LineArrays& m, const LineBatch& batch, const Softness& found) {
  const double *softness = found.of, *lambda = m.lambda + batch.place;
  act_on_offsets(m, batch, m.x, m.y, m.z, m.force, [=](int32_t i, const Three<double>& u) {
    const double pull = -softness[i] * lambda[i];
    return Three<double>{pull * u.x, pull * u.y, pull * u.z};
  });
}

void add_line_forces(const LineArrays& m, const LineBatch& batch) {
  Softness softness;
  softness.find(m, batch);
  add_pull(m, batch, softness);
}

/// d(lambda u)/du = lambda I + 2 k' cos sin^2 along u; the softening is held, which keeps it positive definite.
template <bool kInRow>
void find_coupling(const LineArrays& m, const LineBatch& batch, const Softness& found,
                   double (*__restrict kept)[kBatch]) {
  const double hh = m.h * m.h, *lambda = m.lambda + batch.place, *softness = found.of;
  double* __restrict x = kept[0], * __restrict y = kept[1], * __restrict z = kept[2], * __restrict isotropic = kept[3];
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.places; ++i) x[i] = 0, y[i] = 0, z[i] = 0, isotropic[i] = hh * softness[i] * lambda[i];
  if (!m.is_constraint) return;
  const Tilts<kInRow> tilts(m, batch);
  alignas(64) double room[kBatch];
  const double* k = find_stiffness(m, batch, room);
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.places; ++i) {
    const Tilt u = tilts[i];
    const double rr = u.offset_squared + u.half_squared, cosine_part = 2 * k[i] - lambda[i];
    const double root = root_of(rr > 0 ? larger(hh * softness[i] * cosine_part / rr, 0.0) : 0.0);
    x[i] = root * u.x, y[i] = root * u.y, z[i] = root * u.z;
  }
}

/// Adds the lines' coupling times `v`; it is given as that of axial elements.
template <class Real>
void multiply_lines(const LineArrays& m, const LineBatch& batch, const Real* x, const Real* y, const Real* z,
                    const Real* isotropic, const Real* v, const SlabTarget<Real>& result) {
  act_on_offsets(m, batch, v, v + m.spheres, v + 2 * m.spheres, result, [=](int32_t i, const Three<Real>& r) {
    const Real t = x[i] * r.x + y[i] * r.y + z[i] * r.z, all = isotropic[i];
    return Three<Real>{x[i] * t + all * r.x, y[i] * t + all * r.y, z[i] * t + all * r.z};
  });
}

LineWeight linearise_line(const LineArrays& m, const LineBatch& batch) {
  const int32_t n = batch.places;
  alignas(64) double q[6][kBatch], kept[4][kBatch];
  Softness softness;
  softness.find(m, batch);
  add_pull(m, batch, softness);
  if (batch.a >= 0)
    find_coupling<true>(m, batch, softness, kept);
  else
    find_coupling<false>(m, batch, softness, kept);
  float* const coupling_of[4] = {m.along_x, m.along_y, m.along_z, m.isotropic};
  for (int32_t k = 0; k < 4; ++k) {
    for (int32_t i = 0; i < n; ++i) kept[k][i] = in_single(kept[k][i]);
    if (batch.adds_c) convert(kept[k], coupling_of[k] + batch.place, n);
  }

  const double *x = kept[0], *y = kept[1], *z = kept[2], *isotropic = kept[3];
  const int32_t* c = m.c + batch.place;
  int32_t matters = 0, leads = 0;
  for (int32_t i = 0; i < batch.count; ++i) {
    const double coupling = x[i] * x[i] + y[i] * y[i] + z[i] * z[i] + isotropic[i], mass = m.mass[c[i]];
    matters |= coupling >= kNegligibleCoupling * mass ? 1 : 0;
    leads |= coupling >= kLeadingCoupling * mass ? 1 : 0;
  }
  if (matters == 0) return LineWeight::negligible;
  if (m.multiplied.v != nullptr) multiply_lines(m, batch, x, y, z, isotropic, m.multiplied.v, m.multiplied.product);
  if (leads == 0) return LineWeight::light;
  for (int32_t i = 0; i < n; ++i) {
    q[0][i] = x[i] * x[i] + isotropic[i], q[1][i] = x[i] * y[i], q[2][i] = x[i] * z[i];
    q[3][i] = y[i] * y[i] + isotropic[i], q[4][i] = y[i] * z[i], q[5][i] = z[i] * z[i] + isotropic[i];
  }
  scatter_line_blocks(m, batch, q);
  return LineWeight::full;
}

template <class Real>
void apply_line(const LineArrays& m, const LineBatch& batch, const Real* v, SlabTarget<Real> result) {
  Coupling<Real> c;
  c.find(m.along_x, m.along_y, m.along_z, m.isotropic, batch.place, batch.places);
  multiply_lines(m, batch, c.x, c.y, c.z, c.all, v, result);
}

template <class Real>
void take_line_blocks(const LineArrays& m, const LineBatch& batch, const Real* v, SlabTarget<Real> result) {
  Coupling<Real> c;
  c.find(m.along_x, m.along_y, m.along_z, m.isotropic, batch.place, batch.places);
  const size_t n = m.spheres;
  const auto take = [&](const int32_t* spheres, Real share) {
    for (int32_t i = 0; i < batch.count; ++i) {
      const Real *of = v + spheres[batch.place + i], x = share * of[0], y = share * of[n], z = share * of[2 * n];
      const Real t = c.x[i] * x + c.y[i] * y + c.z[i] * z;
      Real* to = result.data + (spheres[batch.place + i] - result.begin);
      to[0] -= c.x[i] * t + c.all[i] * x, to[result.stride] -= c.y[i] * t + c.all[i] * y;
      to[2 * result.stride] -= c.z[i] * t + c.all[i] * z;
    }
  };
  if (batch.adds_c) take(m.c, Real(1));
  if (batch.adds_a) take(m.a, Real(0.25));
  if (batch.adds_e) take(m.e, Real(0.25));
}

}  // namespace
}  // namespace ctpm::elements::CTPM_KERNELS
