#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace ctpm::commands {

/// Runs a subcommand after its arguments were parsed; returns an ExitCode.
using Run = std::function<int()>;

/// A subcommand and the function that runs it. Each add_...() adds one subcommand with its options and an example.
struct Command {
  CLI::App* app;
  Run run;
};

Command add_anonymise(CLI::App& program);
Command add_import(CLI::App& program);
Command add_check(CLI::App& program);
Command add_plan(CLI::App& program);
Command add_preview(CLI::App& program);
Command add_watch(CLI::App& program);
Command add_record(CLI::App& program);
Command add_replay(CLI::App& program);
Command add_verify(CLI::App& program);
Command add_info(CLI::App& program);
Command add_cohort(CLI::App& program);
Command add_compare(CLI::App& program);
Command add_recover(CLI::App& program);
Command add_sign(CLI::App& program);
Command add_key(CLI::App& program);
Command add_export(CLI::App& program);
Command add_demo(CLI::App& program);
Command add_fit(CLI::App& program);
Command add_calibrate(CLI::App& program);
Command add_paper(CLI::App& program);
Command add_bench(CLI::App& program);
Command add_stability(CLI::App& program);
Command add_fidelity(CLI::App& program);
Command add_studio(CLI::App& program);
Command add_sweep(CLI::App& program);

}  // namespace ctpm::commands
