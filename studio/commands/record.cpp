#include <cmath>
#include <memory>
#include <string>

#include "studio/commands/command.h"
#include "studio/console.h"
#include "studio/files.h"
#include "studio/loaded_scene.h"
#include "studio/session/record_script.h"
#include "studio/session/stop_signal.h"

namespace ctpm {
namespace {

struct RecordArguments {
  std::string scene, output, script;
  double duration_s = 0;
  bool overwrite = false, as_fast_as_possible = false;
  LoadOptions load;
};

int print_outcome(const std::string& path, const Model& model, const RecordOutcome& outcome) {
  const SessionStatistics& s = outcome.statistics;
  if (outcome.run.status == StepStatus::diverged || outcome.run.status == StepStatus::bad_input)
    print_remark(path + ": error: the simulation was refused at tick " + std::to_string(outcome.run.ticks) +
                 ", sphere " + std::to_string(outcome.run.worst_sphere) + "; what came before is saved");
  std::printf(
      "%s: %.3f s in %lld ticks, tick time p50 %.3f ms, p99 %.3f ms, %lld late, at most %.3f N and %.2f mm "
      "deep, %lld elements severed\n",
      path.c_str(), double(s.ticks) * model.tick, (long long)s.ticks, s.tick_time_p50 * 1e3,
      s.tick_time_p99 * 1e3, (long long)outcome.run.late_ticks, s.max_force, s.max_depth * 1e3,
      (long long)s.severed);
  return outcome.run.status == StepStatus::ok || outcome.run.status == StepStatus::not_converged
             ? exit_good
             : exit_bad_verdict;
}

int run_record(const RecordArguments& arguments) {
  if (arguments.duration_s < 0) return print_errors({{"--duration-s", "must be 0 or more", ""}});
  if (const Result<Done> writable = check_writable(arguments.output); !writable)
    return print_errors(writable.errors());
  const Result<LoadedScene> scene = load_whole_scene(arguments.scene, arguments.load);
  if (!scene) return print_errors(scene.errors());
  Script script;
  if (arguments.script.empty()) {
    print_remark("no --script is given: pressing and cutting at the top of the first organ");
    script = default_script(scene->scene.spec, scene->organs);
  } else {
    const Result<std::string> text = read_text_file(arguments.script);
    if (!text) return print_errors(text.errors());
    std::vector<std::string> tools;
    for (const ToolSpec& tool : scene->scene.spec.tools) tools.push_back(tool.name);
    Result<Script> read = read_script(*text, arguments.script, tools);
    if (!read) return print_errors(read.errors());
    script = std::move(*read);
  }
  const Model& model = scene->built.model;
  RunOptions options;
  options.in_real_time = !arguments.as_fast_as_possible;
  options.most_ticks = std::llround(arguments.duration_s / model.tick);
  ProgressLine progress("recording");
  options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  const StopSignal stop;
  options.should_stop = [&] { return stop.came(); };
  const Result<RecordOutcome> outcome =
      record_script(*scene, script, arguments.output, arguments.overwrite, options);
  if (!outcome) return print_errors(outcome.errors());
  return print_outcome(arguments.output, model, *outcome);
}

}  // namespace

Command add_record(CLI::App& program) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* app = program.add_subcommand("record", "Runs a session and records it, at 1000 ticks a second.");
  app->footer("Example: ctpm record scenes/liver.json --script scenes/scripts/liver-cut.json -o liver.ctpm");
  app->add_option("scene", arguments->scene, "Scene file (.json)")->required();
  app->add_option("-o,--output", arguments->output, "Session file (.ctpm)")->required();
  app->add_option("--script", arguments->script,
                  "What the hand does (.json); without it, a press and a cut at the organ's top");
  app->add_option("--duration-s", arguments->duration_s, "Ends the session after so many seconds");
  app->add_flag("--overwrite", arguments->overwrite, "Replace an existing session file");
  app->add_flag("--fast", arguments->as_fast_as_possible, "Do not wait for the clock between ticks");
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_record(*arguments); }};
}

}  // namespace ctpm
