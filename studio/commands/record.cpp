#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/errors.h"
#include "importers/text.h"
#include "recordings/session_reader.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/extremes_text.h"
#include "studio/commands/record_source.h"
#include "studio/commands/script_checks.h"
#include "studio/commands/stop_signal.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/session/recent_times.h"
#include "studio/session/record_session.h"
#include "studio/session/tick_times.h"

namespace ctpm::commands {
namespace {

constexpr double kMostSeconds = 1e6;  // of a session

struct RecordArguments {
  std::string scene, parent, output;
  std::optional<double> at_s;
  SourceRequest source;
  std::vector<std::string> device_flags;  ///< that were given
  std::optional<double> duration_s;
  bool overwrite = false, as_fast_as_possible = false;
  scenes::LoadOptions load;
  int threads = 0;  ///< 0: threads_for()
};

/// Errors in the combination of flags, before any file is read.
Errors check(const RecordArguments& arguments) {
  Errors errors;
  if (arguments.duration_s && !(*arguments.duration_s > 0 && *arguments.duration_s <= kMostSeconds))
    errors.push_back({"--duration-s", "must be above 0 and at most " + std::to_string(int(kMostSeconds)), ""});
  if (arguments.scene.empty() == arguments.parent.empty())
    errors.push_back({"record", "needs either a scene or --continue with a session", ""});
  if (arguments.at_s && arguments.parent.empty())
    errors.push_back({"--at", "is a moment of the session that --continue names", ""});
  if (!arguments.parent.empty() && !arguments.at_s)
    errors.push_back({"--continue", "needs --at, the moment from which to go on [s]", ""});
  const std::string sources = source_flags;
  if (count_of(arguments.source) > 1) errors.push_back({"record", "takes one of " + sources, ""});
  if (!arguments.parent.empty() && count_of(arguments.source) == 0)
    errors.push_back({"--continue", "needs a source: one of " + sources, ""});
  if (arguments.as_fast_as_possible && devices::asks_for_device(arguments.source.device))
    errors.push_back({"--fast", "a device is followed in real time", ""});
  append(errors, devices::check_device(arguments.source.device));
  for (Error& error : devices::check_device(second_of(arguments.source)))
    if (std::find(errors.begin(), errors.end(), error) == errors.end()) errors.push_back(std::move(error));
  if (devices::asks_for_device(arguments.source.second) && !devices::asks_for_device(arguments.source.device))
    errors.push_back({"record", "a device for the second hand needs one for the first", "--igtl or --igtl-listen"});
  if (!devices::asks_for_device(arguments.source.device) && !devices::asks_for_device(arguments.source.second))
    for (const std::string& flag : arguments.device_flags)
      errors.push_back({flag, "is of a device, and none is asked for", "give --igtl or --igtl-listen"});
  std::error_code ignored;
  if (!arguments.output.ends_with(".ctpm"))
    errors.push_back({"--output", "got " + arguments.output + ", and a session's name ends in .ctpm", ""});
  if (const Result<Done> writable = output::check_writable(arguments.output); !writable)
    append(errors, writable);
  else if (!arguments.overwrite && std::filesystem::exists(arguments.output, ignored))
    errors.push_back({arguments.output, "exists already", "--overwrite replaces it"});
  return errors;
}

/// A session's start, and the default source: a press and a cut at the organ's top.
struct Beginning {
  recordings::SessionStart start;
  std::optional<scenes::Script> script;
};

/// The errors of the flags and of the given files but for the scene's: those of its text come with those of its meshes,
/// unless there are others. Reads the script.
Errors errors_beside_scene(RecordArguments& arguments, const Result<scenes::SceneDraft>& scene) {
  Errors errors = check(arguments);
  SourceRequest& source = arguments.source;
  if (!source.script.empty()) {
    const Result<std::string> text = output::read_text_file(source.script);
    source.script_text = text ? *text : "";
    append(errors,
           text ? scenes::check_script(*text, source.script, scene ? *scene : scenes::unknown_scene(arguments.scene))
                : text.errors());
  }
  if (!source.motion.empty()) append(errors, output::check_readable(source.motion));
  if (devices::asks_for_device(source.second) && scene && scene->problems.is_empty())
    append(errors, devices::check_second_hand(scene->scene.spec.hands.value_or(1)));
  if (!arguments.parent.empty()) append(errors, recordings::SessionReader::open(arguments.parent));
  return errors;
}

/// Opens the devices first, so that a port in use is reported at once and a device can connect early. Errors: all that
/// can be said before the scene is filled.
Result<OpenedDevices> check_and_open(RecordArguments& arguments) {
  const Result<scenes::SceneDraft> scene = scenes::load_draft(arguments.scene, arguments.load);
  Errors errors = errors_beside_scene(arguments, scene);
  Result<OpenedDevices> devices = errors.empty() ? open_devices(arguments.source) : OpenedDevices{};
  append(errors, devices);
  if (errors.empty()) return devices;
  Errors all;
  if (!arguments.scene.empty()) all = scene ? scene->problems.errors() : scene.errors();
  append(all, std::move(errors));
  return all;
}

Result<Beginning> begin(const RecordArguments& arguments) {
  Beginning beginning;
  if (!arguments.parent.empty()) {
    Result<recordings::SessionStart> start = session::continue_session_at(arguments.parent, *arguments.at_s);
    if (!start) return start.errors();
    beginning.start = std::move(*start);
    return beginning;
  }
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(arguments.scene, arguments.load);
  if (!scene) return scene.errors();
  print_warnings(scene->scene.warnings);
  beginning.start = session::start_session(*scene);
  if (count_of(arguments.source) == 0) beginning.script = scenes::default_script(scene->scene.spec, scene->organs);
  return beginning;
}

int print_outcome(const std::string& path, const Model& model, const session::RecordOutcome& outcome,
                  const session::TickTimes& times, bool in_real_time) {
  const recordings::SessionStatistics& s = outcome.statistics;
  const bool was_refused = stepping::is_refused(outcome.run.status);
  if (was_refused)
    print_remark(path + ": error: the simulation was refused at tick " + std::to_string(outcome.run.ticks) +
                 ", sphere " + std::to_string(outcome.run.worst_sphere) + "; what came before is saved");
  if (!outcome.run.fault.empty()) print_remark(path + ": error: " + outcome.run.fault + "; what came before is saved");
  print("%s: %.3f s in %lld ticks, %s, %s severed\n", path.c_str(), double(s.ticks) * model.tick, (long long)s.ticks,
        extremes_text(s.max_force, s.max_depth).c_str(), importers::counted(s.severed, "element").c_str());
  const std::string late = std::to_string(outcome.run.late_ticks) + " late";
  print("tick time p50 %.3f ms, p99 %.3f ms, p99.9 %.3f ms, max %.3f ms, %s\n", s.tick_time_p50 * 1e3,
        s.tick_time_p99 * 1e3, s.tick_time_p999 * 1e3, s.tick_time_max * 1e3,
        in_real_time ? late.c_str() : "not in real time");
  if (outcome.run.late_ticks > 0)
    print("late because of: %s (%s)\n", outcome.run.late_by.text().c_str(), session::kLateCausesSay);
  if (outcome.run.fallbacks > 0)
    print("%lld ticks were too long for sdirk2: backward Euler took them\n", (long long)outcome.run.fallbacks);
  for (const session::Deed deed : {session::Deed::contact, session::Deed::cut})
    if (const session::DeedTimes of = times.of(deed); of.ticks > 0)
      print("  %s p50 %.3f ms, p99 %.3f ms, %lld ticks\n", session::name_of(deed), of.p50 * 1e3, of.p99 * 1e3,
            (long long)of.ticks);
  if (s.slip_max > 0)
    print("clock %.3f s behind real time at the end, %.3f s at most%s\n", s.slip, s.slip_max,
          s.slip > 0.1 ? ": THE SESSION IS SHORTER THAN THE TIME IT TOOK" : "");
  if (s.input_age_max > 0)
    print("input age p50 %.3f ms, p99 %.3f ms, max %.3f ms\n", s.input_age_p50 * 1e3, s.input_age_p99 * 1e3,
          s.input_age_max * 1e3);
  return was_refused || !outcome.run.fault.empty() ? exit_bad_verdict : exit_good;
}

/// False if `should_stop` returned true before a pose came.
bool wait_for(const FollowedPlace& one, const std::function<bool()>& should_stop) {
  return one.device->wait_for_first_pose(should_stop,
                                         [&](const std::string& text) { print_remark(one.place + ": " + text); });
}

int run_record(RecordArguments arguments) {
  const StopSignal stop;
  const auto should_stop = [&] { return stop.came(); };
  Result<OpenedDevices> devices = check_and_open(arguments);
  if (!devices) return print_errors(devices.errors());
  Result<Beginning> beginning = begin(arguments);
  if (!beginning) return print_errors(beginning.errors());
  recordings::SessionStart& start = beginning->start;
  const Result<scenes::SceneText> scene = scenes::read_scene(start.scene_text, "the session's scene");
  const Result<ReadySource> opened = open_source(arguments.source, std::move(*devices), start.model,
                                                 scene ? scene->spec : scenes::SceneSpec{}, beginning->script);
  if (!opened) return print_errors(opened.errors());
  for (const auto& [key, value] : opened->metadata) start.metadata[key] = value;
  for (const FollowedPlace& one : opened->devices) print_remark(one.place + "; Ctrl-C ends it");
  for (const FollowedPlace& one : opened->devices)
    if (!wait_for(one, should_stop))
      return print_errors({{one.place, "stopped before a pose came; nothing was recorded", ""}});
  // What came for the first hand while the second one was awaited is old by now.
  if (opened->devices.size() > 1 && !wait_for(opened->devices.front(), should_stop)) return exit_bad_verdict;

  session::RunOptions options;
  options.in_real_time = !arguments.as_fast_as_possible;
  if (arguments.duration_s)
    options.most_ticks = std::max<std::int64_t>(1, std::llround(*arguments.duration_s / start.model.tick));
  options.should_stop = should_stop;
  options.threads = arguments.threads > 0 ? arguments.threads : session::threads_for(start.model);
  session::TickTimes all_times(start.model);
  bool took_tool = false, took_blade = false;
  std::optional<double> first_depth;  // of a tool in the first tick [m]
  const Result<session::RecordOutcome> outcome = [&] {
    ProgressLine progress("recording");
    options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
    session::RecentTimes times;
    options.watch = [&](const State&, const recordings::TickRecord& record, const session::RunOutcome& so_far) {
      all_times.add(record);
      if (!first_depth) first_depth = std::max(record.of_hand(0).depth, record.of_hand(1).depth);
      for (std::size_t hand = 0; hand < kMostHands; ++hand) {
        const std::int32_t tool = record.inputs.hand(hand).tool;
        took_tool = took_tool || tool >= 0, took_blade = took_blade || start.model.is_scalpel(tool);
      }
      if (times.add(record.tick_time))
        progress.add("tick p99 " + output::fixed(1e3 * times.p99(), 2) + " ms, clock " + output::fixed(so_far.slip, 3) +
                     " s behind");
    };
    options.note = [&](const std::string& text) { print_remark(arguments.output + ": warning: " + text); };
    options.tell = [&](const std::string& problem) {
      print_remark(arguments.output + ": error: recording fails now: " + problem);
    };
    return session::record_session(start, *opened->source, arguments.output, arguments.overwrite, options);
  }();
  if (!outcome) return print_errors(outcome.errors());
  constexpr double kDeepAtOnce = 1e-3;  // [m]
  if (arguments.parent.empty() && first_depth.value_or(0) > kDeepAtOnce)
    print_warnings(
        {{arguments.output,
          "a tool is " + output::short_number(1e3 * *first_depth, 3) + " mm deep in tissue in the first tick",
          "begin with the tool outside: the first forces are of no hand"}});
  // A session that was ended before its script says nothing about the rest of it.
  const std::string& motion = arguments.source.motion;
  const std::string& planned = motion.empty() ? arguments.source.script : motion;
  if (!planned.empty() && took_tool && options.most_ticks == 0 && !stop.came())
    print_warnings(find_misses(outcome->statistics, took_blade, planned));
  return print_outcome(arguments.output, start.model, *outcome, all_times, options.in_real_time);
}

}  // namespace

Command add_record(CLI::App& program) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* app = program.add_subcommand("record", "Runs a session and records it, at 1000 ticks a second.");
  app->footer(
      "Example: ctpm record scenes/liver.json --script scenes/scripts/liver-cut.json -o liver.ctpm\n"
      "         ctpm record --continue liver.ctpm --at 2.5 --motion hand.csv -o other.ctpm\n"
      "         ctpm record scenes/liver.json --igtl-listen 18944 --device-offset-mm 0 0 90 -o mine.ctpm");
  app->add_option("scene", arguments->scene, "Scene file (.json)");
  app->add_option("--continue", arguments->parent, "Goes on from a moment of this session (.ctpm) instead");
  app->add_option("--at", arguments->at_s, "That moment [s]");
  app->add_option("-o,--output", arguments->output, "Session file (.ctpm)")->required();
  add_source(*app, arguments->source);
  app->add_option("--duration-s", arguments->duration_s, "Ends the session after so many seconds");
  app->add_flag("--overwrite", arguments->overwrite, "Replace an existing session file");
  app->add_flag("--fast", arguments->as_fast_as_possible, "Do not wait for the clock between ticks");
  app->add_option("--threads", arguments->threads,
                  "Threads that share a tick, which change no bit of it; by default two for large scenes")
      ->check(CLI::Range(1, 64));
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments, app] {
            arguments->device_flags = given_device_flags(*app);
            return run_record(*arguments);
          }};
}

}  // namespace ctpm::commands
