#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session.h"

namespace ctpm::recordings {

struct WriterOptions {
  bool overwrite = false;              ///< replaces an existing file; false: an existing file is an error
  bool wait_when_full = false;         ///< append() waits for the disk instead of losing ticks; for offline runs
  std::int32_t keyframe_ticks = 0;     ///< ticks between keyframes; 0: ticks_to_next_keyframe()
  std::int32_t queue_ticks = 1 << 16;  ///< queue capacity [ticks], >= 200; ticks beyond it are lost
  int compression_level = 3;           ///< zstd, in [1, 19]
};

/// How many ticks after the keyframe of `state` the next one follows, which is as many as a seek simulates at most: 250
/// to 1,000 in steps of 50, so that the keyframes of most scenes take 7 MB a minute or less.
std::int64_t ticks_to_next_keyframe(const State& state);

/// State of the recording. `error` is empty while recording works.
struct WriterStatus {
  std::string error;           ///< first error since the last success; permanent once ticks were lost
  std::int64_t appended = 0;   ///< ticks passed to append()
  std::int64_t committed = 0;  ///< ticks that survive kill -9
  std::int64_t lost = 0;       ///< ticks not recorded because the queue was full or the disk failed until the end
};

/// Records one session. Call append() and event() from one thread, the tick's. They never wait for the disk (unless
/// WriterOptions::wait_when_full is set) and never allocate, except an event for its own text. Separate threads
/// compress, write and sync.
class SessionWriter {
 public:
  /// Writes the start to `path` and begins recording. Errors: an inconsistent start, an existing file, a missing or
  /// read-only folder. An error leaves no file behind.
  static Result<SessionWriter> create(const std::string& path, const SessionStart& start,
                                      const WriterOptions& options = {});

  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) noexcept;
  /// Without finish(): saves all appended ticks; the session stays marked as not ended.
  ~SessionWriter();

  /// Records the next tick; `after` is the State after it.
  void append(const State& after, const TickRecord& record);

  /// Records an event of any tick.
  void event(Event event);

  /// May be called from any thread.
  WriterStatus status() const;

  /// Whether status() has an error, without waiting, for every tick.
  bool has_error() const;

  /// Whether somebody removed or replaced the file: nothing more can be saved.
  bool is_removed() const;

  /// 32 hexadecimal digits, random.
  const std::string& session_id() const;

  /// Writes the remaining ticks and marks the session as ended. Errors: everything that was not written, with the
  /// reason; the file is then intact up to some tick and opens as a session without an end. Call finish() once;
  /// append() must not follow.
  Result<SessionStatistics> finish(const std::vector<NamedValue>& values = {});

 private:
  struct Impl;
  explicit SessionWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ctpm::recordings
