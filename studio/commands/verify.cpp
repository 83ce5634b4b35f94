#include <memory>

#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "studio/commands/command.h"
#include "studio/console.h"

namespace ctpm {
namespace {

struct VerifyArguments {
  std::string file;
};

int run_verify(const VerifyArguments& arguments) {
  Result<SessionReader> reader = SessionReader::open(arguments.file);
  if (!reader) return print_errors(reader.errors());
  if (!reader->ended_cleanly())
    print_remark(arguments.file + ": warning: the session has no clean end; what is there is verified");
  VerifyOptions options;
  ProgressLine progress("verifying");
  options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  const Result<Verdict> verdict = verify_session(*reader, options);
  if (!verdict) return print_errors(verdict.errors());
  std::printf("%s: %s\n", arguments.file.c_str(), to_string(*verdict).c_str());
  return verdict->same ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_verify(CLI::App& program) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* app =
      program.add_subcommand("verify", "Replays a session without pictures and compares every state hash.");
  app->footer("Example: ctpm verify out/demo.ctpm");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  return {app, [arguments] { return run_verify(*arguments); }};
}

}  // namespace ctpm
