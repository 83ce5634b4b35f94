#include <CLI/CLI.hpp>
#include <clocale>
#include <exception>
#include <vector>

#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/unknown_command.h"

int main(int argc, char** argv) {
  using namespace ctpm::commands;
  std::setlocale(LC_ALL, "C");  // numbers have a decimal point in every locale

  CLI::App program{
      "ctpm: a studio for soft-tissue scenes.\n"
      "Authors import organ meshes, trainees record and replay sessions, reviewers export videos.",
      "ctpm"};
  program.set_version_flag("--version", CTPM_VERSION);
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::simple);
  const std::vector<Command> commands{
      add_import(program), add_check(program),    add_plan(program),      add_preview(program), add_watch(program),
      add_record(program), add_replay(program),   add_verify(program),    add_info(program),    add_recover(program),
      add_sign(program),   add_key(program),      add_anonymise(program), add_cohort(program),  add_export(program),
      add_demo(program),   add_fit(program),      add_paper(program),     add_compare(program), add_stability(program),
      add_bench(program),  add_fidelity(program), add_studio(program),    add_sweep(program),   add_calibrate(program)};
  if (argc > 1 && argv[1][0] != '-' && !is_among(commands, argv[1])) return refuse_unknown(commands, argv[1]);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? exit_good : exit_bad_input;
  }
  try {
    for (const Command& command : commands)
      if (command.app->parsed()) return command.run();
  } catch (const std::exception& error) {
    // Our own code does not throw; this is a lack of memory or another resource.
    return print_errors({{"", error.what(), ""}});
  }
  return exit_bad_input;
}
