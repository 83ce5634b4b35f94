#include <gtest/gtest.h>

#include "tests/recordings/forgeries.h"
#include "tests/recordings/kills.h"
#include "tests/recordings/truth.h"

namespace ctpm {
namespace {

TEST(CrashSlow, AThousandKilledRecordersLoseAtMost200MsEach) { testing::kill_recorders(1000); }

TEST(DamageSlow, VerifyingAfterAThousandFlippedBitsIsNeverWrong) { testing::verify_flipped_bits(1000, 1000); }

TEST(ForgedFilesSlow, AThousandNeitherHarmNorDeceive) { testing::verify_forgeries(1000, 1000); }

}  // namespace
}  // namespace ctpm
