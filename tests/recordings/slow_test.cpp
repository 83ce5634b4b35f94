#include <gtest/gtest.h>

#include "tests/recordings/kills.h"

namespace ctpm {
namespace {

TEST(CrashSlow, AThousandKilledRecordersLoseAtMost200MsEach) { testing::kill_recorders(1000); }

}  // namespace
}  // namespace ctpm
