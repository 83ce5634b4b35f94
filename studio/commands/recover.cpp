#include "recordings/recover.h"

#include <memory>

#include "studio/commands/command.h"
#include "studio/commands/console.h"

namespace ctpm::commands {
namespace {

struct RecoverArguments {
  std::string in, out;
};

int run_recover(const RecoverArguments& arguments) {
  const Result<recordings::RecoverReport> report = recordings::recover_session(arguments.in, arguments.out);
  if (!report) return print_errors(report.errors());
  print("%s: %lld ticks, %lld keyframes, %lld events saved\n", arguments.out.c_str(), (long long)report->ticks_saved,
        (long long)report->keyframes_saved, (long long)report->events_saved);
  for (const std::string& repair : report->repairs) print("mended: %s\n", repair.c_str());
  for (const std::string& loss : report->losses) print("lost: %s\n", loss.c_str());
  print("%s\n", recordings::to_string(report->verdict).c_str());
  if (!report->verdict.same) return exit_bad_verdict;
  return report->complete ? exit_good : exit_partly_recovered;
}

}  // namespace

Command add_recover(CLI::App& program) {
  auto arguments = std::make_shared<RecoverArguments>();
  CLI::App* app = program.add_subcommand(
      "recover", "Saves what can be saved of a damaged session; exit code 3 if something is missing.");
  app->footer("Example: ctpm recover damaged.ctpm -o saved.ctpm");
  app->add_option("session", arguments->in, "Session file (.ctpm)")->required();
  app->add_option("-o,--output", arguments->out, "New session file")->required();
  return {app, [arguments] { return run_recover(*arguments); }};
}

}  // namespace ctpm::commands
