#include "recordings/session_writer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

#include "recordings/internal/field_codec.h"
#include "recordings/internal/model_check.h"
#include "recordings/internal/ring.h"
#include "recordings/internal/schema.h"
#include "recordings/internal/session_database.h"
#include "recordings/internal/statistics.h"
#include "recordings/internal/tick_codec.h"

namespace ctpm::recordings {

using namespace session_file;
using Clock = std::chrono::steady_clock;

namespace {

constexpr auto poll_interval = std::chrono::milliseconds(5);
constexpr auto retry_interval = std::chrono::milliseconds(200);
constexpr auto checkpoint_interval = std::chrono::seconds(1);
constexpr const char* removed = "the file was removed or replaced while it was being recorded";
constexpr std::size_t chunks_per_commit = 32;  // limit with a backlog
constexpr std::size_t keyframe_slots = 4;

/// A row ready to be written.
struct Row {
  enum class Kind { chunk, keyframe, events } kind;
  std::int64_t first = 0, count = 0;
  Block block;
};

}  // namespace

struct SessionWriter::Impl {
  Impl(const SessionStart& start, const WriterOptions& options_)
      : options(options_),
        hands(start.model.hands),
        records(options_.queue_ticks, TickRecord{}),
        keyframes(keyframe_slots, Keyframe{0, start.initial_state}),
        next_keyframe(ticks_between(start.initial_state)) {}
  ~Impl() {
    stop();
    (void)tables.close();  // so that one file remains, which says that it is whole
  }

  // Set before the threads start.
  std::string path;
  SessionIdentity identity;
  WriterOptions options;
  std::int32_t hands;                 ///< Model::hands
  SessionTables tables, checkpoints;  // each of its own connection: the syncing thread makes the checkpoints
  int log_file = -1;
  dev_t device = 0;  ///< with `inode`, the file that is written
  ino_t inode = 0;

  // From the tick's thread to the writing thread.
  Ring<TickRecord> records;
  Ring<Keyframe> keyframes;
  std::mutex event_mutex;
  std::vector<Event> shared_events;
  std::atomic<std::int64_t> appended{0}, committed{0}, refused{0};
  std::atomic<bool> stopping{false}, saved_all{false};

  // The tick's thread only.
  std::int64_t next_keyframe;
  std::vector<Event> own_events;
  std::vector<NamedValue> values;

  // Writing thread only.
  std::int64_t next_tick = 0, next_event = 0;
  Clock::time_point oldest_seen;
  bool waiting_seen = false;
  std::vector<Row> rows;
  std::vector<TickRecord> batch;
  std::vector<Event> batch_events;
  StatisticsCounter counter;

  // From both threads to any caller.
  mutable std::mutex error_mutex;
  std::string error;
  std::atomic<bool> has_error{false}, is_removed{false};

  std::mutex wake_mutex;
  std::condition_variable wake_writer, wake_syncer;
  bool sync_wanted = false, sync_stops = false;
  std::thread writer, syncer;

