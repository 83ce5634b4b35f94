#include "studio/compare/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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

std::optional<double> log_dimensionless_jerk(std::span<const double> speed, double rate_hz) {
  if (speed.size() < 4) return std::nullopt;
  const double peak = *std::max_element(speed.begin(), speed.end()), duration = double(speed.size()) / rate_hz;
  double integral = 0;
  for (std::size_t i = 2; i < speed.size(); ++i) {
    const double jerk = rate_hz * rate_hz * (speed[i] - 2 * speed[i - 1] + speed[i - 2]);
    integral += jerk * jerk / rate_hz;
  }
  if (!(peak > 0) || !(integral > 0)) return std::nullopt;
  return -std::log(std::pow(duration, 3) / (peak * peak) * integral);
}

std::vector<Vec3> low_passed(std::span<const Vec3> path, double rate_hz) {
  if (path.empty()) return {};
  // The bell's transform is a bell: exp(-(2 pi f width)^2 / 2), whose square is 1/2 at the cut-off.
  const double width = std::sqrt(std::log(2.0)) / (2 * std::numbers::pi * kHandCutoff) * rate_hz;
  const auto reach = std::ptrdiff_t(std::ceil(4 * width)), last = std::ptrdiff_t(path.size()) - 1;
  const auto at = [&](std::ptrdiff_t i) {
    const std::ptrdiff_t inside = std::clamp<std::ptrdiff_t>(i < 0 ? -i : i > last ? 2 * last - i : i, 0, last);
    const Vec3& there = path[std::size_t(inside)];
    return i < 0 ? 2 * path.front() - there : i > last ? 2 * path.back() - there : there;
  };
  std::vector<Vec3> result;
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    Vec3 sum;
    double weights = 0;
    for (std::ptrdiff_t d = -reach; d <= reach; ++d) {
      const double weight = std::exp(-0.5 * double(d * d) / (width * width));
      sum += weight * at(i + d), weights += weight;
    }
    result.push_back(sum / weights);
  }
  return result;
}

std::vector<Spell> movements_of(std::span<const double> speed) {
  if (speed.empty()) return {};
  const double still = kStillSpeed * *std::max_element(speed.begin(), speed.end());
  std::vector<bool> moves;
  for (const double v : speed) moves.push_back(v > still);
  const auto moving = std::count(moves.begin(), moves.end(), true);
  const auto rest = std::size_t(std::ceil(kRestTime * double(moving)));
  return spells_of(moves, rest + 1, rest + 1);
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
