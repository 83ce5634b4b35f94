#include "studio/sweep/samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "studio/sweep/statistics.h"

namespace ctpm::sweep {
namespace {

std::vector<Sample> samples(const std::string& keys) {
  const Result<scenes::SweepText> sweep = scenes::read_sweep(
      "{\"format\": \"ctpm-sweep\", \"version\": 1, \"name\": \"s\", \"scene\": \"a.json\", " + keys + "}", "s.json");
  EXPECT_TRUE(sweep) << to_string(sweep.errors().front());
  return sweep ? samples_of(sweep->spec) : std::vector<Sample>();
}

std::string text_of(const std::vector<Sample>& all) {
  std::string text;
  for (const Sample& sample : all) {
    for (const scenes::SweepValue& value : sample.values) text += value.shown + " ";
    text += sample.seed + "\n";
  }
  return text;
}

TEST(Samples, OfAGridAreAllCombinations) {
  EXPECT_EQ(
      text_of(samples(R"("vary": [{"key": "/a", "values": [1, 2]}, {"key": "/b", "from": 0, "to": 1, "steps": 3}])")),
      "1 0 \n1 0.5 \n1 1 \n2 0 \n2 0.5 \n2 1 \n");
  EXPECT_EQ(text_of(samples(R"("vary": [{"key": "/a", "from": 1, "to": 100, "steps": 3, "scale": "logarithmic"}])")),
            "1 \n10 \n100 \n");
}

TEST(Samples, OfAListGoTogether) {
  EXPECT_EQ(text_of(samples(
                R"("method": "list", "vary": [{"key": "/a", "values": [1, 2]}, {"key": "/b", "values": ["x", "y"]}])")),
            "1 x \n2 y \n");
}

// The numbers are those of a program of a few lines in Python that follows the papers: SplitMix64, Fisher-Yates from
// the last place on, one value from each part.
TEST(Samples, OfALatinHypercubeAreThoseOfThePaper) {
  EXPECT_EQ(text_of(samples(R"("method": "latin-hypercube", "samples": 6, "seeds": [1, 7], "vary": [
    {"key": "/a", "from": 0, "to": 1}, {"key": "/b", "from": 0.5, "to": 4, "scale": "logarithmic"},
    {"key": "/c", "values": ["a", "b"]}])")),
            "0.460482 3.53735 b 1\n0.146225 0.663273 b 1\n0.253845 0.895554 b 1\n0.714251 2.71728 a 1\n"
            "0.965666 1.02312 a 1\n0.567357 1.45469 a 1\n0.874905 0.678211 a 7\n0.744659 0.791785 a 7\n"
            "0.221346 1.23933 b 7\n0.522376 1.83867 b 7\n0.0688569 2.52675 b 7\n0.350593 2.93497 a 7\n");
}

TEST(Samples, OfALatinHypercubeTakeEveryPartOnce) {
  const std::vector<Sample> all = samples(R"("method": "latin-hypercube", "samples": 50, "seeds": [3], "vary": [
    {"key": "/a", "from": 0, "to": 50}, {"key": "/b", "from": 0, "to": 50}])");
  for (const std::size_t axis : {0, 1}) {
    std::set<int> parts;
    for (const Sample& sample : all) parts.insert(int(std::floor(*sample.values[axis].number)));
    EXPECT_EQ(parts.size(), 50u);
  }
}

TEST(Statistics, AreThoseOfTheDefinitions) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Spread spread = spread_of({2, none, 4, 4, 6});
  EXPECT_EQ(spread.count, 4u);
  EXPECT_DOUBLE_EQ(spread.mean, 4);
  EXPECT_DOUBLE_EQ(spread.deviation, std::sqrt(8.0 / 3));
  EXPECT_EQ(spread.least, 2);
  EXPECT_EQ(spread.most, 6);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, 8, 27, 64}), 1);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {4, 3, 2, 1}), -1);
  // Ranks 0, 1.5, 1.5, 3, 4 and 1, 0, 2.5, 2.5, 4.
  EXPECT_NEAR(rank_correlation({1, 2, 2, 3, 5, 9}, {2, 1, 3, 3, 4, none}), 7.25 / 9.5, 1e-12);
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2, 3}, {5, 5, 5})));
}

}  // namespace
}  // namespace ctpm::sweep
