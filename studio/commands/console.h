#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/model/result.h"

namespace ctpm::commands {

/// Exit codes of the program.
enum ExitCode : int {
  exit_good = 0,              ///< done, and good
  exit_bad_verdict = 1,       ///< done, and the verdict is bad: diverged, unstable, out of bounds
  exit_bad_input = 2,         ///< bad usage or bad input
  exit_partly_recovered = 3,  ///< done, but something could not be saved
};

/// Prints errors to stderr, one per line, with flags instead of option names; returns exit_bad_input.
int print_errors(const Errors& errors);

/// Prints the warnings of a scene to stderr, one per line.
void print_warnings(const Errors& warnings);

/// Prints to stdout like printf, with control characters but newlines written out: names and texts of files reach the
/// terminal only through this. A text that may hold newlines is made printable first.
[[gnu::format(printf, 1, 2)]] void print(const char* format, ...);

/// Prints a line to stderr, for progress and remarks; results go to stdout.
void print_remark(const std::string& text);

/// A progress line on stderr with the remaining time, or the count so far if the total is unknown; where stderr is
/// not a terminal, a line a minute.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::int64_t done, std::int64_t total);
  /// Shows `text` behind it from now on.
  void add(std::string text) { added_ = std::move(text); }

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_, added_;
  bool is_terminal_;
  Clock::time_point start_, last_;
};

}  // namespace ctpm::commands
