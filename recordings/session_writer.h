#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session.h"

namespace ctpm::recordings {

struct WriterOptions {
  bool overwrite = false;       ///< replace a file of that name; otherwise it is an error
  bool wait_when_full = false;  ///< append() waits for the disk instead of losing ticks: for runs that are not live
  std::int32_t keyframe_ticks = 1000;  ///< ticks between two keyframes, >= 1: seeking costs at most so many steps
  std::int32_t queue_ticks = 1 << 16;  ///< ticks that can wait for a slow disk before they are lost, >= 200
  int compression_level = 3;           ///< zstd, in [1, 19]
};

/// How recording stands; `error` is empty as long as all is well.
struct WriterStatus {
  std::string error;           ///< first error since the last success, kept for good once ticks were lost
  std::int64_t appended = 0;   ///< ticks given to append()
  std::int64_t committed = 0;  ///< ticks that survive kill -9
  std::int64_t lost = 0;       ///< ticks that were not recorded: the queue was full or the disk failed to the end
};

/// Records one session. append() and event() belong to one thread, the tick's; they never wait for the disk
/// (unless WriterOptions::wait_when_full) and never allocate, except an event for its own text.
/// Compressing and writing are done by a thread of its own.
class SessionWriter {
 public:
  /// Writes the start and begins to record at `path`. Errors: a start that does not hold together, the file
  /// exists, the folder is missing or cannot be written. Nothing is left behind after an error.
  static Result<SessionWriter> create(const std::string& path, const SessionStart& start,
                                      const WriterOptions& options = {});

  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) noexcept;
  /// Without finish(): saves what was appended and leaves the session marked as not ended.
  ~SessionWriter();

  /// Records the next tick; `after` is the State that it led to.
  void append(const State& after, const TickRecord& record);

  /// Records an event of any tick.
  void event(Event event);

  /// May be called from any thread.
  WriterStatus status() const;

  /// 32 hexadecimal digits, random.
  const std::string& session_id() const;

  /// Writes what is left and marks the session as ended. Errors: anything that was not written, with the
  /// reason; what is in the file then is whole up to some tick and opens as a session without an end. Call
  /// once; append() is over.
  Result<SessionStatistics> finish(const std::vector<NamedValue>& values = {});

 private:
  struct Impl;
  explicit SessionWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::recordings
