#include "studio/server/spare_cursors.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

#include "studio/server/cut_key.h"
#include "studio/server/idle_pause.h"
#include "studio/session/urgency.h"

namespace ctpm::server {
namespace {

/// Keyframes from one to another that have the same cut.
struct Stay {
  std::size_t first = 0, last = 0;
  std::size_t length() const { return last - first; }
};

}  // namespace

/// The way through a session's keyframes. A swept surface only grows, so that halving finds where it stays.
class SpareCursors::Walk {
 public:
  Walk(recordings::SessionReader reader, std::vector<std::int64_t> keyframes, const std::atomic<bool>& ends)
      : reader_(std::move(reader)), keyframes_(std::move(keyframes)), ends_(ends) {}

  /// The cuts that stay, those that stay longest first.
  std::vector<Stay> stays() {
    const std::optional<State> first = state_at(0), last = state_at(keyframes_.size() - 1);
    if (first && last) look_between(0, keyframes_.size() - 1, *first, *last);
    std::stable_sort(stays_.begin(), stays_.end(), [](Stay a, Stay b) { return a.length() > b.length(); });
    return stays_;
  }

  std::int64_t tick_of(std::size_t keyframe) const { return keyframes_[keyframe]; }

  std::optional<State> state_at(std::size_t keyframe) {
    while (IdlePause::is_on() && !ends_) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    Result<recordings::Keyframe> read = reader_.keyframe_at_or_before(keyframes_[keyframe]);
    return read && !ends_ ? std::optional(std::move(read->state)) : std::nullopt;
  }

 private:
  void look_between(std::size_t first, std::size_t last, const State& at_first, const State& at_last) {
    if (CutKey(at_first).is_of(at_last)) {
      if (at_first.swept.size() == 0) return;  // whole tissue has nothing to build
      if (!stays_.empty() && stays_.back().last == first) return void(stays_.back().last = last);
      return stays_.push_back({first, last});
    }
    if (last - first <= 1) return;
    const std::size_t middle = first + (last - first) / 2;
    const std::optional<State> between = state_at(middle);
    if (!between) return;  // a damaged session
    look_between(first, middle, at_first, *between);
    look_between(middle, last, *between, at_last);
  }

  recordings::SessionReader reader_;
  std::vector<std::int64_t> keyframes_;
  const std::atomic<bool>& ends_;
  std::vector<Stay> stays_;
};

SpareCursors::SpareCursors(recordings::SessionReader& reader) : reader_(reader) {
  is_done_ = !reader.start().model.has_scalpel();
  if (!is_done_) thread_ = std::thread([this] { make(), is_done_ = true; });
}

SpareCursors::~SpareCursors() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
}

void SpareCursors::make() {
  session::become(session::Urgency::idle);
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(reader_.path());
  if (!reader) return;
  const Result<std::vector<std::int64_t>> keyframes = reader->keyframe_ticks();
  if (!keyframes || keyframes->empty()) return;
  Walk walk(std::move(*reader), *keyframes, ends_);
  std::vector<Stay> stays = walk.stays();
  std::erase_if(stays, [](Stay stay) { return stay.length() < kLeastKeyframes; });
  if (stays.size() > kMost) stays.resize(kMost);
  for (const Stay& stay : stays) {
    // Only what a tool can touch is built, so a moment is taken in which one is held.
    std::optional<State> state;
    for (std::size_t part = 0; part < 8; ++part) {
      const std::size_t keyframe = stay.first + part * stay.length() / 8;
      state = walk.state_at(keyframe);
      if (!state) return;
      if (state->touched.size() == 0 && part + 1 < 8) continue;
      Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(reader_);
      if (!cursor) return;
      cursor->resume(walk.tick_of(keyframe), *state);
      cursor->prepare();
      const std::lock_guard lock(mutex_);
      ready_.push_back(std::move(*cursor));
      break;
    }
  }
}

std::size_t SpareCursors::count() const {
  const std::lock_guard lock(mutex_);
  return ready_.size();
}

std::optional<recordings::ReplayCursor> SpareCursors::take(const State& state) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(ready_.begin(), ready_.end(), [&](const recordings::ReplayCursor& cursor) {
    return CutKey(cursor.state()).is_of(state);
  });
  if (found == ready_.end()) return std::nullopt;
  std::optional<recordings::ReplayCursor> taken(std::move(*found));
  ready_.erase(found);
  return taken;
}

}  // namespace ctpm::server
