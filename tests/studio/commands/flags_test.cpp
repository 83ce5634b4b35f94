#include "studio/commands/flags.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;

/// Fields that studio's libraries name in errors.
std::set<std::string> named_fields() {
  const std::regex name(R"re("([a-z_]+\.[a-z_]+)")re"), file("\\.(h|html|json|csv|sqlite)$");
  std::set<std::string> fields;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(CTPM_SOURCE_DIR) / "studio")) {
    const std::string path = entry.path().generic_string();
    if (path.find("/commands/") != std::string::npos || !(path.ends_with(".cpp") || path.ends_with(".h"))) continue;
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    const std::string source = text.str();
    if (source.find("option_name(") == std::string::npos || path.find("/option_name.") != std::string::npos) continue;
    for (std::sregex_iterator it(source.begin(), source.end(), name), end; it != end; ++it)
      if (const std::string field = (*it)[1]; !std::regex_search(field, file)) fields.insert(field);
  }
  return fields;
}

TEST(Flags, EveryFieldThatAnErrorNamesHasAFlagOfTheProgram) {
  const std::set<std::string> fields = named_fields();
  EXPECT_GT(fields.size(), 20u);
  const testing::TemporaryFolder folder;
  std::string help;
  const std::vector<std::string> commands[]{{"calibrate"}, {"import"},       {"record"},          {"replay"},
                                            {"export"},    {"preview"},      {"paper"},           {"fidelity"},
                                            {"studio"},    {"sweep", "run"}, {"sweep", "collect"}};
  for (std::vector<std::string> command : commands) {
    command.push_back("--help");
    help += testing::run_ctpm(command, folder.path()).out;
  }
  for (const std::string& field : fields) {
    const std::string flag = commands::flag_of(field);
    EXPECT_EQ(flag[0], '-') << field << " has no flag";
    EXPECT_TRUE(std::regex_search(help, std::regex("[ ,]" + flag + "[ ,]"))) << flag << " is no flag of the program";
  }
}

TEST(Flags, ACommandThatThereIsNotIsNamedWithTheNearestOne) {
  const testing::TemporaryFolder folder;
  const testing::ProgramOutcome near = testing::run_ctpm({"recrod", "a.json"}, folder.path());
  EXPECT_EQ(near.code, 2);
  EXPECT_EQ(near.err, "recrod: error: there is no such command (did you mean ctpm record?)\n");
  const testing::ProgramOutcome far = testing::run_ctpm({"frobnicate"}, folder.path());
  EXPECT_EQ(far.code, 2);
  EXPECT_EQ(far.err, "frobnicate: error: there is no such command (ctpm --help lists them)\n");
}

}  // namespace
}  // namespace ctpm
