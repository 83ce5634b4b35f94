#include "studio/sweep/process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace ctpm::sweep {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A file without a name.
File temporary_file() {
  File file(std::tmpfile(), std::fclose);
  if (file) ::fcntl(fileno(file.get()), F_SETFD, FD_CLOEXEC);
  return file;
}

std::string content_of(std::FILE* file) {
  std::string text;
  std::rewind(file);
  char bytes[4096];
  for (std::size_t count = 0; (count = std::fread(bytes, 1, sizeof bytes, file)) > 0;) text.append(bytes, count);
  return text;
}

}  // namespace

Result<ProcessOutput> run_process(const std::vector<std::string>& command, int kept) {
  const File out = temporary_file(), err = temporary_file();
  if (!out || !err) return Error{command.front(), std::string("no temporary file: ") + std::strerror(errno), ""};
  std::vector<std::string> copies = command;
  std::vector<char*> arguments;
  for (std::string& argument : copies) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(err.get()), STDERR_FILENO);
  // To itself: the copy stays open in the child.
  if (kept >= 0) posix_spawn_file_actions_adddup2(&actions, kept, kept);
  pid_t child = -1;
  const int failure = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return Error{command.front(), std::string("cannot be started: ") + std::strerror(failure), ""};
  int status = 0;
  struct rusage used {};
  while (::wait4(child, &status, 0, &used) < 0 && errno == EINTR) {
  }
  const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
  return ProcessOutput{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content_of(out.get()),
                       content_of(err.get()), seconds(used.ru_utime) + seconds(used.ru_stime)};
}

std::string option_word(const std::string& name, const std::string& value) {
  return "--" + name + (value.empty() ? "" : "=" + value);
}

std::string own_program() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).string();
}

}  // namespace ctpm::sweep
