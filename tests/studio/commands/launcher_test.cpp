// The launcher on machines that lack things: it must say what to install and change nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

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

/// A machine that has what the launcher uses, with a compiler that brings the program of these tests.
class BuildingMachine : public Machine {
 public:
  BuildingMachine() {
    for (const char* program : {"cat", "flock", "grep", "ln", "mkdir", "sleep"})
      fs::create_symlink(fs::path("/usr/bin") / program, bin() / program);
    add_program("dpkg-query", "echo -n installed");
    add_program("apt-get", "echo called >apt-was-called");
    add_program("cmake", "while [ $# -gt 0 ]; do [ \"$1\" = -B ] && : >\"$2/build.ninja\"; shift; done");
    const std::string built = (folder().path() / "build/bin").string();
    add_program("ninja", "if [ -e " + built + "/ctpm ]; then echo 'ninja: no work to do.'\n" +
                             "elif [[ \" $* \" == *' -n '* ]]; then echo '[1/1] Building CXX object main.o'\n" +
                             "else mkdir -p " + built + " && ln -s " CTPM_PROGRAM " " + built + "/ctpm; fi");
  }
  /// Runs bash with `script`, in which `studio` is the launcher with that command. `before` are words before bash.
  testing::ProgramOutcome run_script(const std::string& script, std::vector<std::string> before = {},
                                     const std::string& display = "") {
    const std::vector<std::string> words{
        "/usr/bin/env",
        "-i",
        "PATH=" + bin().string(),
        "CTPM_BUILD_DIR=" + (folder().path() / "build").string(),
        "DISPLAY=" + display,
        "/usr/bin/bash",
        "-c",
        "studio() { exec bash " CTPM_SOURCE_DIR "/ctpm studio \"$@\"; }\n" + kAsk + script};
    before.insert(before.end(), words.begin(), words.end());
    return testing::run(before, folder().path());
  }

 private:
  /// ask ADDRESS TARGET: the first line of the answer. call ADDRESS NAME: a call without parameters, its whole answer.
  static inline const std::string kAsk = R"(
host_of() { local host=${1#http://}; echo "${host%%/*}"; }
ask() {
  local host; host=$(host_of "$1")
  exec 3<>"/dev/tcp/${host%:*}/${host#*:}"
  printf 'GET %s HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n' "$2" "$host" >&3
  local line; read -t 30 -r line <&3; exec 3>&-; echo "$2 $line"
}
call() {
  local host body; host=$(host_of "$1"); body="{\"id\": 1, \"call\": \"$2\", \"params\": {}}"
  exec 3<>"/dev/tcp/${host%:*}/${host#*:}"
  printf 'POST /call HTTP/1.1\r\nHost: %s\r\nAuthorization: Bearer %s\r\nContent-Type: application/json\r\nContent-Length: %s\r\nConnection: close\r\n\r\n%s' \
    "$host" "${1#*token=}" "${#body}" "$body" >&3
  cat <&3; exec 3>&-
}
)";
};

TEST(Launcher, StudioIsBuiltOnceServesAFolderPrintsItsAddressAndOpensIt) {
  BuildingMachine machine;
  // What a desktop opens addresses with: it asks for the page, and ends the studio as Ctrl-C would.
  machine.add_program("xdg-open", "echo \"$1\" >opened; . ./asks; ask \"$1\" / >page; kill -INT \"$(<process)\"");
  fs::create_directories(machine.folder().path() / "scenes");
  for (const std::string folder : {"", "scenes"}) {
    const testing::ProgramOutcome outcome =
        machine.run_script("declare -f host_of ask >asks; echo $$ >process; studio " + folder + " --port 0", {}, ":0");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(outcome.out.starts_with("http://127.0.0.1:")) << outcome.out;
    EXPECT_EQ(testing::slurp(machine.folder().path() / "opened"), outcome.out);
    EXPECT_TRUE(testing::slurp(machine.folder().path() / "page").starts_with("/ HTTP/1.1 200"));
    // It is built the first time, without a word about packages that are there.
    EXPECT_EQ(outcome.err.find("building") != std::string::npos, folder.empty()) << outcome.err;
    EXPECT_EQ(outcome.err.find("installing"), std::string::npos) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(machine.folder().path() / "apt-was-called"));
}

TEST(Launcher, StudioRunsWithoutANetworkNpmNodeAndADisplay) {
  BuildingMachine machine;
  if (testing::run({"/usr/bin/unshare", "-rn", "/usr/bin/env", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "ip", "link",
                    "set", "lo", "up"},
                   machine.folder().path())
          .code != 0)
    GTEST_SKIP() << "this machine does not let its user take the network away (unshare -rn, ip)";
  const fs::path scenes = machine.folder().path() / "scenes";
  fs::create_directories(scenes);
  fs::copy(fs::path(CTPM_SOURCE_DIR) / "scenes/kidney.json", scenes);
  const testing::ProgramOutcome outcome = machine.run_script(
      R"(cat /proc/net/dev
(studio scenes --port 0) >address &
until grep -q token address; do sleep 0.05; done
address=$(<address)
for target in / /app.js /style.css; do ask "$address" $target; done
call "$address" folder.list
kill -INT $!; wait $!; echo "ended with $?")",
      {"/usr/bin/unshare", "-rn", "/usr/bin/bash", "-c",
       "PATH=/usr/sbin:/usr/bin:/sbin:/bin ip link set lo up && exec \"$@\"", "bash"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto says = [&](const char* what) {
    EXPECT_NE(outcome.out.find(what), std::string::npos) << what << " is not in\n" << outcome.out << outcome.err;
  };
  for (const char* target : {"/ HTTP/1.1 200", "/app.js HTTP/1.1 200", "/style.css HTTP/1.1 200"}) says(target);
  says("\"path\": \"kidney.json\"");
  says("ended with 0");
  // Nothing but loopback was there, and nothing that could build a page.
  const std::string interfaces = outcome.out.substr(0, outcome.out.find("/ HTTP"));
  EXPECT_EQ(std::count(interfaces.begin(), interfaces.end(), ':'), 1) << interfaces;
  for (const char* program : {"npm", "node", "xdg-open"}) EXPECT_FALSE(fs::exists(machine.bin() / program));
}

}  // namespace
}  // namespace ctpm
