#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/server/moments.h"
#include "studio/server/outbox.h"
#include "studio/server/picture.h"
#include "studio/server/seeker.h"

namespace ctpm::server {

/// A session on the page: shows any of its moments on request, in a thread of its own. What has to be simulated first
/// is shown by a glimpse at once.
class Stage {
 public:
  /// Opens `file` as stage `number` of the page behind `outbox` and sends the shapes of its tools. Errors: the session
  /// cannot be read.
  static Result<std::unique_ptr<Stage>> open(const std::string& file, std::uint32_t number,
                                             std::shared_ptr<Outbox> outbox);
  ~Stage();

  /// Asks for the State before `tick`, which is moved into the session; a newer request replaces one that waits.
  void show(std::int64_t tick, std::uint32_t request);

  /// Share of the session that can be reached with a short replay, in [0, 1].
  double prepared() const { return moments_->share(); }

 private:
  Stage(recordings::SessionReader reader, std::unique_ptr<Moments> moments, std::uint32_t number,
        std::shared_ptr<Outbox> outbox);
  void work();
  bool is_outdated();
  void show_glimpse(PictureMaker& maker, Seeker& seeker, std::int64_t tick, std::uint32_t request);
  FrameFacts facts(const Seeker& seeker, std::uint32_t request);

  recordings::SessionReader reader_;
  std::unique_ptr<Moments> moments_;
  std::uint32_t number_;
  std::shared_ptr<Outbox> outbox_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::int64_t wanted_ = -1;  ///< tick; -1: none
  std::uint32_t request_ = 0;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace ctpm::server
