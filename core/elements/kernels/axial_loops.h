// Loops over axial elements; part of loops.h.

namespace ctpm::elements::CTPM_KERNELS {
namespace {

/// Unit vectors from a to b and lengths of a batch.
struct Directions {
  alignas(64) double x[kBatch], y[kBatch], z[kBatch], length[kBatch], inverse[kBatch];
};

void find_directions(const AxialArrays& m, const AxialBatch& batch, Directions& d) {
  const double *xa = m.x + batch.a, *ya = m.y + batch.a, *za = m.z + batch.a;
  const double *xb = m.x + batch.b, *yb = m.y + batch.b, *zb = m.z + batch.b;
  double* __restrict nx = d.x, * __restrict ny = d.y, * __restrict nz = d.z, * __restrict length = d.length, * __restrict inverse = d.inverse;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) {
    const double dx = xb[i] - xa[i], dy = yb[i] - ya[i], dz = zb[i] - za[i];
    const double l = root_of(dx * dx + dy * dy + dz * dz);
    const double shrink = l > kShortest ? 1 / l : 0.0;
    nx[i] = dx * shrink, ny[i] = dy * shrink, nz[i] = dz * shrink, length[i] = l, inverse[i] = shrink;
  }
}

/// Factors of the tension: that of Eq. 8 for a whole triple, from the largest tilt of its spheres, and 0 where the
/// element is severed. False: all factors are 1, and `factor` is not written.
bool find_factors(const AxialArrays& m, const AxialBatch& batch, double* __restrict factor) {
  if (m.softness == nullptr && m.severed == nullptr) return false;
  if (m.softness != nullptr) {
    const double *sa = m.softness + batch.a, *sb = m.softness + batch.b, *all = m.softness;
    const int32_t* third = m.third + batch.place;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) factor[i] = smaller(smaller(sa[i], sb[i]), all[third[i]]);
  } else {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) factor[i] = 1;
  }
  if (m.severed != nullptr) {
    const std::uint8_t* severed = m.severed;
    const int32_t* element = m.element + batch.place;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < batch.count; ++i) factor[i] = severed[element[i]] != 0 ? 0.0 : factor[i];
  }
  return true;
}

/// One loop per batch: only the force of an element is written to memory.
template <AxialLaw kLaw, bool kHasFactors>
void add_axial_forces_of(const AxialArrays& m, const AxialBatch& batch) {
  const int32_t n = batch.count;
  alignas(64) double factor[kBatch], qx[kBatch], qy[kBatch], qz[kBatch];
  if (kHasFactors && !find_factors(m, batch, factor))
    for (int32_t i = 0; i < n; ++i) factor[i] = 1;
  const double *rest = m.parameters + batch.parameters, *k = rest + n, *c = k + n;
  const double* kelvin = m.kelvin_elongation + (kLaw == AxialLaw::two_sphere_tpm ? batch.internal : 0);
  const double *xa = m.x + batch.a, *ya = m.y + batch.a, *za = m.z + batch.a;
  const double *xb = m.x + batch.b, *yb = m.y + batch.b, *zb = m.z + batch.b;
  const double *vxa = m.vx + batch.a, *vya = m.vy + batch.a, *vza = m.vz + batch.a;
  const double *vxb = m.vx + batch.b, *vyb = m.vy + batch.b, *vzb = m.vz + batch.b;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const double dx = xb[i] - xa[i], dy = yb[i] - ya[i], dz = zb[i] - za[i];
    const double length = root_of(dx * dx + dy * dy + dz * dz);
    const double shrink = length > kShortest ? 1 / length : 0.0;
    double tension = k[i] * (length - rest[i]);
    if constexpr (kLaw == AxialLaw::two_sphere_tpm) tension = k[i] * (length - rest[i] - kelvin[i]);
    if constexpr (kLaw == AxialLaw::kelvin_unit)
      tension += c[i] * shrink * (dx * (vxb[i] - vxa[i]) + dy * (vyb[i] - vya[i]) + dz * (vzb[i] - vza[i]));
    if constexpr (kHasFactors) tension *= factor[i];
    const double pull = tension * shrink;
    qx[i] = pull * dx, qy[i] = pull * dy, qz[i] = pull * dz;
  }
  if (batch.adds_a) add_to(m.force, batch.a, n, qx, qy, qz);
  if (batch.adds_b) subtract_from(m.force, batch.b, n, qx, qy, qz);
}

