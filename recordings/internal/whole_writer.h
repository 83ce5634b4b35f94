#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/internal/session_database.h"
#include "recordings/internal/statistics.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// Writes a session of which all is known, in one transaction: its start, then ticks, keyframes and events in any order
/// between them, then its end. After an error, and without close(), an incomplete file is left behind.
class WholeWriter {
 public:
  /// Errors: those of create_session_file(); the file exists.
  static Result<WholeWriter> create(const std::string& path, const SessionStart& start,
                                    const SessionIdentity& identity);

  /// The next ticks; at least one and at most 100.
  Result<Done> add_ticks(const std::vector<TickRecord>& records);
  /// Any but the first, which is the start's State.
  Result<Done> add_keyframe(const Keyframe& keyframe);
  /// All events; called once.
  Result<Done> add_events(const std::vector<Event>& events);
  /// Marks a clean end, with statistics counted from what was added, and these numbers of the program.
  Result<Done> add_end(const std::vector<NamedValue>& values);
  Result<Done> close();

 private:
  WholeWriter(SessionTables tables, std::uint64_t seed, std::int32_t hands)
      : tables_(std::move(tables)), seed_(seed), hands_(hands) {}

  SessionTables tables_;
  StatisticsCounter counter_;
  std::uint64_t seed_;
  std::int32_t hands_;
  std::int64_t next_ = 0;  ///< tick
};

}  // namespace ctpm::recordings::session_file
