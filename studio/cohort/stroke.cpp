#include "studio/cohort/stroke.h"

#include <algorithm>
#include <cmath>

namespace ctpm::cohort {
namespace {

constexpr std::size_t kPlaceSlack = 2;  // places of a way that alignment may confuse

/// The share of the way's length at each of its points; of a tool that never moves, that of its points.
std::vector<double> shares_along(const std::vector<Vec3>& way) {
  std::vector<double> along(way.size(), 0.0);
  for (std::size_t i = 1; i < way.size(); ++i) along[i] = along[i - 1] + norm(way[i] - way[i - 1]);
  const double whole = along.back();
  for (std::size_t i = 0; i < way.size(); ++i)
    along[i] = whole > 0 ? along[i] / whole : double(i) / double(std::max<std::size_t>(1, way.size() - 1));
  return along;
}

/// The largest force between a point of a way and the next one.
std::vector<double> forces_of(const compare::TimedPath& way, const compare::SessionTrack& track) {
  std::vector<double> forces;
  for (std::size_t i = 0; i < way.time.size(); ++i) {
    const auto tick_of = [&](double time) { return std::size_t(std::llround(time / track.tick)); };
    const std::size_t from = tick_of(way.time[i]),
                      to = std::min(i + 1 < way.time.size() ? tick_of(way.time[i + 1]) : track.tick_count(),
                                    track.tick_count());
    double most = 0;
    for (std::size_t tick = from; tick < to; ++tick) most = std::max(most, track.force[tick]);
    forces.push_back(most);
  }
  return forces;
}

}  // namespace

StrokeCurve stroke_curve(const compare::TimedPath& reference, const compare::Alignment& alignment,
                         const compare::TimedPath& way, const compare::SessionTrack& track) {
  const std::vector<double> share = shares_along(reference.place), force = forces_of(way, track);
  struct AtPoint {
    Vec3 sum;
    double count = 0, most = -1, time = 0;
  };
  // What the session did at each point of the reference.
  std::vector<AtPoint> point(share.size());
  for (const compare::AlignedPair& pair : alignment.pairs) {
    AtPoint& here = point[pair.a];
    here.sum = here.sum + way.place[pair.b], here.count += 1;
    if (force[pair.b] > here.most) here.most = force[pair.b], here.time = way.time[pair.b];
  }
  StrokeCurve curve;
  for (std::size_t i = 0; i < kStrokePlaces; ++i) {
    const double from = double(i) / double(kStrokePlaces - 1), to = double(i + 1) / double(kStrokePlaces - 1);
    const std::size_t at =
        std::min<std::size_t>(std::size_t(std::ranges::lower_bound(share, from) - share.begin()), share.size() - 1);
    curve.place.push_back((1 / point[at].count) * point[at].sum);
    std::size_t hardest = at;
    for (std::size_t k = at + 1; k < share.size() && share[k] < to; ++k)
      if (point[k].most > point[hardest].most) hardest = k;
    curve.force.push_back(point[hardest].most);
    curve.time.push_back(point[hardest].time);
  }
  return curve;
}

StrokeBand band_of(const std::vector<std::vector<double>>& curves) {
  StrokeBand band;
  const double count = double(curves.size());
  for (std::size_t i = 0; i < kStrokePlaces; ++i) {
    double mean = 0, squares = 0;
    for (const std::vector<double>& curve : curves) mean += curve[i] / count;
    for (const std::vector<double>& curve : curves) squares += (curve[i] - mean) * (curve[i] - mean);
    band.mean.push_back(mean), band.deviation.push_back(std::sqrt(squares / std::max(1.0, count - 1)));
  }
  return band;
}

std::vector<Vec3> middle_of(const std::vector<StrokeCurve>& curves) {
  std::vector<Vec3> middle(kStrokePlaces);
  for (const StrokeCurve& curve : curves)
    for (std::size_t i = 0; i < kStrokePlaces; ++i)
      middle[i] = middle[i] + (1 / double(curves.size())) * curve.place[i];
  return middle;
}

std::vector<double> distance_from(const std::vector<Vec3>& middle, const StrokeCurve& curve) {
  std::vector<double> distance;
  for (std::size_t i = 0; i < kStrokePlaces; ++i) distance.push_back(norm(curve.place[i] - middle[i]));
  return distance;
}

StrokeExcess excess_of(const std::vector<double>& curve, const StrokeBand& band, double rounding) {
  // The highest of the band near a place, because sessions are aligned at some points a second only.
  std::vector<double> high;
  for (std::size_t i = 0; i < kStrokePlaces; ++i) {
    high.push_back(band.high(i));
    for (std::size_t k = i - std::min(i, kPlaceSlack); k <= std::min(i + kPlaceSlack, kStrokePlaces - 1); ++k)
      high[i] = std::max(high[i], band.high(k));
  }
  const auto beyond = [&](std::size_t k) { return curve[k] - high[k] - rounding; };
  StrokeExcess worst;
  double most = 0;
  for (std::size_t i = 0; i < kStrokePlaces;) {
    if (!(beyond(i) > 0)) {
      ++i;
      continue;
    }
    StrokeExcess here{true, i, i, i, 0, 0, 0};
    double area = 0;
    for (; i < kStrokePlaces && beyond(i) > 0; ++i) {
      area += beyond(i), here.to = i;
      if (beyond(i) > beyond(here.worst)) here.worst = i;
    }
    if (!(area > most)) continue;
    most = area, worst = here;
    worst.value = curve[here.worst], worst.mean = band.mean[here.worst], worst.deviation = band.deviation[here.worst];
  }
  return worst;
}

}  // namespace ctpm::cohort
