#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/stop_signal.h"
#include "studio/server/server.h"

namespace ctpm::commands {
namespace {

struct StudioArguments {
  server::ServerOptions options;
  bool no_open = false;
};

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return true;
  return false;
}

/// Opens the address in the user's browser. The child's child belongs to nobody, so that nobody waits for it.
void open_in_browser(const std::string& address) {
  const pid_t child = fork();
  if (child != 0) return;
  if (fork() == 0) {
    std::freopen("/dev/null", "w", stdout), std::freopen("/dev/null", "w", stderr);
    execlp("xdg-open", "xdg-open", address.c_str(), nullptr);
  }
  _exit(0);
}

int run_studio(const StudioArguments& arguments) {
  const Result<std::unique_ptr<server::Server>> server = server::Server::open(arguments.options);
  if (!server) return print_errors(server.errors());
  const std::string address = (*server)->address();
  print("%s\n", address.c_str());
  std::fflush(stdout);
  if (arguments.options.behind.empty())
    print_remark(
        "the studio is at this address, for this machine alone; whoever has the address can use it; Ctrl-C ends it");
  else
    print_remark("the studio is at this address once a proxy there ends TLS and passes everything on to http://" +
                 (*server)->listens_on() +
                 ", with the header Host as it came; whoever has the address can use it, and what goes between the two "
                 "is not encrypted; Ctrl-C ends it");
  if (!arguments.no_open && arguments.options.behind.empty() && has_display()) open_in_browser(address);
  const StopSignal stop;
  (*server)->run([&] { return stop.came(); });
  return exit_good;
}

}  // namespace

Command add_studio(CLI::App& program) {
  auto arguments = std::make_shared<StudioArguments>();
  CLI::App* app = program.add_subcommand("studio", "Opens the studio in the browser: author, train, review.");
  app->footer(
      "Examples: ctpm studio my\n"
      "          ctpm studio my --behind https://studio.example   # for other machines; studio/server/README.md");
  app->add_option("folder", arguments->options.folder, "Folder with scenes and sessions; nothing outside of it is used")
      ->capture_default_str();
  app->add_option("--port", arguments->options.port, "Port to listen on; 7375 if that is free; 0: any that is free")
      ->check(CLI::Range(0, 65535));
  app->add_option("--behind", arguments->options.behind,
                  "Serves other machines too, behind a reverse proxy that ends TLS: https://NAME of that proxy");
  app->add_option("--bind", arguments->options.bind,
                  "Address to listen on, where the proxy is another machine; needs --behind")
      ->capture_default_str();
  app->add_flag("--no-open", arguments->no_open, "Print the address and open no browser");
  return {app, [arguments] { return run_studio(*arguments); }};
}

}  // namespace ctpm::commands
