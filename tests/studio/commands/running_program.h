#pragma once

#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "tests/studio/commands/run_program.h"

namespace ctpm::testing {

/// `ctpm` while it runs.
class RunningProgram {
 public:
  RunningProgram(std::vector<std::string> arguments, const std::filesystem::path& folder) : folder_(folder) {
    arguments.insert(arguments.begin(), CTPM_PROGRAM);
    std::filesystem::remove(folder_ / ".stdout"), std::filesystem::remove(folder_ / ".stderr");
    child_ = fork();
    if (child_ == 0) {
      if (chdir(folder_.c_str()) != 0) _exit(127);
      dup2(open(".stdout", O_CREAT | O_TRUNC | O_WRONLY, 0600), STDOUT_FILENO);
      dup2(open(".stderr", O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
      std::vector<char*> argv;
      for (std::string& argument : arguments) argv.push_back(argument.data());
      argv.push_back(nullptr);
      execv(argv[0], argv.data());
      _exit(127);
    }
  }
  ~RunningProgram() {
    if (child_ > 0) ::kill(child_, SIGKILL), ::waitpid(child_, nullptr, 0);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// False: `is_there()` did not become true within 30 s.
  template <typename IsThere>
  bool wait_until(const IsThere& is_there) const {
    for (int i = 0; i < 3000; ++i) {
      if (is_there()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  /// What follows `text` on its line of stderr, once it is there; empty after 30 s.
  std::string wait_for(const std::string& text) const {
    std::string rest;
    wait_until([&] {
      const std::string said = slurp(folder_ / ".stderr");
      const std::size_t at = said.find(text), end = said.find('\n', at);
      if (at == std::string::npos || end == std::string::npos) return false;
      rest = said.substr(at + text.size(), end - at - text.size());
      return true;
    });
    return rest;
  }

  pid_t process() const { return child_; }
  void interrupt() const { ::kill(child_, SIGINT); }

  /// Lets no thread of it run for a while.
  void stop_for(std::chrono::milliseconds time) const {
    ::kill(child_, SIGSTOP);
    std::this_thread::sleep_for(time);
    ::kill(child_, SIGCONT);
  }

  /// Waits until it has ended.
  ProgramOutcome outcome() {
    int status = 0;
    struct rusage used {};
    ::wait4(child_, &status, 0, &used);
    child_ = -1;
    most_memory_ = used.ru_maxrss * 1024;
    ProgramOutcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.out = slurp(folder_ / ".stdout"), outcome.err = slurp(folder_ / ".stderr");
    std::filesystem::remove(folder_ / ".stdout"), std::filesystem::remove(folder_ / ".stderr");
    return outcome;
  }
  long most_memory() const { return most_memory_; }  ///< that it had at once [bytes]

 private:
  std::filesystem::path folder_;
  pid_t child_ = -1;
  long most_memory_ = 0;
};

}  // namespace ctpm::testing
