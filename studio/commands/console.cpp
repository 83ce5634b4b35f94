#include "studio/commands/console.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdarg>
#include <cstdio>
#include <string_view>

#include "studio/commands/flags.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/output/printable.h"

namespace ctpm::commands {

int print_errors(const Errors& errors) {
  for (const Error& error : output::name_options(errors, flag_of))
    std::fprintf(stderr, "%s\n", output::printable(to_string(error)).c_str());
  return exit_bad_input;
}

void print_warnings(const Errors& warnings) {
  for (const Error& warning : warnings)
    print_remark(warning.where + ": warning: " + warning.message +
                 (warning.hint.empty() ? "" : " (" + warning.hint + ")"));
}

void print_remark(const std::string& text) { std::fprintf(stderr, "%s\n", output::printable(text, true).c_str()); }

void print(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  std::string text(std::size_t(std::max(0, std::vsnprintf(nullptr, 0, format, arguments))) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(again);
  va_end(arguments);
  text.pop_back();
  std::fputs(output::printable(text, true).c_str(), stdout);
}

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_ - std::chrono::seconds(1)) {}

ProgressLine::~ProgressLine() {
  if (is_terminal_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(std::int64_t done, std::int64_t total) {
  const Clock::time_point now = Clock::now();
  // Off a terminal, in a log, nobody waits for the next line; but silence for minutes looks like a hang.
  if (now - last_ < (is_terminal_ ? std::chrono::milliseconds(200) : std::chrono::minutes(1))) return;
  last_ = now;
  const double spent = std::chrono::duration<double>(now - start_).count();
  std::string text = what_;
  if (done > 0 && total > 0)
    text += ": " + output::fixed(100.0 * double(done) / double(total), 0) + " %, " +
            output::fixed(spent * double(total - done) / double(done), 0) + " s left";
  else if (done > 0)
    text += ": " + output::fixed(spent, 0) + " s";
  if (!added_.empty()) text += ", " + added_;
  std::fprintf(stderr, is_terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
}

}  // namespace ctpm::commands
