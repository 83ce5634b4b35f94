#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/recordings/sessions.h"

namespace ctpm::testing {

/// Content of an undamaged session, for comparison.
struct Truth {
  recordings::SessionStart start;
  std::vector<recordings::TickRecord> records;
  std::vector<recordings::Event> events;
  std::vector<std::uint64_t> state_hashes;  ///< before each tick and after the last
  std::uint64_t model_hash = 0;
};

Truth truth_of(const std::string& path, const recordings::SessionStart& start, const Lived& lived);

/// Result of reading one damaged file.
struct Finding {
  bool opened = false;
  bool complained = false;  ///< open() or a later call returned an error
};

/// Everything that the reader returns must be true, and every error must name the file.
Finding expect_error_or_truth(const std::string& path, const Truth& truth, const std::string& what);

/// Flips `count` random bits of a session, one at a time. Verifying must find each, or all that can be read is as it
/// was: SQLite's pages have bytes that nothing uses. Prints how many of both there were.
void verify_flipped_bits(int count, unsigned seed);

}  // namespace ctpm::testing
