// Measures of motion against answers that are known without them.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <tuple>

#include "studio/compare/alignment.h"
#include "studio/compare/motion.h"
#include "studio/compare/path_distance.h"

namespace ctpm {
namespace {

/// A straight way of length 1 in 1 s with the least jerk: 10 t^3 - 15 t^4 + 6 t^5 (Flash and Hogan 1985).
compare::Path least_jerk_path(double rate_hz) {
  compare::Path path;
  for (int i = 0; i <= int(rate_hz); ++i) {
    const double t = i / rate_hz;
    path.push_back({0, t * t * t * (10 - 15 * t + 6 * t * t), 0});
  }
  return path;
}

/// exp(-5 t^2) at 100 Hz for t in [-1, 1), the example of the measures' authors.
std::vector<double> authors_speed() {
  std::vector<double> speed;
  for (int i = 0; i < 200; ++i) speed.push_back(std::exp(-5 * std::pow(-1 + 0.01 * i, 2)));
  return speed;
}

compare::Path line(Vec3 from, Vec3 to, int count) {
  compare::Path path;
  for (int i = 0; i < count; ++i) path.push_back(from + (double(i) / (count - 1)) * (to - from));
  return path;
}

TEST(Motion, PathLengthOfACircleIsItsCircumference) {
  compare::Path circle;
  for (int i = 0; i <= 3600; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3600;
    circle.push_back({0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.01});
  }
  EXPECT_NEAR(compare::path_length(circle), 2 * std::numbers::pi * 0.05, 1e-6);
}

TEST(Motion, AStraightLineHasEconomyOneAndARightAngleItsDiagonal) {
  const std::vector<std::size_t> ends{0, 20};
  EXPECT_NEAR(*compare::economy_of_motion(line({0, 0, 0}, {3, 4, 0}, 21), ends), 1, 1e-12);
  compare::Path corner = line({0, 0, 0}, {1, 0, 0}, 11);
  const compare::Path second = line({1, 0, 0}, {1, 1, 0}, 11);
  corner.insert(corner.end(), second.begin() + 1, second.end());
  EXPECT_NEAR(*compare::economy_of_motion(corner, ends), std::sqrt(2) / 2, 1e-12);
  EXPECT_NEAR(*compare::economy_of_motion(corner, std::vector<std::size_t>{0, 10, 20}), 1, 1e-12);
  EXPECT_FALSE(compare::economy_of_motion(compare::Path(5, {1, 1, 1}), std::vector<std::size_t>{0, 4}));
}

TEST(Motion, SpectralArcLengthIsThatOfItsAuthorsExample) {
  // -1.41403 in the text beside the authors' own program.
  EXPECT_NEAR(*compare::spectral_arc_length(authors_speed(), 100), -1.41403, 5e-6);
}

TEST(Motion, SpectralArcLengthOfLeastJerkIsThatOfItsSpectrum) {
  // The speed 30 t^2 (1 - t)^2 has the spectrum 15 j2(k) / k^2, k = pi f, with the spherical Bessel function
  // j2.
  const auto amplitude = [](double f) {
    const double k = std::numbers::pi * f;
    return k == 0 ? 1.0 : std::abs(15 * std::sph_bessel(2, k) / (k * k));
  };
  constexpr int steps = 100000;
  const auto frequency = [](int i) { return compare::kSpectralCutoff * i / steps; };
  int last = steps;
  while (amplitude(frequency(last)) < compare::kSpectralAmplitude) --last;
  double length = 0;
  for (int i = 1; i <= last; ++i)
    length += std::hypot(1.0 / last, amplitude(frequency(i)) - amplitude(frequency(i - 1)));
  // The tail is cut at one of the frequencies that a transform has, 0.05 Hz apart here.
  constexpr double kOneFrequencyMore = 0.01;
  for (const double rate : {100.0, 1000.0})
    EXPECT_NEAR(*compare::spectral_arc_length(compare::speed_along(least_jerk_path(rate), rate), rate), -length,
                kOneFrequencyMore)
        << rate;
}

std::optional<double> jerk_of(const compare::Path& path, double rate_hz) {
  return compare::log_dimensionless_jerk(compare::speed_along(path, rate_hz), rate_hz);
}

TEST(Motion, LogDimensionlessJerkIsThatOfItsAuthorsExample) {
  // -5.81636 in the text beside the authors' own program.
  EXPECT_NEAR(*compare::log_dimensionless_jerk(authors_speed(), 100), -5.81636, 5e-6);
}

TEST(Motion, LogDimensionlessJerkOfLeastJerkIsItsClosedForm) {
  // Integral of the squared jerk 720, largest speed 15/8: -ln(720 / (15/8)^2) = -ln 204.8.
  EXPECT_NEAR(*jerk_of(least_jerk_path(10000), 10000), -std::log(204.8), 0.001);
  EXPECT_NEAR(*jerk_of(least_jerk_path(100), 100), -std::log(204.8), 0.1);
}

TEST(Motion, SmoothnessDependsNeitherOnSizeNorOnDuration) {
  const compare::Path path = least_jerk_path(100);
  compare::Path large = path;
  for (Vec3& p : large) p = 7 * p;
  EXPECT_NEAR(*jerk_of(large, 100), *jerk_of(path, 100), 1e-9);
  EXPECT_NEAR(*jerk_of(path, 20), *jerk_of(path, 100), 1e-9);
  EXPECT_NEAR(*compare::spectral_arc_length(compare::speed_along(large, 100), 100),
              *compare::spectral_arc_length(compare::speed_along(path, 100), 100), 1e-9);
}

TEST(Motion, TremorIsLessSmooth) {
  const compare::Path path = least_jerk_path(100);
  compare::Path shaking = path;
  for (std::size_t i = 0; i < shaking.size(); ++i)
    shaking[i].y += 0.01 * std::sin(2 * std::numbers::pi * 4 * double(i) / 100);
  EXPECT_LT(*compare::spectral_arc_length(compare::speed_along(shaking, 100), 100),
            *compare::spectral_arc_length(compare::speed_along(path, 100), 100) - 0.1);
  EXPECT_LT(*jerk_of(shaking, 100), *jerk_of(path, 100) - 1);
}

TEST(Motion, AHandThatRestsHasNoSmoothness) {
  const compare::Path still(200, {1, 2, 3});
  EXPECT_FALSE(compare::spectral_arc_length(compare::speed_along(still, 100), 100));
  EXPECT_FALSE(jerk_of(still, 100));
  EXPECT_FALSE(jerk_of(compare::Path(3, {0, 0, 0}), 100));
}

TEST(Motion, ALowPassLeavesLinesAndSlowWaysAndHalvesThePowerOfTheFrequencyNamed) {
  const compare::Path straight = line({0, 0, 0}, {1, 2, 3}, 50);
  const compare::Path same = compare::low_passed(straight, 100);
  ASSERT_EQ(same.size(), straight.size());
  for (std::size_t i = 0; i < same.size(); ++i) EXPECT_NEAR(norm(same[i] - straight[i]), 0, 1e-12) << i;
  for (const auto& [frequency, left] :
       {std::pair{1.0, 0.9965}, {compare::kHandCutoff, std::sqrt(0.5)}, {40.0, 0.004}}) {
    compare::Path wave;
    for (int i = 0; i < 2000; ++i) wave.push_back({std::cos(2 * std::numbers::pi * frequency * i / 1000), 0, 0});
    EXPECT_NEAR(compare::low_passed(wave, 1000)[1000].x, left, 1e-3) << frequency;
  }
  EXPECT_TRUE(compare::low_passed({}, 100).empty());
}

TEST(Motion, MovementsAreTheSameAtAnyPaceAndEndInStandingStill) {
  const auto speed_at = [](double stretched) {
    compare::Path path;
    for (const auto& [seconds, from, to] :
         {std::tuple{0.5, 0.0, 0.0}, {1.0, 0.0, 0.1}, {0.4, 0.1, 0.1}, {1.0, 0.1, 0.3}})
      for (const compare::Path& piece = least_jerk_path(100 * seconds * stretched); const Vec3& p : piece)
        path.push_back({from + (to - from) * p.y, 0, 0});
    return compare::speed_along(path, 100);
  };
  const std::vector<compare::Spell> once = compare::movements_of(speed_at(1)),
                                    slow = compare::movements_of(speed_at(4));
  ASSERT_EQ(once.size(), 2u);
  ASSERT_EQ(slow.size(), 2u);
  EXPECT_GT(once[0].first, 50u) << "standing still at the start is no part of a movement";
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(double(slow[i].first), 4 * double(once[i].first), 12);
}

TEST(Motion, SpellsAreRunsThatLastLongEnoughAndGapsThatAreShortAreClosed) {
  const std::vector<bool> holds{true, false, true, true, true, false, true, true, false, false, false, true};
  EXPECT_EQ(compare::spells_of(holds, 1), (std::vector<compare::Spell>{{0, 1}, {2, 5}, {6, 8}, {11, 12}}));
  EXPECT_EQ(compare::spells_of(holds, 2), (std::vector<compare::Spell>{{2, 5}, {6, 8}}));
  EXPECT_EQ(compare::spells_of(holds, 2, 2), (std::vector<compare::Spell>{{0, 8}}));
}

TEST(Motion, TheMeanOfEachTenIsOnTheLine) {
  const compare::Path tens = compare::mean_of_each(line({0, 0, 0}, {0, 0, 24}, 25), 10);
  ASSERT_EQ(tens.size(), 2u);
  EXPECT_DOUBLE_EQ(tens[0].z, 4.5);
  EXPECT_DOUBLE_EQ(tens[1].z, 14.5);
}

TEST(PathDistance, TwoShiftedLinesAreTheShiftApart) {
  const compare::Path a = line({0, 0, 0}, {60, 0, 0}, 7), b = line({0, 0, 3}, {60, 0, 3}, 4);
  const compare::PathDistance distance = compare::distance_between({{a}}, {{b}}, 0.5);
  EXPECT_NEAR(distance.mean, 3, 1e-12);
  EXPECT_NEAR(distance.hausdorff, 3, 1e-12);
}

TEST(PathDistance, HausdorffOfAPathThatGoesOnIsWhatItGoesFurther) {
  const compare::Path a = line({0, 0, 0}, {40, 0, 0}, 5), b = line({0, 0, 0}, {50, 0, 0}, 6);
  const compare::PathDistance distance = compare::distance_between({{a}}, {{b}}, 0.01);
  EXPECT_NEAR(distance.hausdorff, 10, 1e-12);
  // 10 of 90 parts of the length are 5 away on average.
  EXPECT_NEAR(distance.mean, 5.0 * 10 / 90, 0.01);
  const compare::PathDistance other_way = compare::distance_between({{b}}, {{a}}, 0.01);
  EXPECT_EQ(distance.hausdorff, other_way.hausdorff);
  EXPECT_NEAR(distance.mean, other_way.mean, 1e-12);
}

TEST(PathDistance, TheNearestOfSeveralPathsCounts) {
  const std::vector<compare::Path> paths{line({0, 0, 0}, {10, 0, 0}, 3), {{0, 5, 0}}};
  EXPECT_DOUBLE_EQ(compare::distance_from({0, 4, 0}, paths), 1);
  EXPECT_DOUBLE_EQ(compare::distance_from({13, 4, 0}, paths), 5);
}

TEST(Alignment, APathWithPausesIsThePathItself) {
  const compare::Path path = line({0, 0, 0}, {1, 2, 3}, 100);
  compare::Path pausing;
  for (std::size_t i = 0; i < path.size(); ++i) pausing.insert(pausing.end(), i == 30 ? 9 : 1, path[i]);
  const compare::Alignment alignment = compare::align_paths(path, pausing);
  EXPECT_EQ(alignment.mean, 0);
  EXPECT_EQ(alignment.largest, 0);
  EXPECT_EQ(alignment.pairs.front().a, 0u);
  EXPECT_EQ(alignment.pairs.back().b, pausing.size() - 1);
}

TEST(Alignment, AShiftedPathIsTheShiftAway) {
  const compare::Alignment alignment =
      compare::align_paths(line({0, 0, 0}, {50, 0, 0}, 51), line({0, 4, 0}, {50, 4, 0}, 51));
  EXPECT_NEAR(alignment.mean, 4, 1e-12);
  EXPECT_NEAR(alignment.largest, 4, 1e-12);
}

TEST(Alignment, APauseLongerThanTheBandIsNotAlignedAway) {
  const compare::Path path = line({0, 0, 0}, {100, 0, 0}, 101);
  compare::Path late(60, path.front());
  late.insert(late.end(), path.begin(), path.end());
  EXPECT_GT(compare::align_paths(path, late, 0.1).largest, 5);
  EXPECT_EQ(compare::align_paths(path, late, 0.7).largest, 0);
}

/// The least sum by trying every way on from a pair; a step in both paths counts twice.
double least_sum(const compare::Path& a, const compare::Path& b, std::size_t i, std::size_t j) {
  if (i + 1 == a.size() && j + 1 == b.size()) return 0;
  double least = INFINITY;
  const auto try_step = [&](std::size_t by_a, std::size_t by_b) {
    if (i + by_a >= a.size() || j + by_b >= b.size()) return;
    const double cost = double(by_a + by_b) * norm(a[i + by_a] - b[j + by_b]);
    least = std::min(least, cost + least_sum(a, b, i + by_a, j + by_b));
  };
  try_step(1, 0), try_step(0, 1), try_step(1, 1);
  return least;
}

TEST(Alignment, NoOtherWayHasALesserMean) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (int round = 0; round < 20; ++round) {
    compare::Path a(5 + std::size_t(round) % 3), b(6);
    for (compare::Path* path : {&a, &b})
      for (Vec3& p : *path) p = {anywhere(random), anywhere(random), anywhere(random)};
    const double least = 2 * norm(a[0] - b[0]) + least_sum(a, b, 0, 0);
    EXPECT_NEAR(compare::align_paths(a, b, 1).mean, least / double(a.size() + b.size()), 1e-12);
  }
}

TEST(Alignment, PathsOfAnyTwoLengthsAreAligned) {
  for (const int m : {1, 2, 3, 50, 400})
    for (const int n : {1, 2, 7, 399}) {
      const compare::Path a(std::size_t(m), {1, 0, 0}), b(std::size_t(n), {0, 0, 0});
      const compare::Alignment alignment = compare::align_paths(a, b, 0.01);
      EXPECT_NEAR(alignment.mean, 1, 1e-12);
      EXPECT_GE(alignment.pairs.size(), std::size_t(std::max(m, n)));
    }
}

TEST(PathDistance, IsThatOfEveryPointFromEveryPieceWhateverTheWayDoes) {
  // A way that winds, comes back on itself and stands still, beside another one in two parts.
  compare::Path winding;
  for (int i = 0; i < 900; ++i) {
    const double t = 0.01 * (i < 600 ? i : 1200 - i);
    winding.push_back({10 * std::cos(7 * t), 10 * std::sin(3 * t), i % 50 < 10 ? 2.0 : t});
  }
  compare::Path first, second;
  for (int i = 0; i < 400; ++i) first.push_back({0.05 * i - 10, std::sin(0.1 * i), 3});
  for (int i = 0; i < 100; ++i) second.push_back({0, 0.2 * i - 10, 1});
  const std::vector<compare::Path> a{winding}, b{first, second};
  double sum = 0, largest = 0, count = 0;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
    for (const compare::Path& path : from)
      for (const Vec3& point : compare::with_points_every(path, 0.5)) {
        const double distance = compare::distance_from(point, to);
        sum += distance, largest = std::max(largest, distance), count += 1;
      }
  const compare::PathDistance distance = compare::distance_between(a, b, 0.5);
  EXPECT_EQ(distance.hausdorff, largest);
  EXPECT_NEAR(distance.mean, sum / count, 1e-12);
}

}  // namespace
}  // namespace ctpm
