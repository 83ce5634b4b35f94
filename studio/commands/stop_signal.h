#pragma once

#include <csignal>

namespace ctpm::commands {

/// During its lifetime Ctrl-C and SIGTERM set a flag instead of killing the program.
class StopSignal {
 public:
  StopSignal() {
    came_flag() = 0;
    struct sigaction action = {};
    action.sa_handler = [](int) { came_flag() = 1; };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &before_[0]);
    sigaction(SIGTERM, &action, &before_[1]);
  }
  ~StopSignal() {
    sigaction(SIGINT, &before_[0], nullptr);
    sigaction(SIGTERM, &before_[1], nullptr);
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool came() const { return came_flag() != 0; }

 private:
  static volatile std::sig_atomic_t& came_flag() {
    static volatile std::sig_atomic_t flag = 0;
    return flag;
  }
  struct sigaction before_[2];
};

}  // namespace ctpm::commands
