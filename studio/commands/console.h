#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/model/result.h"

namespace ctpm::commands {

/// What the program says to its caller.
enum ExitCode : int {
  exit_good = 0,              ///< done, and good
  exit_bad_verdict = 1,       ///< done, and the verdict is bad: diverged, unstable, out of bounds
  exit_bad_input = 2,         ///< bad usage or bad input
  exit_partly_recovered = 3,  ///< done, but something could not be saved
};

/// Prints every error to stderr, one a line, with the flags in place of option names; returns exit_bad_input.
int print_errors(const Errors& errors);

/// Prints every warning of a scene to stderr, one a line.
void print_warnings(const Errors& warnings);

/// Prints a line to stderr: progress and remarks; results go to stdout.
void print_remark(const std::string& text);

/// A line on stderr that says how far long work is and how long it will still take; silent where stderr is no
/// terminal.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::int64_t done, std::int64_t total);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool is_terminal_;
  Clock::time_point start_, last_;
};

}  // namespace ctpm::commands
