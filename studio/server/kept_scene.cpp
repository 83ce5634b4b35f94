#include "studio/server/kept_scene.h"

#include <chrono>

#include "studio/session/record_session.h"

namespace ctpm::server {

/// Begins to settle it in a thread of its own, unless that has begun.
void KeptScene::begin() {
  std::call_once(begun_, [this] {
    start_ = std::async(std::launch::async, [this]() -> std::shared_ptr<const recordings::SessionStart> {
      auto start = session::start_session(scene_, [this] { return ends_.load(); });
      return start ? std::make_shared<const recordings::SessionStart>(*std::move(start)) : nullptr;
    });
  });
}

std::shared_ptr<const recordings::SessionStart> KeptScene::start(const std::function<bool()>& should_stop) {
  begin();
  constexpr auto kLook = std::chrono::milliseconds(10);
  while (start_.wait_for(kLook) == std::future_status::timeout)
    if (should_stop()) return nullptr;
  return start_.get();
}

}  // namespace ctpm::server
