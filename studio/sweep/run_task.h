#pragma once

#include <functional>
#include <optional>
#include <string>

#include "recordings/session.h"
#include "studio/loading/loaded_scene.h"
#include "studio/sweep/plan.h"
#include "studio/sweep/task_folder.h"

namespace ctpm::sweep {

/// Records the sessions of a sweep, one after the other. Sessions of one scene share its filling and settling.
class Recorder {
 public:
  /// `sweep` must outlive this.
  explicit Recorder(Sweep& sweep) : sweep_(sweep) {}

  /// Records a session into the claimed folder. What is wrong with it is in the result; a session that ends early
  /// because a tick is refused has failed, and its file holds what came before. None if `should_stop` ended it.
  /// Error: the session's files are not what they were when the sweep was planned.
  Result<std::optional<TaskResult>> record(std::size_t task, const std::string& id, const Claim& claim,
                                           const std::function<bool()>& should_stop);

 private:
  struct Started {
    std::string path, text;
    loading::LoadedScene scene;
    recordings::SessionStart start;
  };
  Errors start(const TaskFiles& files);
  std::optional<TaskResult> run(const TaskFiles& files, std::size_t task, const std::string& id, const Claim& claim,
                                const std::function<bool()>& should_stop);

  Sweep& sweep_;
  std::optional<Started> started_;  ///< of the last scene
};

}  // namespace ctpm::sweep
