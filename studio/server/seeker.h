#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "studio/server/moments.h"
#include "studio/server/spare_cursors.h"

namespace ctpm::server {

/// Reaches any tick of a session, from the nearest State that is kept. Several cursors stay at different cuts, because
/// what a cut opens takes longer to build than many ticks.
class Seeker {
 public:
  /// `reader`, `moments` and `spares`, of the same session, must outlive this.
  Seeker(recordings::SessionReader& reader, Moments& moments, SpareCursors& spares)
      : reader_(reader), moments_(moments), spares_(spares) {}

  /// Whether the way to `tick` is long: many ticks, or a cut at which no cursor is.
  bool is_far(std::int64_t tick) const;

  /// Goes to the State before `tick`. False: `should_stop` said so on the way. Errors: the session cannot be replayed.
  Result<bool> go_to(std::int64_t tick, const std::function<bool()>& should_stop);

  /// Where the last go_to() ended; before the first one there is none.
  const recordings::ReplayCursor& cursor() const { return cursors_[last_].replay; }
  bool is_same() const { return is_same(cursors_[last_]); }  ///< everything up to there was as recorded

 private:
  struct Cursor {
    recordings::ReplayCursor replay;
    bool was_same = true;  ///< up to the State from which it came
    std::uint64_t used = 0;
  };
  static bool is_same(const Cursor& cursor) { return cursor.was_same && cursor.replay.same_so_far(); }
  bool is_there(std::int64_t tick) const { return has_report_ && cursors_[last_].replay.tick() == tick; }
  bool goes_on(std::int64_t tick);
  std::size_t find_at_cut_of(const State& state) const;
  void put(recordings::ReplayCursor cursor);
  Result<Done> begin_at(const Moments::Place& place);

  recordings::SessionReader& reader_;
  Moments& moments_;
  SpareCursors& spares_;
  std::vector<Cursor> cursors_;
  std::size_t last_ = 0;
  bool has_report_ = false;  ///< the last go_to() came to its end
  std::uint64_t uses_ = 0;
};

}  // namespace ctpm::server