template <bool kHasFactors>
void add_axial_forces_with(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last) {
  for (; first != last; ++first) switch (first->law) {
      case AxialLaw::spring:
        add_axial_forces_of<AxialLaw::spring, kHasFactors>(m, *first);
        break;
      case AxialLaw::kelvin_unit:
        add_axial_forces_of<AxialLaw::kelvin_unit, kHasFactors>(m, *first);
        break;
      case AxialLaw::two_sphere_tpm:
        add_axial_forces_of<AxialLaw::two_sphere_tpm, kHasFactors>(m, *first);
        break;
    }
}

void add_axial_forces(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last) {
  if (m.softness != nullptr || m.severed != nullptr)
    add_axial_forces_with<true>(m, first, last);
  else
    add_axial_forces_with<false>(m, first, last);
}

/// The implicit step of c z' = k2 (x - z) - k1 z.
void find_kelvin(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last, double* elongation) {
  for (; first != last; ++first) {
    if (first->law != AxialLaw::two_sphere_tpm || !first->adds_a) continue;
    const double *rest = m.parameters + first->parameters, *k = rest + first->count;
    const double *xa = m.x + first->a, *ya = m.y + first->a, *za = m.z + first->a;
    const double *xb = m.x + first->b, *yb = m.y + first->b, *zb = m.z + first->b;
    const double *z = m.kelvin_elongation + first->internal, *damping = m.kelvin_step.damping + first->internal,
                 *sum = m.kelvin_step.sum + first->internal;
    double* __restrict out = elongation + first->internal;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < first->count; ++i) {
      const double dx = xb[i] - xa[i], dy = yb[i] - ya[i], dz = zb[i] - za[i];
      const double length = root_of(dx * dx + dy * dy + dz * dz);
      out[i] = (damping[i] * z[i] + k[i] * (length - rest[i])) / sum[i];
    }
  }
}

/// Tension [N] and axial coupling [kg] that act in a step of h.
void find_tension(const AxialArrays& m, const AxialBatch& batch, const Directions& d, double* __restrict tension,
                  double* __restrict coupling) {
  const int32_t n = batch.count;
  const double h = m.h, *length = d.length;
  const double *rest = m.parameters + batch.parameters, *k = rest + n, *c = k + n;
  if (batch.law == AxialLaw::two_sphere_tpm) {
    const double *damping = m.kelvin_step.damping + batch.internal, *sum = m.kelvin_step.sum + batch.internal,
                 *stiffness = m.kelvin_step.stiffness + batch.internal, *kelvin = m.kelvin_elongation + batch.internal;
    // Solving the implicit step of c z' + k1 z = k2 (x - z) for z leaves a spring with an offset.
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) {
      tension[i] = stiffness[i] * (length[i] - rest[i]) - k[i] * damping[i] * kelvin[i] / sum[i];
      coupling[i] = h * h * stiffness[i];
    }
  } else if (batch.law == AxialLaw::kelvin_unit) {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) tension[i] = k[i] * (length[i] - rest[i]), coupling[i] = h * (h * k[i] + c[i]);
    if (!m.with_dashpots) return;
    const double *vxa = m.vx + batch.a, *vya = m.vy + batch.a, *vza = m.vz + batch.a;
    const double *vxb = m.vx + batch.b, *vyb = m.vy + batch.b, *vzb = m.vz + batch.b;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i)
      tension[i] += c[i] * (d.x[i] * (vxb[i] - vxa[i]) + d.y[i] * (vyb[i] - vya[i]) + d.z[i] * (vzb[i] - vza[i]));
  } else {
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) tension[i] = k[i] * (length[i] - rest[i]), coupling[i] = h * h * k[i];
  }
}

/// Adds coupling times `v`; of the coupling of a batch, the root of the part along one direction is x, y, z, and the
/// part in all directions `all`.
template <class Real>
void multiply_batch(const AxialBatch& batch, size_t spheres, const Real* x, const Real* y, const Real* z,
                    const Real* all, const Real* v, const SlabTarget<Real>& result) {
  alignas(64) Real qx[kBatch], qy[kBatch], qz[kBatch];
  const Real *xa = v + batch.a, *ya = xa + spheres, *za = ya + spheres;
  const Real *xb = v + batch.b, *yb = xb + spheres, *zb = yb + spheres;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < batch.count; ++i) {
    const Real dx = xb[i] - xa[i], dy = yb[i] - ya[i], dz = zb[i] - za[i];
    const Real t = x[i] * dx + y[i] * dy + z[i] * dz;
    qx[i] = x[i] * t + all[i] * dx, qy[i] = y[i] * t + all[i] * dy, qz[i] = z[i] * t + all[i] * dz;
  }
  if (batch.adds_a) subtract_from(result, batch.a, batch.count, qx, qy, qz);
  if (batch.adds_b) add_to(result, batch.b, batch.count, qx, qy, qz);
}

