#include "studio/commands/console.h"

#include <unistd.h>

#include <cstdio>

#include "studio/commands/flags.h"
#include "studio/output/option_name.h"

namespace ctpm::commands {

int print_errors(const Errors& errors) {
  for (const Error& error : output::name_options(errors, flag_of))
    std::fprintf(stderr, "%s\n", to_string(error).c_str());
  return exit_bad_input;
}

void print_warnings(const Errors& warnings) {
  for (const Error& warning : warnings)
    print_remark(warning.where + ": warning: " + warning.message +
                 (warning.hint.empty() ? "" : " (" + warning.hint + ")"));
}

void print_remark(const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)), is_terminal_(isatty(STDERR_FILENO) == 1), start_(Clock::now()), last_(start_) {}

ProgressLine::~ProgressLine() {
  if (is_terminal_ && last_ != start_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(std::int64_t done, std::int64_t total) {
  const Clock::time_point now = Clock::now();
  if (!is_terminal_ || total <= 0 || done <= 0 || now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  const double spent = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s: %3.0f %%, %.0f s left", what_.c_str(), 100.0 * double(done) / double(total),
               spent * double(total - done) / double(done));
}

}  // namespace ctpm::commands
