#include "core/axial.h"

#include <algorithm>
#include <cmath>

namespace ctpm {
namespace {

/// Below this length [m] an element has no direction and gives no force.
constexpr double kShortest = 1e-12;

double distance(const Vec3Array& p, std::int32_t a, std::int32_t b) {
  return norm(p[std::size_t(b)] - p[std::size_t(a)]);
}

}  // namespace

AxialElements::AxialElements(const Model& model)
    : model_(model), edge_count_(std::int32_t(model.edges.size())) {
  const auto group = [&](const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b,
                         std::int32_t offset) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const bool goes_on = i > 0 && a[i] == a[i - 1] + 1 && b[i] == b[i - 1] + 1;
      if (goes_on)
        ++runs_.back().count;
      else
        runs_.push_back({offset + std::int32_t(i), 1, a[i], b[i]});
    }
  };
  group(model.edges.a, model.edges.b, 0);
  group(model.tpms.a, model.tpms.b, edge_count_);
  const std::size_t count = model.edges.size() + model.tpms.size();
  for (auto* array : {&direction_[0], &direction_[1], &direction_[2], &root_[0], &root_[1], &root_[2],
                      &transverse_, &tension_, &stiffness_})
    array->assign(count, 0.0);
  if (model.has_softening) {
    third_ = model.edges.third;
    for (std::size_t i = 0; i < third_.size(); ++i)
      if (third_[i] < 0) third_[i] = model.edges.a[i];
    third_.insert(third_.end(), model.tpms.a.begin(), model.tpms.a.end());
  }
}

void AxialElements::linearise(const State& state, std::span<const double> softness, double h,
                              Coordinates& force, DiagonalBlocks& blocks) {
  for (const Run& run : runs_) linearise_run(run, state, softness, h, force, blocks);
}

