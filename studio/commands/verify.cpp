#include <algorithm>
#include <chrono>
#include <memory>

#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/physics_warning.h"
#include "studio/version/version.h"

namespace ctpm::commands {
namespace {

struct VerifyArguments {
  std::string file;
  int threads = 1;
};

/// Prints the verdict; a bad one with the builds that recorded and replayed.
void print_verdict(const recordings::SessionReader& session, const recordings::Verdict& verdict, double seconds) {
  const double lived = double(verdict.ticks_compared) * session.start().model.tick;
  std::printf("%s: %s; %.1f times as fast as it was lived\n", session.path().c_str(),
              recordings::to_string(verdict).c_str(), lived / std::max(seconds, 1e-9));
  if (verdict.same) return;
  std::printf("recorded by: %s\nreplayed by: %s\n", session.start().build_fingerprint.c_str(),
              version::build_fingerprint().c_str());
  print_remark("builds of one physics revision replay each other's sessions to the bit; builds of two need not");
}

int run_verify(const VerifyArguments& arguments) {
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(arguments.file);
  if (!reader) return print_errors(reader.errors());
  if (!reader->ended_cleanly())
    print_remark(arguments.file + ": warning: the session has no clean end; what is there is verified");
  warn_of_physics(*reader);
  recordings::VerifyOptions options;
  options.threads = arguments.threads;
  ProgressLine progress("verifying");
  options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  const auto start = std::chrono::steady_clock::now();
  const Result<recordings::Verdict> verdict = recordings::verify_session(*reader, options);
  if (!verdict) return print_errors(verdict.errors());
  print_verdict(*reader, *verdict, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return verdict->same ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_verify(CLI::App& program) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* app = program.add_subcommand("verify", "Replays a session without pictures and compares every state hash.");
  app->footer("Example: ctpm verify out/demo.ctpm");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  app->add_option("--threads", arguments->threads, "Parts between keyframes that are replayed side by side")
      ->check(CLI::Range(1, 256));
  return {app, [arguments] { return run_verify(*arguments); }};
}

}  // namespace ctpm::commands