  std::int64_t ticks_between(const State& state) const {
    return options.keyframe_ticks > 0 ? options.keyframe_ticks : ticks_to_next_keyframe(state);
  }
  template <class T>
  T* free_slot(Ring<T>& ring);
  Result<Done> begin();
  void stop();
  void hand_over_events();
  void write_until_stopped();
  void sync_until_stopped();
  bool gather(bool all);
  void gather_ticks(bool all);
  void gather_keyframes();
  void gather_events();
  Result<Done> write_rows();
  bool save(bool all);
  bool is_in_place() const;
  void set_error(const std::string& text);
  void clear_error();
};

std::int64_t ticks_to_next_keyframe(const State& state) {
  constexpr double kMoving = 0.77, kSwept = 0.06;  // of their bytes that compression leaves
  constexpr double kBytesPerTick = 112;            // 6.7 MB a minute at 1 kHz
  const std::size_t moving = 24 * (state.position.size() + state.velocity.size() + state.acceleration.size()) +
                             8 * (state.kelvin_elongation.size() + state.kelvin_dent.size());
  const double bytes = kMoving * double(moving) + kSwept * 25 * double(state.swept.size());
  return std::clamp<std::int64_t>(50 * std::llround(std::ceil(bytes / kBytesPerTick / 50)), 250, 1000);
}

// ---- the tick's thread ----

SessionWriter::SessionWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionWriter::SessionWriter(SessionWriter&&) noexcept = default;
SessionWriter& SessionWriter::operator=(SessionWriter&&) noexcept = default;
SessionWriter::~SessionWriter() = default;

Result<SessionWriter> SessionWriter::create(const std::string& path, const SessionStart& start,
                                            const WriterOptions& options) {
  CTPM_CHECK(options.keyframe_ticks >= 0 && options.queue_ticks >= 2 * chunk_ticks, "WriterOptions out of range");
  CTPM_CHECK(options.compression_level >= 1 && options.compression_level <= 19, "WriterOptions out of range");
  Errors errors = check_model(start.model);
  if (errors.empty()) errors = check_state(start.model, start.initial_state);
  if (errors.empty()) errors = check_surfaces(start.model, start.model.surfaces);
  if (!errors.empty()) return errors;

  auto impl = std::make_unique<Impl>(start, options);
  impl->path = path;
  impl->identity = new_identity(start);
  if (auto r = create_session_file(path, start, impl->identity, options.overwrite, options.compression_level); !r)
    return r.errors();
  if (auto r = impl->begin(); !r) {
    impl.reset();
    for (const char* ending : {"", "-wal", "-shm"}) ::unlink((path + ending).c_str());
    return r.errors();
  }
  return SessionWriter(std::move(impl));
}

/// A slot to fill, or null. Waits for one if wait_when_full is set, but not after a write error, because the wait might
/// never end.
template <class T>
T* SessionWriter::Impl::free_slot(Ring<T>& ring) {
  T* slot = ring.free_slot();
  while (!slot && options.wait_when_full && !has_error.load(std::memory_order_acquire)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    slot = ring.free_slot();
  }
  return slot;
}

void SessionWriter::append(const State& after, const TickRecord& record) {
  Impl& impl = *impl_;
  CTPM_CHECK(!impl.stopping.load(std::memory_order_relaxed), "append() after finish()");
  TickRecord* slot = impl.free_slot(impl.records);
  // Ticks after a lost one cannot be replayed, so the recording ends there.
  if (!slot || impl.refused.load(std::memory_order_relaxed) > 0) {
    impl.refused.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  *slot = record;
  impl.records.push();
  const std::int64_t done = impl.appended.load(std::memory_order_relaxed) + 1;
  impl.appended.store(done, std::memory_order_release);

  // Keyframes are optional: skip this one if no slot is free.
  if (done == impl.next_keyframe) {
    impl.next_keyframe += impl.ticks_between(after);
    if (Keyframe* keyframe = impl.free_slot(impl.keyframes)) {
      keyframe->tick = done;
      keyframe->state = after;
      impl.keyframes.push();
    }
  }
  if (!impl.own_events.empty()) impl.hand_over_events();
}

void SessionWriter::event(Event event) {
  impl_->own_events.push_back(std::move(event));
  impl_->hand_over_events();
}

void SessionWriter::Impl::hand_over_events() {
  // The writing thread holds this lock only for a swap. If it is taken, the next tick hands the events over.
  const std::unique_lock lock(event_mutex, std::try_to_lock);
  if (!lock) return;
  for (Event& event : own_events) shared_events.push_back(std::move(event));
  own_events.clear();
}

WriterStatus SessionWriter::status() const {
  const Impl& impl = *impl_;
  WriterStatus status;
  const std::int64_t refused = impl.refused.load();
  status.committed = impl.committed.load(std::memory_order_acquire);
  status.appended = impl.appended.load(std::memory_order_acquire) + refused;
  status.lost = impl.saved_all ? status.appended - status.committed : refused;
  const std::lock_guard lock(impl.error_mutex);
  status.error = impl.error;
  if (status.error.empty() && refused > 0) status.error = "the disk is too slow: ticks were lost";
  return status;
}

bool SessionWriter::has_error() const {
  return impl_->has_error.load(std::memory_order_acquire) || impl_->refused.load(std::memory_order_relaxed) > 0;
}

bool SessionWriter::is_removed() const { return impl_->is_removed.load(std::memory_order_acquire); }

const std::string& SessionWriter::session_id() const { return impl_->identity.id; }

Result<SessionStatistics> SessionWriter::finish(const std::vector<NamedValue>& values) {
  Impl& impl = *impl_;
  CTPM_CHECK(!impl.stopping, "finish() twice");
  impl.values = values;
  impl.stop();

  SessionStatistics statistics = impl.counter.result();
  statistics.values = values;
  if (!impl.is_in_place()) return Error{impl.path, removed, "nothing of the session is left under this name"};
  const WriterStatus now = status();
  if (now.lost > 0)
    return Error{
        impl.path,
        std::to_string(now.lost) + " of " + std::to_string(now.appended) + " ticks were not recorded: " + now.error,
        "the file holds the session up to tick " + std::to_string(now.committed)};
  if (!now.error.empty())
    return Error{impl.path, now.error, "all ticks are recorded, but the session is not marked as ended"};

  Bytes content;
  put_finish(content, statistics);
  const Block block = pack(part_name("finish"), content, impl.identity.seed, impl.options.compression_level);
  if (auto r = impl.tables.begin(); !r) return r.errors();
  auto written = impl.tables.insert_part("finish", block);
  if (written) written = impl.tables.commit();
  if (!written) {
    impl.tables.rollback();
    return written.errors();
  }
  if (auto r = impl.tables.close(); !r) return r.errors();
  return statistics;
}

// ---- the threads that write ----

Result<Done> SessionWriter::Impl::begin() {
  auto opened = SessionTables::open_for_writing(path);
  if (!opened) return opened.errors();
  tables = std::move(*opened);
  auto second = SessionTables::open_for_writing(path);
  if (!second) return second.errors();
  checkpoints = std::move(*second);
  // An empty transaction makes SQLite create the log.
  if (auto r = tables.begin(); !r) return r;
  if (auto r = tables.commit(); !r) return r;
  log_file = ::open((path + "-wal").c_str(), O_RDONLY | O_CLOEXEC);
  if (log_file < 0) return Error{path + "-wal", std::string("cannot be opened: ") + std::strerror(errno), ""};
  // The lock tells others that this session is being recorded; it ends with the process.
  if (::flock(log_file, LOCK_EX | LOCK_NB) != 0) return Error{path, "is being recorded by another process", ""};
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0) device = info.st_dev, inode = info.st_ino;
  writer = std::thread([this] { write_until_stopped(); });
  syncer = std::thread([this] { sync_until_stopped(); });
  return Done{};
}

void SessionWriter::Impl::stop() {
  if (!writer.joinable()) return;
  {
    // The tick's thread is here, so waiting for the lock is allowed.
    const std::lock_guard lock(event_mutex);
    for (Event& event : own_events) shared_events.push_back(std::move(event));
    own_events.clear();
  }
  {
    const std::lock_guard lock(wake_mutex);
    stopping = true;
  }
  wake_writer.notify_all();
  writer.join();
  {
    const std::lock_guard lock(wake_mutex);
    sync_stops = true;
  }
  wake_syncer.notify_all();
  syncer.join();
  ::close(log_file);
}

void SessionWriter::Impl::write_until_stopped() {
  while (true) {
    const bool last = stopping;
    const bool good = save(last);
    if (last) break;
    std::unique_lock lock(wake_mutex);
    wake_writer.wait_for(lock, good ? poll_interval : retry_interval, [this] { return stopping.load(); });
  }
  saved_all = true;
}

/// Writes what is due, or everything if `all`. False after a write error.
bool SessionWriter::Impl::save(bool all) {
  while (gather(all)) {
    if (auto r = write_rows(); !r) {
      tables.rollback();
      set_error(r.errors().front().message);
      return false;
    }
    clear_error();
    const std::lock_guard lock(wake_mutex);
    sync_wanted = true;
    wake_syncer.notify_one();
  }
  return true;
}

/// Packs what is due into rows, unless rows of a failed attempt remain. False if there is nothing to write.
bool SessionWriter::Impl::gather(bool all) {
  if (!rows.empty()) return true;
  batch.clear();
  batch_events.clear();
  gather_ticks(all);
  gather_keyframes();
  gather_events();
  return !rows.empty();
}

void SessionWriter::Impl::gather_ticks(bool all) {
  const std::size_t waiting = records.waiting();
  if (waiting == 0) return;
  if (!waiting_seen) oldest_seen = Clock::now(), waiting_seen = true;
  const bool old =
      std::chrono::duration<double>(Clock::now() - oldest_seen).count() >= chunk_age - 2e-3 * poll_interval.count();
  std::size_t taken = 0;
  for (std::size_t chunk = 0; chunk < chunks_per_commit && taken < waiting; ++chunk) {
    const std::size_t count = std::min<std::size_t>(chunk_ticks, waiting - taken);
    if (count < static_cast<std::size_t>(chunk_ticks) && !old && !all) break;
    for (std::size_t i = 0; i < count; ++i) batch.push_back(records.waiting_at(taken + i));
    const std::int64_t first = next_tick + static_cast<std::int64_t>(taken);
    Bytes content;
    put_records(content, std::span(batch).last(count), hands);
    const auto ticks = static_cast<std::int64_t>(count);
    rows.push_back({Row::Kind::chunk, first, ticks,
                    pack(chunk_name(first, ticks), content, identity.seed, options.compression_level)});
    taken += count;
  }
  if (taken > 0) waiting_seen = false;
}

/// A keyframe is written with the ticks that lead to it, never before them.
void SessionWriter::Impl::gather_keyframes() {
  const std::int64_t end = next_tick + static_cast<std::int64_t>(batch.size());
  const std::size_t waiting = keyframes.waiting();
  for (std::size_t i = 0; i < waiting && keyframes.waiting_at(i).tick <= end; ++i) {
    const Keyframe& keyframe = keyframes.waiting_at(i);
    Bytes content;
    put_fields(content, keyframe.state);
    rows.push_back({Row::Kind::keyframe, keyframe.tick, 1,
                    pack(keyframe_name(keyframe.tick), content, identity.seed, options.compression_level)});
  }
}

void SessionWriter::Impl::gather_events() {
  {
    const std::lock_guard lock(event_mutex);
    std::swap(batch_events, shared_events);
  }
  if (batch_events.empty()) return;
  Bytes content;
  put_field_set(content, [&](FieldWriter& writer) { writer("events", batch_events); });
  const auto count = static_cast<std::int64_t>(batch_events.size());
  rows.push_back({Row::Kind::events, next_event, count,
                  pack(event_name(next_event, count), content, identity.seed, options.compression_level)});
}

/// Writes one transaction, and advances queues and counts only if it succeeds.
Result<Done> SessionWriter::Impl::write_rows() {
  if (auto r = tables.begin(); !r) return r;
  std::size_t keyframe_count = 0;
  for (const Row& row : rows) {
    Result<Done> written = Done{};
    if (row.kind == Row::Kind::chunk) written = tables.insert_chunk(row.first, row.count, row.block);
    if (row.kind == Row::Kind::keyframe) written = tables.insert_keyframe(row.first, row.block), ++keyframe_count;
    if (row.kind == Row::Kind::events) written = tables.insert_events(row.first, row.count, row.block);
    if (!written) return written;
  }
  if (auto r = tables.commit(); !r) return r;

  for (const TickRecord& record : batch) counter.add(record);
  for (const Event& event : batch_events) counter.add(event);
  for (std::size_t i = 0; i < keyframe_count; ++i) counter.add_keyframe();
  records.pop(batch.size());
  keyframes.pop(keyframe_count);
  next_tick += static_cast<std::int64_t>(batch.size());
  next_event += static_cast<std::int64_t>(batch_events.size());
  committed.store(next_tick, std::memory_order_release);
  rows.clear();
  return Done{};
}

/// Makes commits durable, and copies the log into the file from time to time, so that the file alone holds all but
/// seconds of the session.
void SessionWriter::Impl::sync_until_stopped() {
  Clock::time_point copied = Clock::now();
  bool is_behind = false;  // the file, behind its log
  std::unique_lock lock(wake_mutex);
  while (true) {
    const auto is_woken = [this] { return sync_wanted || sync_stops; };
    if (is_behind)
      wake_syncer.wait_until(lock, copied + checkpoint_interval, is_woken);
    else
      wake_syncer.wait(lock, is_woken);
    if (sync_stops && !sync_wanted) break;
    is_behind = is_behind || sync_wanted;
    const bool syncs = std::exchange(sync_wanted, false);
    lock.unlock();
    if (!is_in_place()) set_error(removed);
    if (syncs && ::fdatasync(log_file) != 0)
      set_error(std::string("the disk did not confirm: ") + std::strerror(errno));
    if (Clock::now() - copied >= checkpoint_interval) {
      copied = Clock::now();
      // What cannot be copied now stays in the log until the next time.
      is_behind = !checkpoints.checkpoint();
    }
    lock.lock();
  }
  checkpoints = {};
}

/// Whether the file under the session's name is still the one that is written.
bool SessionWriter::Impl::is_in_place() const {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && info.st_dev == device && info.st_ino == inode;
}

void SessionWriter::Impl::set_error(const std::string& text) {
  // Whatever fails first once the file is gone, that is the reason.
  const bool is_gone = !is_in_place();
  const std::lock_guard lock(error_mutex);
  if (is_gone)
    error = removed;
  else if (error.empty())
    error = text;
  if (is_gone) is_removed = true;
  has_error = true;
}

void SessionWriter::Impl::clear_error() {
  if (!has_error || refused.load() > 0 || is_removed) return;
  const std::lock_guard lock(error_mutex);
  error.clear();
  has_error = false;
}

}  // namespace ctpm::recordings
