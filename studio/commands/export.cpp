#include <csignal>
#include <memory>
#include <string>

#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "studio/commands/command.h"
#include "studio/console.h"
#include "studio/export_video.h"
#include "studio/render/picture_size.h"
#include "studio/session/stop_signal.h"
#include "studio/session/time_range.h"

namespace ctpm {
namespace {

struct ExportArguments {
  std::string file, output, size = "1280x720";
  TimeRange range;
  ExportOptions options;
};

int run_export(ExportArguments& arguments) {
  Result<SessionReader> reader = SessionReader::open(arguments.file);
  if (!reader) return print_errors(reader.errors());
  const Result<PictureSize> size = parse_picture_size(arguments.size);
  if (!size) return print_errors(size.errors());
  arguments.options.size = *size;
  const Result<TickRange> range =
      arguments.range.in_ticks(arguments.file, reader->start().model.tick, reader->tick_count());
  if (!range) return print_errors(range.errors());
  arguments.options.range = *range;
  ProgressLine progress("exporting");
  arguments.options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  const StopSignal stop;  // Ctrl-C ends the loop, and the unfinished file is removed on the way out
  arguments.options.should_stop = [&] { return stop.came(); };
  const Result<ExportOutcome> outcome = export_video(*reader, arguments.output, arguments.options);
  if (!outcome) return print_errors(outcome.errors());
  if (!outcome->video.note.empty()) print_remark("warning: " + outcome->video.note);
  std::printf(
      "%s: %lld frames, %dx%d, %g frames/s, %s, %.1f MB; replay %s\n", outcome->video.path.c_str(),
      (long long)outcome->video.frames, outcome->video.width, outcome->video.height, outcome->video.fps,
      outcome->video.codec.c_str(), double(outcome->video.bytes) / 1e6,
      outcome->same_as_recorded ? "same as recorded" : "DIFFERS from what was recorded; every frame says so");
  return outcome->same_as_recorded ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_export(CLI::App& program) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* app = program.add_subcommand("export", "Replays a session off-screen into a video.");
  app->footer("Example: ctpm export out/demo.ctpm -o out/demo.mp4 --from-s 4 --speed 0.5");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  app->add_option("-o,--output", arguments->output, "Video file (.mp4)")->required();
  app->add_option("--size", arguments->size, "Width x height in pixels")->capture_default_str();
  app->add_option("--fps", arguments->options.fps, "Frames per second")->capture_default_str();
  app->add_option("--camera", arguments->options.camera,
                  "Name of a camera of the scene; its first one, else a fitted one");
  app->add_option("--speed", arguments->options.speed, "Times real speed")->capture_default_str();
  app->add_flag("--allow-diverged", arguments->options.allow_diverged,
                "Export although the replay differs, and say so on every frame");
  add_time_range(*app, arguments->range);
  return {app, [arguments] { return run_export(*arguments); }};
}

}  // namespace ctpm
