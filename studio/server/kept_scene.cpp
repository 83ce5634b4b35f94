#include "studio/server/kept_scene.h"

#include <chrono>

#include "studio/session/record_session.h"

namespace ctpm::server {

/// Begins to settle it in a thread of its own, unless that has begun.
void KeptScene::begin() {
  std::call_once(begun_, [this] {
    start_ = std::async(std::launch::async, [this]() -> std::shared_ptr<const recordings::SessionStart> {
      const auto told = [this](std::int64_t done, std::int64_t most) { settled_ = done, most_ = most; };
      auto start = session::start_session(
          scene_, [this] { return ends_.load(); }, told);
      return start ? std::make_shared<const recordings::SessionStart>(*std::move(start)) : nullptr;
    });
  });
}

std::shared_ptr<const recordings::SessionStart> KeptScene::start(
    const std::function<bool()>& should_stop,
    const std::function<void(std::int64_t done, std::int64_t most)>& progress) {
  begin();
  constexpr auto kLook = std::chrono::milliseconds(10);
  while (start_.wait_for(kLook) == std::future_status::timeout) {
    if (should_stop()) return nullptr;
    if (progress && most_ > 0) progress(settled_, most_);
  }
  return start_.get();
}

}  // namespace ctpm::server