void AxialElements::linearise_run(const Run& run, const State& state, std::span<const double> softness,
                                  double h, Coordinates& force, DiagonalBlocks& blocks) {
  const auto n = std::size_t(run.count), e0 = std::size_t(run.first), a0 = std::size_t(run.a),
             b0 = std::size_t(run.b);
  const std::size_t spheres = state.position.size();
  const bool is_tpm = run.first >= edge_count_;
  const std::size_t t0 = is_tpm ? e0 - std::size_t(edge_count_) : 0;

  // Direction and length.
  const double *xa = &state.position.x[a0], *ya = &state.position.y[a0], *za = &state.position.z[a0];
  const double *xb = &state.position.x[b0], *yb = &state.position.y[b0], *zb = &state.position.z[b0];
  double* __restrict nx = &direction_[0][e0], * __restrict ny = &direction_[1][e0], * __restrict nz = &direction_[2][e0];
  double* __restrict length = &transverse_[e0];  // the coupling takes its place below
  for (std::size_t i = 0; i < n; ++i) {
    const double dx = xb[i] - xa[i], dy = yb[i] - ya[i], dz = zb[i] - za[i];
    const double l = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double inverse = l > kShortest ? 1 / l : 0.0;
    nx[i] = dx * inverse, ny[i] = dy * inverse, nz[i] = dz * inverse, length[i] = l;
  }

  // Elastic tension and axial stiffness that act in this step.
  double* __restrict tension = &tension_[e0], * __restrict stiffness = &stiffness_[e0];
  if (is_tpm) {
    const TwoSphereTpms& m = model_.tpms;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t t = t0 + i;
      // The implicit step of c z' + k1 z = k2 (x - z) is solved for z, which leaves a spring with an offset.
      const double damping = m.kelvin_c[t] / h, sum = m.spring_k[t] + m.kelvin_k[t] + damping;
      const double x = length[i] - m.rest_length[t];
      const double k = m.spring_k[t] * (m.kelvin_k[t] + damping) / sum;
      tension[i] = k * x - m.spring_k[t] * damping * state.kelvin_elongation[t] / sum;
      stiffness[i] = h * h * k;
    }
  } else if (model_.edges.c.empty()) {
    const double *k = &model_.edges.k[e0], *rest = &model_.edges.rest_length[e0];
    for (std::size_t i = 0; i < n; ++i)
      tension[i] = k[i] * (length[i] - rest[i]), stiffness[i] = h * h * k[i];
  } else {
    const double *k = &model_.edges.k[e0], *c = &model_.edges.c[e0], *rest = &model_.edges.rest_length[e0];
    for (std::size_t i = 0; i < n; ++i)
      tension[i] = k[i] * (length[i] - rest[i]), stiffness[i] = h * (h * k[i] + c[i]);
  }

  // Eq. 8: one factor for a whole triple, from the largest tilt of its spheres.
  if (!softness.empty()) {
    const double *sa = &softness[a0], *sb = &softness[b0];
    const std::int32_t* third = &third_[e0];
    for (std::size_t i = 0; i < n; ++i) {
      const double s = std::min(std::min(sa[i], sb[i]), softness[std::size_t(third[i])]);
      tension[i] *= s, stiffness[i] *= s;
    }
  }
  const std::vector<std::uint8_t>& severed = is_tpm ? state.tpm_severed : state.edge_severed;
  if (!severed.empty()) {
    const std::uint8_t* gone = &severed[is_tpm ? t0 : e0];
    for (std::size_t i = 0; i < n; ++i) {
      const double lives = gone[i] ? 0.0 : 1.0;
      tension[i] *= lives, stiffness[i] *= lives;
    }
  }

  // Couplings. Tension stiffens across the element; compression would soften and is left out, which keeps the
  // matrix positive definite.
  double* __restrict mx = &root_[0][e0], * __restrict my = &root_[1][e0], * __restrict mz = &root_[2][e0];
  double* const transverse = length;
  for (std::size_t i = 0; i < n; ++i) {
    const double across = length[i] > kShortest ? h * h * std::max(tension[i], 0.0) / length[i] : 0.0;
    const double root = std::sqrt(std::max(stiffness[i] - across, 0.0));
    mx[i] = nx[i] * root, my[i] = ny[i] * root, mz[i] = nz[i] * root, transverse[i] = across;
  }

  // Forces and diagonal blocks on the first, then on the second ends; the two ranges may overlap, so two
  // loops.
  const auto scatter = [&](std::size_t end, double sign) {
    double *fx = &force[end], *fy = &force[spheres + end], *fz = &force[2 * spheres + end];
    for (std::size_t i = 0; i < n; ++i) {
      const double t = sign * tension[i];
      fx[i] += t * nx[i], fy[i] += t * ny[i], fz[i] += t * nz[i];
    }
    double *xx = &blocks[end], *xy = xx + spheres, *xz = xy + spheres, *yy = xz + spheres, *yz = yy + spheres,
           *zz = yz + spheres;
    for (std::size_t i = 0; i < n; ++i) {
      xx[i] += mx[i] * mx[i] + transverse[i], xy[i] += mx[i] * my[i], xz[i] += mx[i] * mz[i];
      yy[i] += my[i] * my[i] + transverse[i], yz[i] += my[i] * mz[i], zz[i] += mz[i] * mz[i] + transverse[i];
    }
  };
  scatter(a0, 1.0);
  scatter(b0, -1.0);
}

