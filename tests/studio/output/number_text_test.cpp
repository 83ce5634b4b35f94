// Numbers as people read them.

#include "studio/output/number_text.h"

#include <gtest/gtest.h>

namespace ctpm::output {
namespace {

TEST(NumberText, ShortNumbersHaveNoPowerOfTenWherePeopleWriteNone) {
  EXPECT_EQ(short_number(1063.4, 3), "1060");
  EXPECT_EQ(short_number(-20164, 2), "-20000");
  EXPECT_EQ(short_number(999.6, 3), "1000");
  EXPECT_EQ(short_number(12.5, 4), "12.5");
  EXPECT_EQ(short_number(0.001234, 3), "0.00123");
  EXPECT_EQ(short_number(1e-9, 3), "1e-09");
  EXPECT_EQ(short_number(2e18, 3), "2e+18");
  EXPECT_EQ(short_number(0, 3), "0");
}

}  // namespace
}  // namespace ctpm::output
