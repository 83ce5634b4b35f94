#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/model/errors.h"
#include "importers/text.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/stop_signal.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"
#include "studio/reports/report.h"
#include "studio/sweep/collect.h"
#include "studio/sweep/each.h"
#include "studio/sweep/plan.h"
#include "studio/sweep/run_sweep.h"
#include "studio/sweep/slurm.h"

namespace ctpm::commands {
namespace {

struct SweepArguments {
  std::vector<std::string> files;
  std::string folder;
  std::optional<std::string> each;  ///< a command with its arguments; unset: a sweep
  int jobs = 0;                     ///< 0: as many as there are cores
  std::optional<std::size_t> from, to;
  bool allow_incomplete = false, with_slurm = false;
  sweep::SlurmRequest slurm;
};

/// What is wrong with the words of a command before any session is looked at.
Errors errors_of(const std::vector<std::string>& command) {
  Errors errors;
  for (const std::string& word : command) {
    std::error_code ignored;
    if (word.ends_with(".ctpm") && !word.starts_with("{") && !std::filesystem::exists(word, ignored))
      errors.push_back({word, "does not exist", "the --each command names it"});
  }
  CLI::App program;
  add_verify(program), add_info(program), add_export(program), add_compare(program);
  std::vector<std::string> words(command.rbegin(), command.rend());  // as CLI11 takes them
  try {
    program.parse(words);
  } catch (const CLI::ParseError& error) {
    errors.push_back({"--each", error.what(), "ctpm " + command.front() + " --help says what it takes"});
  }
  return errors;
}

Result<sweep::Plan> make_plan(const SweepArguments& arguments) {
  if (arguments.each) {
    const std::vector<std::string> command = CLI::detail::split_up(*arguments.each);
    if (command.empty()) return Error{"--each", "needs a command", "one of compare, export, info, verify"};
    Result<sweep::Plan> plan = sweep::plan_each(command, arguments.files);
    if (!plan) return plan;
    if (const Errors errors = errors_of(plan->command); !errors.empty()) return errors;
    return plan;
  }
  if (arguments.files.size() != 1) return Error{"sweep plan", "takes one sweep file", "--each COMMAND takes sessions"};
  Result<sweep::Sweep> sweep = sweep::Sweep::load(arguments.files.front());
  if (!sweep) return sweep.errors();
  return sweep->plan();
}

int plan_sweep(const SweepArguments& arguments) {
  const Result<sweep::Plan> plan = make_plan(arguments);
  if (!plan) {
    Errors errors = plan.errors();
    append(errors, reports::check_folder(arguments.folder));
    return print_errors(errors);
  }
  if (const Result<Done> written = sweep::write_plan(*plan, arguments.folder); !written)
    return print_errors(written.errors());
  std::size_t finished = 0;
  for (const sweep::Task& task : plan->tasks) finished += sweep::is_finished(arguments.folder, task.id);
  print("%s: %s planned", arguments.folder.c_str(),
        importers::counted(std::int64_t(plan->tasks.size()), "session").c_str());
  if (finished > 0) print(", of which %zu are done already", finished);
  print("\n");
  print_remark("written: " + arguments.folder + "/manifest.csv, manifest.json; next: ctpm sweep run " +
               output::shell_word(arguments.folder));
  return exit_good;
}

int print_state(const std::string& folder, const sweep::Collection& collection) {
  print("%s: %s\n", folder.c_str(), sweep::state_text(collection).c_str());
  for (std::size_t i = 0; i < collection.reports.size(); ++i)
    if (collection.reports[i].state == sweep::TaskState::failed)
      print("failed: session %zu, %s: %s\n", i + 1, collection.plan.tasks[i].id.c_str(),
            collection.reports[i].result.error.c_str());
  return collection.is_complete() ? exit_good : exit_bad_verdict;
}

int show_status(const SweepArguments& arguments) {
  const Result<sweep::Collection> collection = sweep::look_at_sweep(arguments.folder);
  if (!collection) return print_errors(collection.errors());
  return print_state(arguments.folder, *collection);
}

/// A slice of which no session is in the plan is a mistake: an element of a job array would do nothing, and say
/// nothing.
Errors check_slice(const SweepArguments& arguments) {
  Errors errors;
  if (arguments.from && arguments.to && *arguments.from > *arguments.to)
    errors.push_back({"--from", "is beyond --to", "both are numbers of sessions in manifest.csv"});
  const Result<sweep::Plan> plan = sweep::read_plan(arguments.folder);
  append(errors, plan);
  if (plan && arguments.from && *arguments.from > plan->tasks.size())
    errors.push_back({"--from",
                      "got " + std::to_string(*arguments.from) + ", and the plan has " +
                          importers::counted(std::int64_t(plan->tasks.size()), "session"),
                      ""});
  return errors;
}

int run_here(const SweepArguments& arguments) {
  if (const Errors errors = check_slice(arguments); !errors.empty()) return print_errors(errors);
  const StopSignal stop;
  sweep::RunRequest request;
  request.folder = arguments.folder;
  request.processes = arguments.jobs > 0 ? arguments.jobs : std::max(1, int(std::thread::hardware_concurrency()));
  if (arguments.from) request.from = *arguments.from - 1;
  if (arguments.to) request.to = *arguments.to;
  request.should_stop = [&] { return stop.came(); };
  const Result<sweep::RunSummary> summary = [&] {
    ProgressLine progress("recording");
    request.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
    return sweep::run_sweep(request);
  }();
  if (!summary) return print_errors(summary.errors());
  const std::int64_t count = summary->recorded + summary->failed;
  print("%s in %s s, %lld failed\n", importers::counted(count, "session").c_str(),
        output::fixed(summary->wall_s, 1).c_str(), (long long)summary->failed);
  if (summary->task_processor_s > 0)
    print("processor time %s s, of which the sweep itself %s %%\n", output::fixed(summary->processor_s, 2).c_str(),
          output::fixed(100 * (summary->processor_s / summary->task_processor_s - 1), 2).c_str());
  if (summary->deaths > 0)
    print_remark(std::to_string(summary->deaths) + " processes died; their sessions were begun again");
  if (summary->was_stopped) print_remark("stopped; the same command goes on");
  // A slice of a large sweep does not look at the rest of it.
  if (arguments.from || arguments.to) return summary->failed > 0 || summary->was_stopped ? exit_bad_verdict : exit_good;
  const Result<sweep::Collection> collection = sweep::look_at_sweep(arguments.folder);
  if (!collection) return print_errors(collection.errors());
  return print_state(arguments.folder, *collection);
}

int run_with_slurm(const SweepArguments& arguments) {
  if (arguments.jobs > 0 || arguments.from || arguments.to)
    return print_errors({{"--slurm", "decides what runs where", "leave --jobs, --from and --to out"}});
  sweep::SlurmRequest request = arguments.slurm;
  request.folder = arguments.folder;
  const Result<sweep::Submission> submission = sweep::submit_to_slurm(request);
  if (!submission) return print_errors(submission.errors());
  if (submission->job.empty()) return print("%s: nothing waits\n", arguments.folder.c_str()), exit_good;
  print("job %s: %zu sessions in %zu elements of up to %zu\n", submission->job.c_str(), submission->waiting,
        submission->elements, submission->tasks_per_element);
  print_remark("squeue -j " + submission->job + " shows the queue, ctpm sweep status what is done");
  return exit_good;
}

int run_waiting(const SweepArguments& arguments) {
  const sweep::SlurmRequest& slurm = arguments.slurm;
  if (arguments.with_slurm) return run_with_slurm(arguments);
  if (!slurm.partition.empty() || !slurm.time.empty() || !slurm.memory.empty() || !slurm.options.empty() ||
      slurm.tasks_per_element > 0)
    return print_errors({{"sweep run", "has options of Slurm without --slurm", ""}});
  return run_here(arguments);
}

int retry_failed(const SweepArguments& arguments) {
  const Result<sweep::Collection> collection = sweep::look_at_sweep(arguments.folder);
  if (!collection) return print_errors(collection.errors());
  Errors errors;
  std::size_t count = 0;
  for (std::size_t i = 0; i < collection->reports.size(); ++i) {
    if (collection->reports[i].state != sweep::TaskState::failed) continue;
    const Result<Done> forgotten = sweep::forget(arguments.folder, collection->plan.tasks[i].id);
    if (forgotten)
      ++count;
    else
      errors.push_back(forgotten.errors().front());
  }
  if (!errors.empty()) return print_errors(errors);
  print("%zu sessions that failed wait again\n", count);
  return exit_good;
}

int collect_results(const SweepArguments& arguments) {
  const Result<sweep::Collection> collection = sweep::look_at_sweep(arguments.folder);
  if (!collection) return print_errors(collection.errors());
  if (const Result<Done> written = sweep::write_results(*collection, arguments.folder, arguments.allow_incomplete);
      !written)
    return print_errors(written.errors());
  print("written: %s/report.html, results.csv, results.sqlite\n", arguments.folder.c_str());
  return print_state(arguments.folder, *collection);
}

void add_slurm(CLI::App& run, SweepArguments& arguments) {
  const auto add = [&](const char* name, auto& value, const char* what) {
    return run.add_option(name, value, what)->group("Slurm");
  };
  run.add_flag("--slurm", arguments.with_slurm, "Submits what waits as a job array of Slurm instead")->group("Slurm");
  add("--partition", arguments.slurm.partition, "Passed to sbatch");
  add("--time", arguments.slurm.time, "Of one element; passed to sbatch");
  add("--memory", arguments.slurm.memory, "Of one element; passed to sbatch as --mem");
  add("--tasks-per-element", arguments.slurm.tasks_per_element,
      "Sessions that one element records, one after the other; by default as few as Slurm's MaxArraySize allows")
      ->check(CLI::Range(1, 1000000));
  add("--slurm-option", arguments.slurm.options,
      "A further option of sbatch, as --slurm-option=--cpus-per-task=4; may be repeated")
      ->allow_extra_args(false);
}

}  // namespace

Command add_sweep(CLI::App& program) {
  auto arguments = std::make_shared<SweepArguments>();
  auto chosen = std::make_shared<std::function<int(const SweepArguments&)>>();
  CLI::App* app = program.add_subcommand("sweep", "Records many sessions that differ in what a file varies.");
  app->require_subcommand(1);
  app->footer(
      "Example: ctpm sweep plan stiffness.json -o out/stiffness\n"
      "         ctpm sweep run out/stiffness\n"
      "         ctpm sweep collect out/stiffness\n"
      "         ctpm sweep plan --each \"compare expert.ctpm\" -o out/class trainees/*.ctpm\n"
      "scenes/SWEEP.md says what a sweep file holds.");
  const auto add = [&](const char* name, const char* what, int (*run)(const SweepArguments&)) {
    CLI::App* step = app->add_subcommand(name, what);
    step->callback([chosen, run] { *chosen = run; });
    return step;
  };
  const auto add_folder = [&](CLI::App* step) {
    step->add_option("folder", arguments->folder, "Folder of the sweep")->required();
    return step;
  };
  CLI::App* plan = add("plan", "Checks every scene and script, and writes what is to be done.", plan_sweep);
  plan->add_option("files", arguments->files, "Sweep file (.json); with --each, sessions (.ctpm)")->required();
  plan->add_option("--each", arguments->each,
                   "Runs a command on each session instead: verify, info, export or compare with its arguments in "
                   "quotes; {} is the session, {out} its folder");
  plan->add_option("-o,--output", arguments->folder, "Folder of the sweep; made if missing")->required();
  CLI::App* run =
      add_folder(add("run", "Records what waits, on all cores; goes on where it was stopped.", run_waiting));
  run->add_option("--jobs", arguments->jobs, "Sessions at a time; by default as many as there are cores")
      ->check(CLI::Range(1, 256));
  run->add_option("--from", arguments->from, "Only from the session of this number in manifest.csv on")
      ->check(CLI::Range(1, 1000000));
  run->add_option("--to", arguments->to, "Only up to the session of this number")->check(CLI::Range(1, 1000000));
  add_slurm(*run, *arguments);
  add_folder(add("status", "Says what is done, failed, running, killed and waiting.", show_status));
  add_folder(add("retry", "Lets the sessions that failed wait again.", retry_failed));
  CLI::App* collect =
      add_folder(add("collect", "Writes a page with plots, a table (CSV) and a database (SQLite).", collect_results));
  collect->add_flag("--incomplete", arguments->allow_incomplete, "Also of a sweep of which something is missing");
  return {app, [arguments, chosen] { return (*chosen)(*arguments); }};
}

}  // namespace ctpm::commands
