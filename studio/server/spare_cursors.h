#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/model/state.h"
#include "recordings/replay.h"
#include "recordings/session_reader.h"

namespace ctpm::server {

/// Cursors of a session that are ready at its cuts as they are between one cut and the next, made ahead by a thread of
/// low priority: what a cut opens takes longer to build than hundreds of ticks.
class SpareCursors {
 public:
  /// `reader`, of the session, is that of whoever takes the cursors, and must outlive this and them.
  explicit SpareCursors(recordings::SessionReader& reader);
  ~SpareCursors();

  /// One that is ready at the cut of `state`; nothing: there is none.
  std::optional<recordings::ReplayCursor> take(const State& state);

  std::size_t count() const;                         ///< of those that were not taken yet
  bool is_done() const { return is_done_; }          ///< no more will be made
  static constexpr std::size_t kMost = 6;            ///< of the cuts that stay longest
  static constexpr std::size_t kLeastKeyframes = 3;  ///< that a cut stays

 private:
  class Walk;
  void make();

  recordings::SessionReader& reader_;
  mutable std::mutex mutex_;
  std::vector<recordings::ReplayCursor> ready_;
  std::atomic<bool> ends_{false}, is_done_{false};
  std::thread thread_;
};

}  // namespace ctpm::server
