#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session.h"

namespace ctpm::recordings {

/// Reads a session file: finished, cut off, or still being recorded. It trusts nothing in the file. Each block's
/// checksum is verified before the block is decoded, and the Model, States and surfaces are checked before they are
/// returned. Memory grows with the Model and one chunk, not with the length of the session. Not thread-safe: use one
/// reader per thread.
class SessionReader {
 public:
  /// Errors: the file does not exist, is not a session, has a newer version, is truncated, or its start is damaged.
  static Result<SessionReader> open(const std::string& path);

  SessionReader(SessionReader&&) noexcept;
  SessionReader& operator=(SessionReader&&) noexcept;
  ~SessionReader();

  const std::string& path() const;
  const SessionStart& start() const;
  const std::string& session_id() const;
  double created_unix_s() const;  ///< start of recording, in seconds since 1970
  int format_version() const;
  std::int64_t tick_count() const;  ///< at the time of open()
  /// One sentence each: choices that this program made where an old file leaves them open, and a missing log.
  const std::vector<std::string>& remarks() const;
  bool ended_cleanly() const;  ///< false: recording was interrupted or still runs

  /// Records of ticks [from, to). Errors: range outside the session, or a damaged or missing chunk, which is named.
  Result<std::vector<TickRecord>> ticks(std::int64_t from, std::int64_t to);

  /// The last keyframe at or before `tick`. Keyframe 0 always exists. Error: the keyframe is damaged.
  Result<Keyframe> keyframe_at_or_before(std::int64_t tick);

  /// The ticks of all keyframes, ascending.
  Result<std::vector<std::int64_t>> keyframe_ticks();

  /// All events in the order they were recorded.
  Result<std::vector<Event>> events();

  /// Statistics stored at the end; for a session without an end, computed from its ticks and events.
  Result<SessionStatistics> statistics();

  /// Verifies the container, every block, that none is missing or out of place, the links of events, and the stored
  /// statistics. Errors: everything that is wrong.
  Result<Done> check_all();

 private:
  struct Impl;
  explicit SessionReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::recordings
