#include "studio/compare/motion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/model/result.h"

namespace ctpm::compare {
namespace {

/// Amplitudes of `signal`, padded with zeros to `size`, at frequencies 0, 1, ..., `count` - 1 over `size`.
std::vector<double> amplitudes(std::span<const double> signal, int size, int count) {
  cv::Mat in = cv::Mat::zeros(1, size, CV_64F), out;
  std::copy(signal.begin(), signal.end(), in.ptr<double>());
  cv::dft(in, out);
  // Packed: re 0, re 1, im 1, re 2, im 2, ...
  const double* packed = out.ptr<double>();
  std::vector<double> amplitude{std::abs(packed[0])};
  for (int i = 1; i < count; ++i) amplitude.push_back(std::hypot(packed[2 * i - 1], packed[2 * i]));
  return amplitude;
}

}  // namespace

std::vector<Vec3> mean_of_each(std::span<const Vec3> path, std::size_t count) {
  CTPM_CHECK(count >= 1, "a mean needs values");
  std::vector<Vec3> means;
  for (std::size_t i = 0; i + count <= path.size(); i += count) {
    Vec3 sum;
    for (const Vec3& p : path.subspan(i, count)) sum += p;
    means.push_back(sum / double(count));
  }
  return means;
}

double path_length(std::span<const Vec3> path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += norm(path[i] - path[i - 1]);
  return length;
}

std::optional<double> economy_of_motion(std::span<const Vec3> path, std::span<const std::size_t> stations) {
  if (stations.size() < 2) return std::nullopt;
  double straight = 0;
  for (std::size_t i = 1; i < stations.size(); ++i) straight += norm(path[stations[i]] - path[stations[i - 1]]);
  const double gone = path_length(path.subspan(stations.front(), stations.back() - stations.front() + 1));
  if (!(gone > 0)) return std::nullopt;
  return straight / gone;
}

std::vector<double> speed_along(std::span<const Vec3> path, double rate_hz) {
  std::vector<double> speed;
  for (std::size_t i = 1; i < path.size(); ++i) speed.push_back(norm(path[i] - path[i - 1]) * rate_hz);
  return speed;
}

std::optional<double> spectral_arc_length(std::span<const double> speed, double rate_hz) {
  if (speed.size() < 4 || *std::max_element(speed.begin(), speed.end()) <= 0) return std::nullopt;
  int size = 1;
  while (size < int(speed.size())) size *= 2;
  size <<= kSpectralPadding;
  const double step = rate_hz / size;
  const int count = std::min(int(std::floor(kSpectralCutoff / step)), size / 2 - 1) + 1;
  std::vector<double> amplitude = amplitudes(speed, size, count);
  // Speed is never negative, so the largest amplitude is that of frequency 0.
  for (int i = count - 1; i >= 0; --i) amplitude[std::size_t(i)] /= amplitude[0];

  // The first value is 1, so the selection begins at frequency 0; it ends with the last large amplitude.
  std::size_t last = amplitude.size() - 1;
  while (amplitude[last] < kSpectralAmplitude) --last;
  if (last == 0) return std::nullopt;
  double length = 0;
  for (std::size_t i = 1; i <= last; ++i) length += std::hypot(1.0 / double(last), amplitude[i] - amplitude[i - 1]);
  return -length;
}

std::optional<double> log_dimensionless_jerk(std::span<const Vec3> path, double rate_hz) {
  if (path.size() < 4) return std::nullopt;
  const std::vector<double> speed = speed_along(path, rate_hz);
  const double peak = *std::max_element(speed.begin(), speed.end());
  double mean_square = 0;
  for (std::size_t i = 3; i < path.size(); ++i) {
    const Vec3 jerk = (rate_hz * rate_hz * rate_hz) * (path[i] - 3 * path[i - 1] + 3 * path[i - 2] - path[i - 3]);
    mean_square += dot(jerk, jerk) / double(path.size() - 3);
  }
  if (!(peak > 0) || !(mean_square > 0)) return std::nullopt;
  // The integral is the mean times the duration: third differences end 1.5 samples before the path.
  const double duration = double(path.size() - 1) / rate_hz;
  return -std::log(std::pow(duration, 4) / (peak * peak) * mean_square);
}

std::vector<Spell> spells_of(const std::vector<bool>& holds, std::size_t least, std::size_t least_gap) {
  std::vector<Spell> runs;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (!holds[i]) continue;
    if (!runs.empty() && i - runs.back().last < std::max<std::size_t>(least_gap, 1))
      runs.back().last = i + 1;
    else
      runs.push_back({i, i + 1});
  }
  std::erase_if(runs, [&](const Spell& run) { return run.last - run.first < least; });
  return runs;
}

}  // namespace ctpm::compare
