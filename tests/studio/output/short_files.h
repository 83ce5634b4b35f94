#pragma once

#include <sys/resource.h>

#include <csignal>

namespace ctpm::testing {

/// Files that this process writes may not be longer meanwhile [bytes]; a write beyond it is an error.
class ShortFiles {
 public:
  explicit ShortFiles(rlim_t most) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = most;
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~ShortFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  ShortFiles(const ShortFiles&) = delete;
  ShortFiles& operator=(const ShortFiles&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace ctpm::testing
