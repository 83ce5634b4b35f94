#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenes/course.h"

namespace ctpm::cohort {

/// What several values tell of what they were drawn from.
struct Spread {
  std::size_t count = 0;
  double mean = 0, low = 0, high = 0;  ///< of the values
  double deviation = 0;                ///< standard deviation of a sample (count - 1)
};

/// None of fewer than two values: one value has no spread.
std::optional<Spread> spread_of(std::span<const double> values);

struct Interval {
  double low = 0, high = 0;
};

/// The interval of the mean, from means of values drawn again with replacement (percentile bootstrap, Efron 1979). None
/// of fewer than two values.
std::optional<Interval> interval_of_mean(std::span<const double> values, const scenes::IntervalSpec& how);

/// How far a cumulative sum of failures has come, after each attempt. Between its limits nothing is known yet.
enum class LearningState { open, learned, failing };

struct LearningStep {
  double sum = 0;                             ///< after the attempt; where it reached a limit, the next one begins at 0
  LearningState state = LearningState::open;  ///< what the attempts so far tell: the limit that was reached last
};

struct LearningLimits {
  double learned = 0;  ///< below 0
  double failing = 0;  ///< above 0
  double failure = 0;  ///< what a failed attempt adds
  double pass = 0;     ///< what a passed one takes away
};

/// The limits of Wald's sequential test of two shares of failures, as Bolsin and Colson 2000 use it.
LearningLimits limits_of(const scenes::LearningSpec& learning);

/// The cumulative sum over attempts; true: passed.
std::vector<LearningStep> learning_curve(const std::vector<bool>& passed, const scenes::LearningSpec& learning);

}  // namespace ctpm::cohort