void linearise_axial_of(const AxialArrays& m, const AxialBatch& batch) {
  const int32_t n = batch.count;
  Directions d;
  find_directions(m, batch, d);
  alignas(64) double tension[kBatch], coupling[kBatch], factor[kBatch];
  find_tension(m, batch, d, tension, coupling);
  if (find_factors(m, batch, factor)) CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) tension[i] *= factor[i], coupling[i] *= factor[i];

  // Tension stiffens across the element. Compression would soften; it is left out, which keeps the matrix positive
  // definite. The blocks are those of the rounded coupling: where it is far greater than the mass, they must balance
  // it.
  alignas(64) double q[6][kBatch], pull[3][kBatch], kept[4][kBatch];
  const double hh = m.h * m.h;
  CTPM_INDEPENDENT
  for (int32_t i = 0; i < n; ++i) {
    const double beside = in_single(hh * larger(tension[i], 0.0) * d.inverse[i]);
    const double root = root_of(larger(coupling[i] - beside, 0.0));
    const double x = in_single(d.x[i] * root), y = in_single(d.y[i] * root), z = in_single(d.z[i] * root);
    kept[0][i] = x, kept[1][i] = y, kept[2][i] = z, kept[3][i] = beside;
    q[0][i] = x * x + beside, q[1][i] = x * y, q[2][i] = x * z;
    q[3][i] = y * y + beside, q[4][i] = y * z, q[5][i] = z * z + beside;
    pull[0][i] = tension[i] * d.x[i], pull[1][i] = tension[i] * d.y[i], pull[2][i] = tension[i] * d.z[i];
  }
  float* const coupling_of[4] = {m.root_x, m.root_y, m.root_z, m.across};
  for (int32_t k = 0; k < 4; ++k) convert(kept[k], coupling_of[k] + batch.place, n);
  if (m.multiplied.v != nullptr)
    multiply_batch(batch, m.spheres, kept[0], kept[1], kept[2], kept[3], m.multiplied.v, m.multiplied.product);
  if (batch.adds_a) {
    add_to(m.force, batch.a, n, pull[0], pull[1], pull[2]);
    add_to_blocks(m.blocks, batch.a, n, q);
  }
  if (batch.adds_b) {
    subtract_from(m.force, batch.b, n, pull[0], pull[1], pull[2]);
    add_to_blocks(m.blocks, batch.b, n, q);
  }
}

void linearise_axial(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last) {
  for (; first != last; ++first) linearise_axial_of(m, *first);
}

void apply_axial(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last, const double* v,
                 SlabTarget<double> result) {
  for (; first != last; ++first) {
    Coupling<double> c;
    c.find(m.root_x, m.root_y, m.root_z, m.across, first->place, first->count);
    multiply_batch(*first, m.spheres, c.x, c.y, c.z, c.all, v, result);
  }
}

template <class Real>
void apply_axial_across(const AxialArrays& m, const AxialBatch* first, const AxialBatch* last, const Real* v,
                        SlabTarget<Real> result) {
  alignas(64) Real qx[kBatch], qy[kBatch], qz[kBatch];
  for (; first != last; ++first) {
    const AxialBatch& batch = *first;
    Coupling<Real> c;
    c.find(m.root_x, m.root_y, m.root_z, m.across, batch.place, batch.count);
    const auto find = [&](int32_t from) {
      const Real *x = v + from, *y = x + m.spheres, *z = y + m.spheres;
      CTPM_INDEPENDENT
      for (int32_t i = 0; i < batch.count; ++i) {
        const Real t = c.x[i] * x[i] + c.y[i] * y[i] + c.z[i] * z[i];
        qx[i] = c.x[i] * t + c.all[i] * x[i], qy[i] = c.y[i] * t + c.all[i] * y[i],
        qz[i] = c.z[i] * t + c.all[i] * z[i];
      }
    };
    if (batch.adds_a) find(batch.b), subtract_from(result, batch.a, batch.count, qx, qy, qz);
    if (batch.adds_b) find(batch.a), subtract_from(result, batch.b, batch.count, qx, qy, qz);
  }
}

}  // namespace
}  // namespace ctpm::elements::CTPM_KERNELS
