#include "studio/cohort/statistics.h"

#include <algorithm>
#include <cmath>

#include "studio/output/random_numbers.h"

namespace ctpm::cohort {

std::optional<Spread> spread_of(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  Spread spread{values.size(), 0, values[0], values[0], 0};
  for (const double value : values) {
    spread.mean += value / double(values.size());
    spread.low = std::min(spread.low, value), spread.high = std::max(spread.high, value);
  }
  double squares = 0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  // What differs by rounding alone has no spread, in which anything else would be far away.
  constexpr double kRounding = 1e-12;
  if (spread.high - spread.low > kRounding * std::max(std::abs(spread.low), std::abs(spread.high)))
    spread.deviation = std::sqrt(squares / double(values.size() - 1));
  return spread;
}

std::optional<Interval> interval_of_mean(std::span<const double> values, const scenes::IntervalSpec& how) {
  if (values.size() < 2) return std::nullopt;
  const std::uint64_t count = values.size();
  std::vector<double> means(std::size_t(how.resamples), 0.0);
  for (std::uint64_t i = 0; i < means.size(); ++i) {
    double sum = 0;
    for (std::uint64_t k = 0; k < count; ++k)
      sum += values[((output::random_at(std::uint64_t(how.seed), i * count + k) >> 32) * count) >> 32];
    means[i] = sum / double(count);
  }
  std::ranges::sort(means);
  const double beyond = 0.5 * (1 - how.confidence) * double(means.size());
  const std::size_t first = std::size_t(std::floor(beyond)),
                    last = means.size() - 1 - std::min(first, means.size() - 1);
  return Interval{means[std::min(first, last)], means[last]};
}

LearningLimits limits_of(const scenes::LearningSpec& learning) {
  const double p0 = learning.acceptable, p1 = learning.unacceptable, a = learning.false_alarm, b = learning.missed;
  const double p = std::log(p1 / p0), q = std::log((1 - p0) / (1 - p1));
  return {-std::log((1 - a) / b) / (p + q), std::log((1 - b) / a) / (p + q), p / (p + q), q / (p + q)};
}

std::vector<LearningStep> learning_curve(const std::vector<bool>& passed, const scenes::LearningSpec& learning) {
  constexpr double kRounding = 1e-9;
  const LearningLimits limits = limits_of(learning);
  std::vector<LearningStep> steps;
  LearningStep now;
  for (const bool is_pass : passed) {
    now.sum += is_pass ? -limits.pass : limits.failure;
    // Whole numbers of attempts often end on a limit: rounding must not decide.
    const bool is_learned = now.sum <= limits.learned + kRounding, is_failing = now.sum >= limits.failing - kRounding;
    if (is_learned) now.state = LearningState::learned;
    if (is_failing) now.state = LearningState::failing;
    steps.push_back(now);
    if (is_learned || is_failing) now.sum = 0;
  }
  return steps;
}

}  // namespace ctpm::cohort
