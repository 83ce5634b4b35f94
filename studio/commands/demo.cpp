#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "recordings/session_reader.h"
#include "studio/authoring/import_scene.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/stop_signal.h"
#include "studio/film/export_video.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/session/record_session.h"

namespace ctpm::commands {
namespace {

namespace fs = std::filesystem;

struct DemoArguments {
  std::string folder = "out";
  bool overwrite = false;
};

/// Whether the folder's files may be replaced: an earlier demo made them, which left its mark, or the user says so.
/// Leaves the mark in a folder that has none of these files.
bool may_replace(const fs::path& folder, const std::vector<std::string>& files, bool overwrite) {
  const fs::path mark = folder / ".ctpm-demo", earlier = folder / "demo.mp4.json";
  std::error_code ignored;
  const auto exists = [&](const fs::path& file) { return fs::exists(file, ignored); };
  const bool is_ours = overwrite || exists(mark) || exists(earlier);
  if (!is_ours && std::any_of(files.begin(), files.end(), exists)) return false;
  std::ofstream{mark};
  return true;
}

/// Runs this program with other arguments in a separate process and returns its exit code.
int run_in_new_process(const std::vector<std::string>& arguments) {
  const pid_t child = fork();
  if (child < 0) return exit_bad_input;
  if (child == 0) {
    std::string self = fs::read_symlink("/proc/self/exe").string();
    std::vector<char*> argv{self.data()};
    std::vector<std::string> copies = arguments;
    for (std::string& argument : copies) argv.push_back(argument.data());
    argv.push_back(nullptr);
    execv(self.c_str(), argv.data());
    _exit(exit_bad_input);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : exit_bad_input;
}

void say_step(int number, const std::string& what) { print_remark("[" + std::to_string(number) + "/5] " + what); }

int run_demo(const DemoArguments& arguments) {
  const fs::path folder = arguments.folder;
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return print_errors({{arguments.folder, "cannot be made: " + failure.message(), ""}});
  const std::string scene_file = (folder / "liver.json").string(), session_file = (folder / "demo.ctpm").string(),
                    video_file = (folder / "demo.mp4").string();
  if (!may_replace(folder, {scene_file, session_file, video_file}, arguments.overwrite))
    return print_errors({{arguments.folder, "holds files of these names that no demo made",
                          "choose another folder with -o; --overwrite replaces them"}});
  const auto start = std::chrono::steady_clock::now();

  say_step(1, "importing the shipped liver mesh and filling it with spheres");
  authoring::ImportRequest request;
  request.mesh = std::string(CTPM_SOURCE_DIR) + "/scenes/organs/liver.obj";
  request.scene = scene_file;
  request.unit_in_metres = 1e-3;
  request.overwrite = true;
  const Result<authoring::ImportOutcome> imported = authoring::import_scene(request);
  if (!imported) return print_errors(imported.errors());

  say_step(2, "recording a session at 1000 ticks a second: a ball presses and lets go, then a scalpel cuts");
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(scene_file);
  if (!scene) return print_errors(scene.errors());
  print_warnings(scene->scene.warnings);
  const StopSignal stop;
  session::RunOptions options;
  options.should_stop = [&] { return stop.came(); };
  Result<session::RecordOutcome> recorded = [&] {
    ProgressLine progress("recording");
    options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
    return session::record_script(*scene, scenes::default_script(scene->scene.spec, scene->organs), session_file, true,
                                  options);
  }();
  if (!recorded) return print_errors(recorded.errors());
  if (stop.came()) return print_errors({{session_file, "stopped", ""}});

  say_step(3, "replaying it in a new process and comparing every state hash");
  const int verified = run_in_new_process({"verify", session_file});
  if (verified == exit_bad_input) return verified;

  say_step(4, "exporting the video");
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(session_file);
  if (!reader) return print_errors(reader.errors());
  film::ExportOptions exporting;
  exporting.should_stop = options.should_stop;
  exporting.overwrite = true;
  const Result<film::ExportOutcome> exported = [&] {
    ProgressLine progress("exporting");
    exporting.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
    return film::export_video({&*reader}, video_file, exporting);
  }();
  if (!exported) return print_errors(exported.errors());

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  say_step(5, "done in " + output::fixed(seconds, 1) + " s");
  const Model& model = scene->built.model;
  const recordings::SessionStatistics& s = recorded->statistics;
  print("spheres         %zu in %d layers\n", model.sphere_count(), model.organs.front().layer_count);
  print("elements        %zu, of which %lld severed\n", model.element_count(), (long long)s.severed);
  print("tick time       p50 %.3f ms, p99 %.3f ms; %lld of %lld ticks late\n", s.tick_time_p50 * 1e3,
        s.tick_time_p99 * 1e3, (long long)recorded->run.late_ticks, (long long)s.ticks);
  if (recorded->run.late_ticks > 0)
    print("                late because of: %s (%s)\n", recorded->run.late_by.text().c_str(), session::kLateCausesSay);
  print("ticks compared  %lld\n", (long long)s.ticks);
  print("verdict         %s\n",
        verified == exit_good ? "same as recorded, to the bit" : "DIFFERENT from what was recorded");
  print("video           %lld frames, %s, %dx%d\n", (long long)exported->video.frames, exported->video.codec.c_str(),
        exported->video.width, exported->video.height);
  print("files           %s, %s, %s, %s, %s\n", scene_file.c_str(), imported->organs.front().mesh_file.c_str(),
        imported->script_file.c_str(), session_file.c_str(), exported->video.path.c_str());
  return verified == exit_good && exported->same_as_recorded() ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_demo(CLI::App& program) {
  auto arguments = std::make_shared<DemoArguments>();
  CLI::App* app =
      program.add_subcommand("demo", "The main job, start to end: mesh, scene, session, verified replay, video.");
  app->footer("Example: ctpm demo");
  app->add_option("-o,--output", arguments->folder, "Folder for what it makes")->capture_default_str();
  app->add_flag("--overwrite", arguments->overwrite, "Replace files of the same names that no demo made");
  return {app, [arguments] { return run_demo(*arguments); }};
}

}  // namespace ctpm::commands
