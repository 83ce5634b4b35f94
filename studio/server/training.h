#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/model/result.h"
#include "recordings/session.h"
#include "studio/devices/device_source.h"
#include "studio/devices/open_device.h"
#include "studio/server/hand_limits.h"
#include "studio/server/newest_state.h"
#include "studio/server/outbox.h"
#include "studio/server/page_hand.h"
#include "studio/server/picture_pace.h"

namespace ctpm::server {

/// What a page asks for when it begins to train.
struct TrainingRequest {
  std::string scene;              ///< file of the scene
  std::string file;               ///< session file to write; it must not exist. Empty: nothing is kept
  std::string shown;              ///< its name as the page knows it
  HandLimits limits;              ///< of the hands that the page leads
  double most_speed = 1;          ///< of the hand; faster motion counts as a jump [m/s]
  devices::DeviceRequest device;  ///< that leads in place of the page, if one is asked for
};

/// A running session that a page leads, or a device while a page looks on. One thread ticks, in real time; another one
/// makes pictures for the page.
class Training {
 public:
  /// Starts with the State of `start`, and ticks from the hand's first pose on. Errors: the scene has no tool; those of
  /// devices::open_device().
  static Result<std::unique_ptr<Training>> begin(std::shared_ptr<const recordings::SessionStart> start,
                                                 const TrainingRequest& request, std::uint32_t stage,
                                                 std::shared_ptr<Outbox> outbox);

  /// Ends the session and waits until it is saved.
  ~Training();

  /// Where its device is awaited; empty: the page leads.
  const std::string& awaited() const { return awaited_; }

  const std::string& scene() const { return request_.scene; }  ///< its file
  bool has_ended() const { return has_ended_; }

  /// A message of the page; from one thread.
  void move(const HandMoves& moves, double sent_s) {
    for (std::size_t i = 0; i < moves.size(); ++i)
      if (moves[i] && hands_[i] != nullptr) hands_[i]->move(*moves[i], sent_s);
  }

  /// The page would draw the next picture of that stage at once; see PicturePace.
  void ready(std::uint32_t stage) {
    if (stage == stage_) pace_.ready();
  }

  /// Ends the session; the event "train_ended" follows.
  void end() { ends_ = true; }

 private:
  Training(std::shared_ptr<const recordings::SessionStart> start, const TrainingRequest& request, std::uint32_t stage,
           std::shared_ptr<Outbox> outbox);
  Result<std::map<std::string, std::string>> follow_hands();
  Result<std::map<std::string, std::string>> follow_device();
  void tell(const char* event, const std::string& text);
  void tick();
  void show();

  std::shared_ptr<const recordings::SessionStart> start_;
  TrainingRequest request_;
  std::uint32_t stage_;
  std::shared_ptr<Outbox> outbox_;
  std::string awaited_;
  std::array<PageHand*, kMostHands> hands_{};     ///< of source_; null: the page does not lead it
  std::vector<devices::DeviceSource*> followed_;  ///< of source_
  std::unique_ptr<sources::InputSource> source_;
  NewestState newest_;
  PicturePace pace_;
  std::atomic<bool> ends_{false}, has_ended_{false};
  std::thread ticks_, pictures_;
};

}  // namespace ctpm::server