void AxialElements::apply(const Coordinates& v, Coordinates& result) const {
  constexpr std::size_t kBatch = 64;
  double qx[kBatch], qy[kBatch], qz[kBatch];
  const std::size_t spheres = v.size() / 3;
  for (const Run& run : runs_)
    for (std::size_t begin = 0; begin < std::size_t(run.count); begin += kBatch) {
      const std::size_t n = std::min(kBatch, std::size_t(run.count) - begin);
      const std::size_t e = std::size_t(run.first) + begin, a = std::size_t(run.a) + begin,
                        b = std::size_t(run.b) + begin;
      const double *mx = &root_[0][e], *my = &root_[1][e], *mz = &root_[2][e], *beta = &transverse_[e];
      const double *va = &v[a], *vb = &v[b];
      for (std::size_t i = 0; i < n; ++i) {
        const double dx = vb[i] - va[i], dy = vb[spheres + i] - va[spheres + i],
                     dz = vb[2 * spheres + i] - va[2 * spheres + i];
        const double t = mx[i] * dx + my[i] * dy + mz[i] * dz;
        qx[i] = mx[i] * t + beta[i] * dx, qy[i] = my[i] * t + beta[i] * dy, qz[i] = mz[i] * t + beta[i] * dz;
      }
      double* ra = &result[a];
      for (std::size_t i = 0; i < n; ++i)
        ra[i] -= qx[i], ra[spheres + i] -= qy[i], ra[2 * spheres + i] -= qz[i];
      double* rb = &result[b];
      for (std::size_t i = 0; i < n; ++i)
        rb[i] += qx[i], rb[spheres + i] += qy[i], rb[2 * spheres + i] += qz[i];
    }
}

void AxialElements::add_forces(const State& state, std::span<const double> softness, Coordinates& force) const {
  const std::size_t spheres = state.position.size();
  const auto pull_together = [&](std::size_t e, std::int32_t first, std::int32_t second, double elastic, double damping) {
    const auto a = std::size_t(first), b = std::size_t(second);
    const Vec3 apart = state.position[b] - state.position[a];
    const double length = norm(apart);
    if (!(length > kShortest)) return;
    const Vec3 direction = apart / length;
    const double s = softness.empty() ? 1.0 : std::min({softness[a], softness[b], softness[std::size_t(third_[e])]});
    const Vec3 pull = s * (elastic + damping * dot(direction, state.velocity[b] - state.velocity[a])) * direction;
    force[a] += pull.x, force[spheres + a] += pull.y, force[2 * spheres + a] += pull.z;
    force[b] -= pull.x, force[spheres + b] -= pull.y, force[2 * spheres + b] -= pull.z;
  };
  const Edges& edges = model_.edges;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!state.edge_severed.empty() && state.edge_severed[e]) continue;
    const double x = distance(state.position, edges.a[e], edges.b[e]) - edges.rest_length[e];
    pull_together(e, edges.a[e], edges.b[e], edges.k[e] * x, edges.c.empty() ? 0.0 : edges.c[e]);
  }
  const TwoSphereTpms& tpms = model_.tpms;
  for (std::size_t t = 0; t < tpms.size(); ++t) {
    if (!state.tpm_severed.empty() && state.tpm_severed[t]) continue;
    const double x = distance(state.position, tpms.a[t], tpms.b[t]) - tpms.rest_length[t];
    pull_together(edges.size() + t, tpms.a[t], tpms.b[t], tpms.spring_k[t] * (x - state.kelvin_elongation[t]), 0.0);
  }
}

void AxialElements::advance_kelvin(double h, State& state) const {
  const TwoSphereTpms& m = model_.tpms;
  for (std::size_t t = 0; t < m.size(); ++t) {
    const double x = distance(state.position, m.a[t], m.b[t]) - m.rest_length[t];
    const double damping = m.kelvin_c[t] / h;
    state.kelvin_elongation[t] = (damping * state.kelvin_elongation[t] + m.spring_k[t] * x) /
                                 (m.spring_k[t] + m.kelvin_k[t] + damping);
  }
}

double AxialElements::elastic_energy(const State& state) const {
  double energy = 0;
  for (std::size_t e = 0; e < model_.edges.size(); ++e) {
    if (!state.edge_severed.empty() && state.edge_severed[e]) continue;
    const double x =
        distance(state.position, model_.edges.a[e], model_.edges.b[e]) - model_.edges.rest_length[e];
    energy += 0.5 * model_.edges.k[e] * x * x;
  }
  return energy;
}

}  // namespace ctpm
