// Loops over tissue cells and their edges; part of loops.h.

namespace ctpm::elements::CTPM_KERNELS {
namespace {

double size_of(double a) { return __builtin_fabs(a); }

/// The least of `count` numbers, of an array of kEdges.
double least_of(double* __restrict all, int32_t count) {
  for (int32_t i = count; i < kEdges; ++i) all[i] = __builtin_huge_val();
  for (int32_t half = kEdges / 2; half >= 8; half /= 2) CTPM_INDEPENDENT
  for (int32_t i = 0; i < half; ++i) all[i] = smaller(all[i], all[i + half]);
  double pairs[4];
  for (int32_t i = 0; i < 4; ++i) pairs[i] = smaller(all[i], all[i + 4]);
  return smaller(smaller(pairs[0], pairs[1]), smaller(pairs[2], pairs[3]));
}

void least_of_edges(const Points& m, const EdgeRow* first, const EdgeRow* last, double* least) {
  const double* const all[3] = {m.x, m.y, m.z};
  alignas(64) double all_of_row[kEdges];
  for (; first != last; ++first, ++least) {
    const double *p = all[first->axis], *q = all[(first->axis + 1) % 3], *r = all[(first->axis + 2) % 3];
    const double *pa = p + first->a, *qa = q + first->a, *ra = r + first->a;
    const double *pb = p + first->b, *qb = q + first->b, *rb = r + first->b;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < first->count; ++i)
      all_of_row[i] = pb[i] - pa[i] - size_of(qb[i] - qa[i]) - size_of(rb[i] - ra[i]);
    *least = least_of(all_of_row, first->count);
  }
}

/// Edges from a corner to the next along one axis.
struct EdgesOfBatch {
  alignas(64) double x[kBatch], y[kBatch], z[kBatch];

  void find(const Points& m, int32_t from, int32_t to, int32_t count) {
    const double *xa = m.x + from, *ya = m.y + from, *za = m.z + from, *xb = m.x + to, *yb = m.y + to, *zb = m.z + to;
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < count; ++i) x[i] = xb[i] - xa[i], y[i] = yb[i] - ya[i], z[i] = zb[i] - za[i];
  }
};

void least_of_cells(const Points& m, const CellBatch& batch, double* __restrict least) {
  const int32_t n = batch.count, *corner = batch.corner;
  // Edges along i at (j, k), along j at (i, k), along k at (i, j).
  EdgesOfBatch along_i[4], along_j[4], along_k[4];
  for (int32_t e = 0; e < 4; ++e) {
    along_i[e].find(m, corner[2 * e], corner[2 * e + 1], n);
    const int32_t j = (e & 1) + 4 * (e >> 1);
    along_j[e].find(m, corner[j], corner[j + 2], n);
    along_k[e].find(m, corner[e], corner[e + 4], n);
  }
  for (int32_t i = 0; i < n; ++i) least[i] = __builtin_huge_val();
  for (int32_t c = 0; c < 8; ++c) {
    const EdgesOfBatch &p = along_i[c >> 1], &q = along_j[(c & 1) + 2 * (c >> 2)], &r = along_k[c & 3];
    CTPM_INDEPENDENT
    for (int32_t i = 0; i < n; ++i) {
      const double volume = p.x[i] * (q.y[i] * r.z[i] - q.z[i] * r.y[i]) +
                            p.y[i] * (q.z[i] * r.x[i] - q.x[i] * r.z[i]) + p.z[i] * (q.x[i] * r.y[i] - q.y[i] * r.x[i]);
      least[i] = smaller(least[i], volume);
    }
  }
}

}  // namespace
}  // namespace ctpm::elements::CTPM_KERNELS
