#include "importers/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace ctpm::importers {
namespace {

constexpr std::int64_t kMebibyte = 1024 * 1024;
constexpr int kOutOfMemory = 71;  // exit codes of the child
constexpr int kThrew = 72;

// The shadow memory of sanitizers exceeds any limit.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif

/// Current address space of this process [bytes]. The child inherits it, so limits count from here.
std::int64_t address_space() {
  std::int64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

void set_limit(int resource, std::int64_t value) {
  rlimit old{};
  getrlimit(static_cast<__rlimit_resource_t>(resource), &old);
  const rlim_t wanted = old.rlim_max == RLIM_INFINITY ? rlim_t(value) : std::min<rlim_t>(rlim_t(value), old.rlim_max);
  const rlimit limit{wanted, wanted};
  setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

/// Isolates the child from everything except its pipe.
void shut_in(int pipe_end, const ChildLimits& limits, std::int64_t address_space_before) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGHUP, SIGALRM, SIGCHLD, SIGXCPU})
    signal(number, SIG_DFL);
  signal(SIGPIPE, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDWR);
  for (int fd = 0; fd < 3; ++fd) dup2(nothing, fd);
  // Close all other files of the parent, so that the child holds none of its locks or pipes.
  if (pipe_end > 3) syscall(SYS_close_range, 3u, unsigned(pipe_end - 1), 0u);
  syscall(SYS_close_range, unsigned(pipe_end + 1), ~0u, 0u);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_FSIZE, 0);
  set_limit(RLIMIT_CPU, std::int64_t(std::ceil(limits.time_s)) + 1);
  if (kLimitsMemory) set_limit(RLIMIT_AS, address_space_before + limits.memory_mib * kMebibyte);
}

[[noreturn]] void run_child(int pipe_end, const ChildLimits& limits, std::int64_t address_space_before,
                            const std::function<void(const Send&)>& work) {
  shut_in(pipe_end, limits, address_space_before);
  const Send send = [pipe_end](const void* bytes, std::size_t count) {
    const char* next = static_cast<const char*>(bytes);
    while (count > 0) {
      const ssize_t written = write(pipe_end, next, count);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      next += written, count -= std::size_t(written);
    }
    return true;
  };
  try {
    work(send);
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (...) {
    _exit(kThrew);
  }
  _exit(0);
}

std::string seconds_text(double seconds) {
  char text[48];
  std::snprintf(text, sizeof text, "%g s", seconds);
  return text;
}

/// Why a child failed; empty if it did not.
std::string trouble_of(int status, const ChildLimits& limits) {
  if (WIFEXITED(status)) {
    if (WEXITSTATUS(status) == 0) return "";
    if (WEXITSTATUS(status) == kOutOfMemory)
      return "needs more than " + std::to_string(limits.memory_mib) + " MiB of memory";
    return "gave up (exit code " + std::to_string(WEXITSTATUS(status)) + ")";
  }
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number == SIGXCPU) return "took longer than " + seconds_text(limits.time_s);
  return std::string("crashed (") + (number ? strsignal(number) : "unknown state") + ")";
}

/// Reads the pipe to its end. Returns the reason for stopping early, or an empty string.
std::string collect(int pipe_end, const ChildLimits& limits, std::string& output) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(limits.time_s);
  static constexpr std::size_t kChunk = 1 << 18;
  std::string chunk(kChunk, '\0');
  while (true) {
    const double left_ms = std::chrono::duration<double, std::milli>(end - Clock::now()).count();
    if (left_ms <= 0) return "took longer than " + seconds_text(limits.time_s);
    pollfd waiting{pipe_end, POLLIN, 0};
    const int ready = poll(&waiting, 1, int(std::min(left_ms, 60'000.0)) + 1);
    if (ready < 0 && errno != EINTR) return std::string("cannot be heard: ") + std::strerror(errno);
    if (ready <= 0) continue;
    const ssize_t count = read(pipe_end, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::string("cannot be heard: ") + std::strerror(errno);
    if (count == 0) return "";
    if (std::int64_t(output.size()) + count > limits.output_mib * kMebibyte)
      return "sent more than " + std::to_string(limits.output_mib) + " MiB";
    output.append(chunk.data(), std::size_t(count));
  }
}

}  // namespace

ChildResult run_in_child(const ChildLimits& limits, const std::function<void(const Send&)>& work) {
  ChildResult result;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    result.trouble = std::string("could not be started: ") + std::strerror(errno);
    return result;
  }
  const std::int64_t before = address_space();
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    run_child(ends[1], limits, before, work);
  }
  close(ends[1]);
  if (child < 0) {
    result.trouble = std::string("could not be started: ") + std::strerror(errno);
    close(ends[0]);
    return result;
  }
  try {
    result.trouble = collect(ends[0], limits, result.output);
  } catch (const std::bad_alloc&) {
    result.trouble = "sent more than the memory holds";
  }
  if (!result.trouble.empty()) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  pid_t waited;
  while ((waited = waitpid(child, &status, 0)) < 0 && errno == EINTR) {
  }
  // A program that ignores SIGCHLD never gets the status; the received bytes must then suffice.
  if (result.trouble.empty() && waited == child) result.trouble = trouble_of(status, limits);
  result.is_whole = result.trouble.empty();
  return result;
}

}  // namespace ctpm::importers
