#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>

#include "recordings/session.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::server {

/// A scene that a page looks at, and the start of a session of it, which is settled once: to measure its ticks, and so
/// before somebody tries it.
class KeptScene {
 public:
  explicit KeptScene(loading::LoadedScene scene) : scene_(std::move(scene)) {}
  /// Stops what settles, and waits for that.
  ~KeptScene() { ends_ = true; }
  KeptScene(const KeptScene&) = delete;
  KeptScene& operator=(const KeptScene&) = delete;

  const loading::LoadedScene& scene() const { return scene_; }

  /// See session::start_session(). Null: `should_stop` ended the wait; the scene goes on settling for whom asks next.
  /// `progress` gets the ticks in which it settled so far, and how many there can be at most.
  std::shared_ptr<const recordings::SessionStart> start(
      const std::function<bool()>& should_stop,
      const std::function<void(std::int64_t done, std::int64_t most)>& progress = {});

 private:
  void begin();

  const loading::LoadedScene scene_;
  std::atomic<bool> ends_ = false;
  std::atomic<std::int64_t> settled_ = 0, most_ = 0;  ///< ticks so far, and at most; 0: it has not begun
  std::once_flag begun_;
  std::shared_future<std::shared_ptr<const recordings::SessionStart>> start_;
};

}  // namespace ctpm::server
