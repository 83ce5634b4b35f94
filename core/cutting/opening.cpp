#include "core/cutting/opening.h"

#include <algorithm>
#include <cmath>

namespace ctpm::cutting {
namespace {

/// Spheres tell of an opening within so many spacings: both neighbours of a cut between them, and little more.
constexpr double kReach = 1.5;

/// A sphere that comes nearer to the plane of a cut than this counts less and less, so that one that changes sides does
/// so without a jump [spacings].
constexpr double kOnPlane = 0.1;

/// A side of which the kernels sum to kNone is none, and to kEnough enough; half a lattice sums to about 1. Less than
/// kNone would be a sphere at the rim of the reach, which must not bear alone what many do.
constexpr double kNone = 0.1, kEnough = 0.4;

/// Added to the moments along the cut, so that few spheres do not make up slopes [spacings^2].
constexpr double kStiffness = 0.01;

/// A unit vector across a unit vector.
Vec3 any_across(Vec3 v) {
  const Vec3 least = std::abs(v.x) <= std::abs(v.y) && std::abs(v.x) <= std::abs(v.z) ? Vec3{1, 0, 0}
                     : std::abs(v.y) <= std::abs(v.z)                                 ? Vec3{0, 1, 0}
                                                                                      : Vec3{0, 0, 1};
  const Vec3 across = cross(v, least);
  return across / norm(across);
}

}  // namespace

Openings::Openings(const Model& model, const RestMap& map) : model_(model), map_(map) {
  for (const OrganRange& organ : model.organs) {
    double most = 0;
    for (std::int32_t i = 0; i < organ.count; ++i) most = std::max(most, model.mass[std::size_t(organ.first + i)]);
    heaviest_.push_back(most);
  }
}

void Openings::find(std::size_t organ, Vec3 rest, Vec3 normal, Opening& o, const BladeAt* blade) const {
  o.count = 0, o.whole = 0, o.total_ = {}, o.mean_ = {};
  const double spacing = map_.spacing(organ), reach = kReach * spacing;
  o.axis_[0] = any_across(normal), o.axis_[1] = cross(normal, o.axis_[0]);
  std::size_t count = 0;
  map_.for_each_within(organ, rest, reach, [&](std::int32_t sphere) {
    if (count == Opening::kMost) return;
    const Vec3 from = model_.rest_position[std::size_t(sphere)] - rest;
    const double bump = 1 - dot(from, from) / (reach * reach), apart = dot(normal, from);
    if (!(bump > 0) || apart == 0) return;
    double share =
        model_.mass[std::size_t(sphere)] / heaviest_[organ] * std::min(1.0, std::abs(apart) / (kOnPlane * spacing));
    if (blade != nullptr) share *= blade->share(sphere, norm(from), spacing);
    if (!(share > 0)) return;
    const std::size_t side = apart > 0;
    o.sphere[count] = sphere, o.apart[count] = apart;
    o.kernel_[count] = share * bump * bump * bump, o.pull_[count] = share * 6 * bump * bump / (reach * reach);
    o.along_[count] = {dot(o.axis_[0], from), dot(o.axis_[1], from)};
    o.total_[side] += o.kernel_[count];
    o.mean_[side].first += o.kernel_[count] * o.along_[count].first;
    o.mean_[side].second += o.kernel_[count] * o.along_[count].second;
    ++count;
  });
  o.whole = std::clamp((std::min(o.total_[0], o.total_[1]) - kNone) / (kEnough - kNone), 0.0, 1.0);
  if (!(o.whole > 0)) return;
  o.count = std::int32_t(count);
  for (std::size_t side = 0; side < 2; ++side)
    o.mean_[side].first /= o.total_[side], o.mean_[side].second /= o.total_[side];

  // The slopes along the cut, which both sides share.
  double xx = kStiffness * spacing * spacing, yy = xx, xy = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Opening::Pair &along = o.along_[i], mean = o.mean_[std::size_t(o.apart[i] > 0)];
    along.first -= mean.first, along.second -= mean.second;
    xx += o.kernel_[i] * along.first * along.first, xy += o.kernel_[i] * along.first * along.second;
    yy += o.kernel_[i] * along.second * along.second;
  }
  const double area = xx * yy - xy * xy;
  o.xx_ = yy / area, o.xy_ = -xy / area, o.yy_ = xx / area;
  const double dx = o.mean_[1].first - o.mean_[0].first, dy = o.mean_[1].second - o.mean_[0].second;
  const double qx = o.xx_ * dx + o.xy_ * dy, qy = o.xy_ * dx + o.yy_ * dy;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t side = o.apart[i] > 0;
    const double mean = (side == 1 ? 1 : -1) / o.total_[side];
    o.weight[i] = o.kernel_[i] * (mean - o.along_[i].first * qx - o.along_[i].second * qy);
  }
}

double Opening::jump(const Values& value) const {
  double sum = 0;
  for (std::size_t i = 0; i < std::size_t(count); ++i) sum += weight[i] * value[i];
  return sum;
}

/// Of the fit by weighted least squares only the weights change with the place, and what they change is what the fit
/// leaves over.
Vec3 Opening::change(const Values& value) const {
  double mean[2] = {}, x = 0, y = 0;
  for (std::size_t i = 0; i < std::size_t(count); ++i)
    mean[apart[i] > 0] += kernel_[i] / total_[apart[i] > 0] * value[i];
  for (std::size_t i = 0; i < std::size_t(count); ++i) {
    const double off = kernel_[i] * (value[i] - mean[apart[i] > 0]);
    x += off * along_[i].first, y += off * along_[i].second;
  }
  const double slope_x = xx_ * x + xy_ * y, slope_y = xy_ * x + yy_ * y;
  Pair sum;
  for (std::size_t i = 0; i < std::size_t(count); ++i) {
    const std::size_t side = apart[i] > 0;
    const double left = value[i] - mean[side] - slope_x * along_[i].first - slope_y * along_[i].second;
    const double pull = kernel_[i] > 0 ? pull_[i] * weight[i] / kernel_[i] * left : 0.0;
    sum.first += pull * (along_[i].first + mean_[side].first);
    sum.second += pull * (along_[i].second + mean_[side].second);
  }
  return sum.first * axis_[0] + sum.second * axis_[1];
}

}  // namespace ctpm::cutting
