#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "recordings/session_reader.h"
#include "recordings/signature.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/physics_warning.h"
#include "studio/output/printable.h"
#include "studio/session/whole_verdict.h"
#include "studio/version/version.h"

namespace ctpm::commands {
namespace {

struct VerifyArguments {
  std::string file, key;
  int threads = 1;
};

/// Prints who signed the session. False: not with the key that is asked for.
bool print_signature(const recordings::Signature* signature, const std::string& file, const std::string& wanted) {
  if (!signature) {
    if (!wanted.empty()) print("%s: is not signed\n", file.c_str());
    return wanted.empty();
  }
  print("%s: signed with the key %s%s%s\n", file.c_str(), signature->key.c_str(), signature->name.empty() ? "" : " by ",
        output::printable(signature->name).c_str());
  if (wanted.empty() || signature->key == wanted) return true;
  print("%s: that is not the key %s\n", file.c_str(), wanted.c_str());
  return false;
}

/// Prints the verdict; a bad one with the builds that recorded and replayed.
void print_verdict(const recordings::SessionReader& session, const session::WholeVerdict& verdict, double seconds) {
  const double lived = double(verdict.ticks.ticks_compared) * session.start().model.tick;
  print("%s: %s; %.1f times as fast as it was lived\n", session.path().c_str(),
        output::printable(verdict.text()).c_str(), lived / std::max(seconds, 1e-9));
  if (verdict.ticks.same) return;
  print("recorded by: %s\nreplayed by: %s\n", output::printable(session.start().build_fingerprint).c_str(),
        version::build_fingerprint().c_str());
  print_remark("builds of one physics revision replay each other's sessions to the bit; builds of two need not");
}

int run_verify(const VerifyArguments& arguments) {
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(arguments.file);
  if (!reader) return print_errors(reader.errors());
  if (!reader->ended_cleanly())
    print_remark(arguments.file + ": warning: the session has no clean end; what is there is verified");
  warn_of_physics(*reader);
  const Result<std::string> wanted =
      arguments.key.empty() ? Result<std::string>(std::string()) : recordings::read_public_key(arguments.key);
  if (!wanted) return print_errors(wanted.errors());
  recordings::VerifyOptions options;
  options.threads = arguments.threads;
  ProgressLine progress("verifying");
  options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  const auto start = std::chrono::steady_clock::now();
  const Result<session::WholeVerdict> verdict = session::verify_whole(*reader, options);
  if (!verdict) return print_errors(verdict.errors());
  print_verdict(*reader, *verdict, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  const Result<std::optional<recordings::Signature>> signature = recordings::check_signature(arguments.file);
  if (!signature && recordings::can_sign()) return print_errors(signature.errors());
  if (!signature) print_remark(to_string(signature.errors().front()));
  const bool is_known = print_signature(signature && *signature ? &**signature : nullptr, arguments.file, *wanted);
  return verdict->same() && is_known ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_verify(CLI::App& program) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* app = program.add_subcommand(
      "verify", "Checks a whole session: its file, every state hash of a replay, its events, its signature.");
  app->footer("Example: ctpm verify out/demo.ctpm");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  app->add_option("--key", arguments->key, "The session must be signed with this key (PEM, secret or public)");
  app->add_option("--threads", arguments->threads, "Parts between keyframes that are replayed side by side")
      ->check(CLI::Range(1, 256));
  return {app, [arguments] { return run_verify(*arguments); }};
}

}  // namespace ctpm::commands
