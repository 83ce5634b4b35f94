#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/studio/commands/running_program.h"

namespace ctpm::testing {

inline const std::string kPress = "liver-press-expert.ctpm", kCut = "kidney-cut-expert.ctpm";

/// A folder with two shipped sessions.
class Reviewing : public ::testing::Test {
 protected:
  Reviewing() {
    namespace fs = std::filesystem;
    for (const std::string& name : {kPress, kCut})
      fs::copy(fs::path(CTPM_SHIPPED_SESSIONS) / name, folder_.path() / name);
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
};

}  // namespace ctpm::testing
