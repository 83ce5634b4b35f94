#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session.h"

namespace ctpm::recordings {

/// Reads a session file, finished or not, also while it is being recorded. Nothing in the file is trusted:
/// every block is proven by its checksum before it is decoded, and the Model, the States and the surfaces are
/// checked before they are handed out. Memory grows with the Model and one chunk, not with the length of the
/// session. For one thread at a time.
class SessionReader {
 public:
  /// Errors: the file does not exist, is not a session, is of a newer version, is cut short, or its start is
  /// damaged.
  static Result<SessionReader> open(const std::string& path);

  SessionReader(SessionReader&&) noexcept;
  SessionReader& operator=(SessionReader&&) noexcept;
  ~SessionReader();

  const std::string& path() const;
  const SessionStart& start() const;
  const std::string& session_id() const;
  double created_unix_s() const;  ///< when recording began, seconds since 1970
  int format_version() const;
  std::int64_t tick_count() const;  ///< at the time of open()
  /// What this program decided where an old file leaves it open, one sentence each.
  const std::vector<std::string>& remarks() const;
  bool ended_cleanly() const;  ///< false: cut off, or still being recorded

  /// Records of the ticks [from, to). Errors: out of range, or a damaged or missing chunk, named.
  Result<std::vector<TickRecord>> ticks(std::int64_t from, std::int64_t to);

  /// The last keyframe at or before `tick`. Keyframe 0 is always there. Errors: it is damaged.
  Result<Keyframe> keyframe_at_or_before(std::int64_t tick);

  /// The ticks of all keyframes, ascending.
  Result<std::vector<std::int64_t>> keyframe_ticks();

  /// All events in the order they were recorded.
  Result<std::vector<Event>> events();

  /// As recorded at the end; for a session without an end, worked out from its ticks and events.
  Result<SessionStatistics> statistics();

  /// Reads and proves every block, and that none is missing. Errors: all damaged places.
  Result<Done> check_all();

 private:
  struct Impl;
  explicit SessionReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::recordings
