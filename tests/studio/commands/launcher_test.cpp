// The launcher on machines that lack things: it must say what to install and change nothing.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;

/// A machine that has only the programs put into `bin`.
class Machine {
 public:
  Machine() {
    fs::create_directories(bin());
    for (const char* program : {"bash", "dirname", "id"})
      fs::create_symlink(fs::path("/usr/bin") / program, bin() / program);
  }
  void add_program(const std::string& name, const std::string& script) {
    std::ofstream(bin() / name) << "#!/bin/bash\n" << script << "\n";
    fs::permissions(bin() / name, fs::perms::owner_all);
  }
  testing::ProgramOutcome launch(const std::string& no_install) {
    return testing::run({"/usr/bin/env", "-i", "PATH=" + bin().string(), "CTPM_NO_INSTALL=" + no_install,
                         "CTPM_BUILD_DIR=" + (folder_.path() / "build").string(), "/usr/bin/bash",
                         std::string(CTPM_SOURCE_DIR) + "/ctpm", "demo"},
                        folder_.path());
  }
  fs::path bin() const { return folder_.path() / "bin"; }
  const testing::TemporaryFolder& folder() const { return folder_; }

 private:
  testing::TemporaryFolder folder_;
};

TEST(Launcher, NamesThePackagesWhereThereIsNoApt) {
  Machine machine;
  const auto outcome = machine.launch("0");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("not a Debian-like machine"), std::string::npos) << outcome.err;
  for (const char* package : {"libcgal-dev", "libassimp-dev", "libosmesa6-dev", "cmake"})
    EXPECT_NE(outcome.err.find(package), std::string::npos) << outcome.err;
  EXPECT_EQ(machine.folder().list(), "bin");
}

TEST(Launcher, NeverInstallsWhenItIsForbidden) {
  Machine machine;
  machine.add_program("dpkg-query", "exit 1");
  machine.add_program("apt-get", "echo called > " + (machine.folder().path() / "apt-was-called").string());
  const auto outcome = machine.launch("1");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("CTPM_NO_INSTALL=1 is set and these packages are missing: g++ cmake"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(machine.folder().list(), "bin");
}

}  // namespace
}  // namespace ctpm
