#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/model/result.h"

namespace ctpm::sweep {

/// What a session gave.
struct TaskResult {
  bool is_good = false;
  std::string error;       ///< why it failed; empty if it did not
  std::string ticks_hash;  ///< of the State hashes of all its ticks: equal where the session is equal to the bit
  std::vector<std::pair<std::string, double>> values;  ///< unit in the name
  double processor_s = 0;                              ///< processor time of this process [s]
};

enum class TaskState { waiting, running, killed, failed, done };
/// "waiting", "running", ...
const char* to_word(TaskState state);

/// The folder of a task within a sweep's: a session and its result.
std::string task_folder(const std::string& sweep_folder, const std::string& id);

/// A task that this process works on. Its folder has another name until finish(), and a lock that ends with the
/// process, however it ends; what a killed process left there is removed.
class Claim {
 public:
  /// None if the task is finished or another process works on it. Error: the folder cannot be written.
  static Result<std::optional<Claim>> take(const std::string& sweep_folder, const std::string& id);

  Claim(Claim&& other) noexcept;
  Claim& operator=(Claim&&) = delete;
  /// Without finish(): removes what there is, so that the task waits again.
  ~Claim();

  /// Where the session belongs.
  std::string session_path() const { return unfinished_ + "/session.ctpm"; }
  const std::string& folder() const { return unfinished_; }
  /// The locked file, for a process that works there too.
  int lock() const { return lock_; }

  /// Writes the result and gives the folder its name, by one rename. Error: it cannot be written.
  Result<Done> finish(const TaskResult& result);

 private:
  Claim(std::string unfinished, std::string finished, int lock)
      : unfinished_(std::move(unfinished)), finished_(std::move(finished)), lock_(lock) {}

  std::string unfinished_, finished_;
  int lock_ = -1;
};

/// State of a task, and its result if it has one.
struct TaskReport {
  TaskState state = TaskState::waiting;
  TaskResult result;
};
TaskReport look_at(const std::string& sweep_folder, const std::string& id);

/// Whether a task has a result, without reading it.
bool is_finished(const std::string& sweep_folder, const std::string& id);

/// Removes the result of a task. Error: it cannot be removed.
Result<Done> forget(const std::string& sweep_folder, const std::string& id);

}  // namespace ctpm::sweep
