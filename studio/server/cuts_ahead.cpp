#include "studio/server/cuts_ahead.h"

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "recordings/session_reader.h"
#include "studio/server/cut_key.h"
#include "studio/server/idle_pause.h"
#include "studio/session/urgency.h"

namespace ctpm::server {

/// The way through a session's keyframes. A swept surface only grows, so that halving finds those where it did.
class CutsAhead::Walk {
 public:
  Walk(recordings::SessionReader reader, std::vector<std::int64_t> keyframes, std::uint32_t stage, CutsAhead& ahead)
      : reader_(std::move(reader)),
        keyframes_(std::move(keyframes)),
        ahead_(ahead),
        follower_(reader_.start().model, stage) {}

  void go() {
    const State& first = reader_.start().initial_state;
    if (!CutKey(first).is_whole() && !draw(first)) return;
    if (const std::optional<State> last = state_at(keyframes_.size() - 1))
      draw_between(0, keyframes_.size() - 1, first, *last);
  }

 private:
  std::optional<State> state_at(std::size_t keyframe) {
    Result<recordings::Keyframe> read = reader_.keyframe_at_or_before(keyframes_[keyframe]);
    return read ? std::optional(std::move(read->state)) : std::nullopt;
  }

  bool draw(const State& state) { return ahead_.cuts_->keep_for_good(follower_.draw(state)); }

  /// Draws what is cut after the keyframe `first` and until `last`. False: it must end.
  bool draw_between(std::size_t first, std::size_t last, const State& at_first, const State& at_last) {
    while (IdlePause::is_on() && !ahead_.ends_) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (ahead_.ends_) return false;
    if (first == last || CutKey(at_first).is_of(at_last)) return true;
    if (last - first == 1) return draw(at_last);
    const std::size_t middle = first + (last - first) / 2;
    const std::optional<State> between = state_at(middle);
    if (!between) return false;  // a damaged session: its cuts are drawn when they are needed
    return draw_between(first, middle, at_first, *between) && draw_between(middle, last, *between, at_last);
  }

  recordings::SessionReader reader_;
  std::vector<std::int64_t> keyframes_;
  CutsAhead& ahead_;
  CutFollower follower_;
};

CutsAhead::CutsAhead(const std::string& file, const Model& model, std::uint32_t stage, std::shared_ptr<DrawnCuts> cuts)
    : cuts_(std::move(cuts)) {
  if (!model.has_scalpel()) return;
  thread_ = std::thread([this, file, stage] {
    session::become(session::Urgency::idle);
    Result<recordings::SessionReader> reader = recordings::SessionReader::open(file);
    if (!reader) return;
    const Result<std::vector<std::int64_t>> keyframes = reader->keyframe_ticks();
    if (keyframes && !keyframes->empty()) Walk(std::move(*reader), *keyframes, stage, *this).go();
  });
}

CutsAhead::~CutsAhead() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace ctpm::server
