#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/model/errors.h"
#include "scenes/scene_file.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/stop_signal.h"
#include "studio/output/files.h"

namespace ctpm::commands {
namespace {

struct WatchArguments {
  std::string scene, preview;
  std::vector<std::string> scripts;
  bool allow_outside_paths = false;
};

/// When a file was written last, and its size; the least time if it is not there.
using Stamp = std::pair<std::filesystem::file_time_type, std::uintmax_t>;

Stamp stamp_of(const std::string& file) {
  std::error_code missing;
  const auto time = std::filesystem::last_write_time(file, missing);
  if (missing) return {std::filesystem::file_time_type::min(), 0};
  return {time, std::filesystem::file_size(file, missing)};
}

/// The scene, its scripts, and the meshes that the scene names.
std::map<std::string, Stamp> stamps_of(const WatchArguments& arguments) {
  std::map<std::string, Stamp> stamps;
  std::vector<std::string> files = arguments.scripts;
  files.push_back(arguments.scene);
  scenes::LoadOptions load;
  load.allow_outside_paths = arguments.allow_outside_paths;
  if (const Result<scenes::SceneDraft> draft = scenes::load_draft(arguments.scene, load)) {
    for (const scenes::OrganSpec& organ : draft->scene.spec.organs)
      if (!organ.mesh.empty()) files.push_back(scenes::mesh_path(arguments.scene, organ.mesh));
    for (const scenes::ObstacleSpec& obstacle : draft->scene.spec.obstacles)
      if (!obstacle.mesh.empty()) files.push_back(scenes::mesh_path(arguments.scene, obstacle.mesh));
  }
  for (const std::string& file : files) stamps[file] = stamp_of(file);
  return stamps;
}

/// Runs another command of the program.
int run_command(Command (*add)(CLI::App&), std::vector<std::string> arguments) {
  CLI::App program;
  const Command command = add(program);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  program.parse(arguments);
  return command.run();
}

/// Checks; for a good scene, plans and draws.
void look_at_scene(const WatchArguments& arguments) {
  const std::vector<std::string> outside =
      arguments.allow_outside_paths ? std::vector<std::string>{"--allow-outside-paths"} : std::vector<std::string>{};
  const auto with = [&](std::vector<std::string> own) {
    own.insert(own.end(), outside.begin(), outside.end());
    return own;
  };
  std::vector<std::string> check{"check", arguments.scene};
  for (const std::string& script : arguments.scripts) check.insert(check.end(), {"--script", script});
  if (run_command(add_check, with(check)) != exit_good) return;
  run_command(add_plan, with({"plan", arguments.scene, "--quick"}));
  if (arguments.preview.empty()) return;
  std::vector<std::string> preview{"preview", arguments.scene, "-o", arguments.preview, "--marks", "--overwrite"};
  if (arguments.scripts.size() == 1) preview.insert(preview.end(), {"--script", arguments.scripts.front()});
  run_command(add_preview, with(preview));
}

int run_watch(const WatchArguments& arguments) {
  constexpr auto kEvery = std::chrono::milliseconds(200);
  Errors errors;
  std::vector<std::string> files = arguments.scripts;
  files.insert(files.begin(), arguments.scene);
  for (const std::string& file : files) append(errors, output::check_readable(file));
  if (!arguments.preview.empty()) append(errors, output::check_writable(arguments.preview));
  if (!errors.empty()) return print_errors(errors);
  const StopSignal stop;
  std::map<std::string, Stamp> seen;
  while (!stop.came()) {
    std::map<std::string, Stamp> now = stamps_of(arguments);
    if (now != seen) {
      // An editor may still be writing.
      std::this_thread::sleep_for(kEvery);
      if (std::map<std::string, Stamp> later = stamps_of(arguments); later != now) continue;
      seen = std::move(now);
      char time[16];
      const std::time_t clock = std::time(nullptr);
      std::strftime(time, sizeof time, "%H:%M:%S", std::localtime(&clock));
      print("--- %s\n", time);
      look_at_scene(arguments);
      std::fflush(stdout);  // whoever reads it through a pipe waits for this
      print_remark("watching " + arguments.scene + "; Ctrl-C ends it");
    }
    std::this_thread::sleep_for(kEvery);
  }
  return exit_good;
}

}  // namespace

Command add_watch(CLI::App& program) {
  auto arguments = std::make_shared<WatchArguments>();
  CLI::App* app = program.add_subcommand(
      "watch", "Checks, plans and draws a scene, and again whenever it, its meshes or its scripts are saved.");
  app->footer("Example: ctpm watch my/liver.json --script my/liver.script.json --preview my/liver.png");
  app->add_option("scene", arguments->scene, "Scene file (.json)")->required();
  app->add_option("--script", arguments->scripts, "Script of the scene (.json; repeatable)");
  app->add_option("--preview", arguments->preview, "Picture to write each time (.png), with marks");
  app->add_flag("--allow-outside-paths", arguments->allow_outside_paths, "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_watch(*arguments); }};
}

}  // namespace ctpm::commands
