#include "core/model/nearest_rank.h"

#include <gtest/gtest.h>

namespace ctpm {
namespace {

TEST(NearestRank, PercentilesAreValuesThatWereMeasured) {
  std::vector<double> values;
  for (int i = 1000; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(percentile(values, 0.5), 500);
  EXPECT_EQ(percentile(values, 0.99), 990);
  EXPECT_EQ(percentile(values, 0.999), 999);
  EXPECT_EQ(percentile<double>({7}, 0.999), 7);
  EXPECT_EQ(percentile<double>({}, 0.5), 0);
}

}  // namespace
}  // namespace ctpm
