#include "core/block_jacobi.h"

namespace ctpm {

void BlockJacobi::factorise(const std::vector<double>& blocks) {
  const std::size_t n = blocks.size() / 6;
  const double *xx = blocks.data(), *xy = xx + n, *xz = xy + n, *yy = xz + n, *yz = yy + n, *zz = yz + n;
  double* __restrict ixx = inverse_.data(), * __restrict ixy = ixx + n, * __restrict ixz = ixy + n, * __restrict iyy = ixz + n, * __restrict iyz = iyy + n, * __restrict izz = iyz + n;
  // Adjugate over determinant; the blocks are sums of a mass and of positive parts, so the determinant is
  // positive.
  for (std::size_t i = 0; i < n; ++i) {
    const double cxx = yy[i] * zz[i] - yz[i] * yz[i], cxy = xz[i] * yz[i] - xy[i] * zz[i],
                 cxz = xy[i] * yz[i] - xz[i] * yy[i];
    const double inverse = 1 / (xx[i] * cxx + xy[i] * cxy + xz[i] * cxz);
    ixx[i] = cxx * inverse, ixy[i] = cxy * inverse, ixz[i] = cxz * inverse;
    iyy[i] = (xx[i] * zz[i] - xz[i] * xz[i]) * inverse;
    iyz[i] = (xy[i] * xz[i] - xx[i] * yz[i]) * inverse;
    izz[i] = (xx[i] * yy[i] - xy[i] * xy[i]) * inverse;
  }
}

void BlockJacobi::apply(const std::vector<double>& in, std::vector<double>& out) const {
  const std::size_t n = inverse_.size() / 6;
  const double *ixx = inverse_.data(), *ixy = ixx + n, *ixz = ixy + n, *iyy = ixz + n, *iyz = iyy + n,
               *izz = iyz + n;
  const double *x = in.data(), *y = x + n, *z = y + n;
  double* __restrict ox = out.data(), * __restrict oy = ox + n, * __restrict oz = oy + n;
  for (std::size_t i = 0; i < n; ++i) {
    ox[i] = ixx[i] * x[i] + ixy[i] * y[i] + ixz[i] * z[i];
    oy[i] = ixy[i] * x[i] + iyy[i] * y[i] + iyz[i] * z[i];
    oz[i] = ixz[i] * x[i] + iyz[i] * y[i] + izz[i] * z[i];
  }
}

}  // namespace ctpm
