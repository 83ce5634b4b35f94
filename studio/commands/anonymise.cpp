#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/output/printable.h"
#include "studio/session/anonymise.h"

namespace ctpm::commands {
namespace {

struct AnonymiseArguments {
  session::AnonymiseRequest request;
  std::string key;
};

int run_anonymise(const AnonymiseArguments& arguments) {
  bool is_new = false;
  const Result<recordings::PseudonymKey> key = arguments.key.empty()
                                                   ? recordings::PseudonymKey::make()
                                                   : recordings::PseudonymKey::read_or_make(arguments.key, is_new);
  if (!key) return print_errors(key.errors());
  const Result<std::vector<session::AnonymisedSession>> done = session::anonymise(arguments.request, *key);
  if (!done) {
    std::error_code ignored;
    if (is_new) std::filesystem::remove(arguments.key, ignored);  // nothing has a name of it
    return print_errors(done.errors());
  }
  for (const session::AnonymisedSession& one : *done) {
    print("%s: %s\n", one.to.c_str(), one.from.c_str());
    if (!one.trainee.empty()) print("  trainee  %s\n", output::printable(one.trainee).c_str());
    for (const std::string& what : one.removed) print("  removed  %s\n", output::printable(what).c_str());
  }
  for (const std::string& what : session::what_stays()) print("stays: %s\n", what.c_str());
  if (is_new)
    print_remark(arguments.key +
                 ": a new key; who has it can test whose pseudonym it is, so keep it apart from these files");
  else if (arguments.key.empty())
    print_remark("no key is kept: another run gives other pseudonyms (--key FILE keeps them the same)");
  return exit_good;
}

}  // namespace

Command add_anonymise(CLI::App& program) {
  auto arguments = std::make_shared<AnonymiseArguments>();
  session::AnonymiseRequest& request = arguments->request;
  CLI::App* app = program.add_subcommand(
      "anonymise", "Writes sessions anew without names, texts, paths, devices and times of day; they still verify.");
  app->footer("Example: ctpm anonymise ana/*.ctpm --trainee \"Ana Smith\" --key course.key -o anonymous/");
  app->add_option("session", request.sessions, "Session files (.ctpm)")->required();
  app->add_option("-o,--output", request.output,
                  "New file; of several sessions a folder, in which each is named by its pseudonym")
      ->required();
  app->add_option("--key", arguments->key,
                  "File with the key of the pseudonyms, the same for sessions that belong together; made if missing");
  app->add_option("--trainee", request.trainee, "Whose sessions these are; they hold the pseudonym alone");
  app->add_flag("--keep-names", request.keep_names,
                "Keep the names of the scene, its organs, tools, cameras, probes and obstacles");
  return {app, [arguments] { return run_anonymise(*arguments); }};
}

}  // namespace ctpm::commands
