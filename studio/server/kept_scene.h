#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>

#include "recordings/session.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::server {

/// A scene that a page looks at, and the start of a session of it, which may be settled before it is asked for.
class KeptScene {
 public:
  explicit KeptScene(loading::LoadedScene scene) : scene_(std::move(scene)) {}
  /// Stops what settles, and waits for that.
  ~KeptScene() { ends_ = true; }
  KeptScene(const KeptScene&) = delete;
  KeptScene& operator=(const KeptScene&) = delete;

  const loading::LoadedScene& scene() const { return scene_; }

  /// Begins to settle it in a thread of its own, unless it has begun.
  void settle_ahead();
  /// See session::start_session(). Waits for what settles. Null: `should_stop` ended the wait.
  std::shared_ptr<const recordings::SessionStart> start(const std::function<bool()>& should_stop);

 private:
  const loading::LoadedScene scene_;
  std::atomic<bool> ends_ = false;
  std::once_flag begun_;
  std::shared_future<std::shared_ptr<const recordings::SessionStart>> start_;
};

}  // namespace ctpm::server
