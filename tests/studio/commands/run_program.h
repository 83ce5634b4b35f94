#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace ctpm::testing {

struct ProgramOutcome {
  int code = -1;  ///< exit code; -1 if a signal ended it
  std::string out, err;
  double cpu_s = 0;       ///< processor time of all its threads [s]
  double memory_mib = 0;  ///< the most that it had at a time [MiB]
};

inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

enum class Whose { own, nobodys };  ///< rights

/// Runs `command` (program and arguments, no shell) in `folder`. With nobody's rights, which modes of files limit, if
/// this process is root's, for whom they do not.
inline ProgramOutcome run(const std::vector<std::string>& command, const std::filesystem::path& folder,
                          Whose rights = Whose::own) {
  const std::filesystem::path out = folder / ".stdout", err = folder / ".stderr";
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.c_str()) != 0) _exit(127);
    const int out_file = open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    const int err_file = open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    dup2(out_file, STDOUT_FILENO), dup2(err_file, STDERR_FILENO);
    constexpr uid_t kNobody = 65534;
    if (rights == Whose::nobodys && geteuid() == 0 && setuid(kNobody) != 0) _exit(126);
    std::vector<std::string> copies = command;
    std::vector<char*> argv;
    for (std::string& argument : copies) argv.push_back(argument.data());
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  struct rusage used = {};
  wait4(child, &status, 0, &used);
  ProgramOutcome outcome;
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  outcome.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  outcome.memory_mib = double(used.ru_maxrss) / 1024;
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.out = slurp(out), outcome.err = slurp(err);
  std::filesystem::remove(out), std::filesystem::remove(err);
  return outcome;
}

/// Runs `ctpm` with these arguments in `folder`.
inline ProgramOutcome run_ctpm(std::vector<std::string> arguments, const std::filesystem::path& folder) {
  arguments.insert(arguments.begin(), CTPM_PROGRAM);
  return run(arguments, folder);
}

/// A new folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "ctpm-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

  /// Names of everything in it, sorted, separated by spaces.
  std::string list() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : " ") + name;
    return all;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace ctpm::testing
