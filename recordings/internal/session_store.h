#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/internal/session_database.h"
#include "recordings/internal/tick_codec.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// A run of ticks or events as stored in the file.
template <class T>
struct Run {
  std::int64_t first = 0;
  std::vector<T> items;
  std::int64_t end() const { return first + static_cast<std::int64_t>(items.size()); }
};

/// Reads and verifies single blocks of an untrusted file. SessionReader and recover_session check how blocks fit
/// together. Every error names the file's path and the block.
class SessionStore {
 public:
  /// `salvage` tolerates an inconsistent container and ignores its header numbers.
  static Result<SessionStore> open(const std::string& path, bool salvage);

  int version() const { return version_; }
  const SessionIdentity& identity() const { return identity_; }
  /// Memory that one block, or the list of all events, may take before and after decoding [bytes]. FORMAT.md
  /// section 11.
  std::uint64_t memory_limit() const { return memory_limit_; }
  /// Whether the file was left while it was recorded, and its log (`-wal`) is not beside it.
  bool lacks_log() const { return lacks_log_; }

  Result<Bytes> part(const std::string& name);
  /// None if the session has no such part; only `finish` and `initial` may be missing.
  Result<std::optional<Bytes>> part_if_there(const std::string& name);

  /// The names of all parts, known or not.
  Result<std::vector<std::string>> part_names();
  /// Calls `visit(label, size, data)` for each row of each table, in the order of tables and keys. The label is that of
  /// the checksum without the size; checksums are not verified.
  Result<Done> for_each_row(
      const std::function<void(const std::string& label, std::int64_t size, ByteView data)>& visit);
  /// Errors: what SQLite finds wrong with its own pages and tables.
  Result<Done> check_container();

  Result<std::string> scene();
  Result<std::string> look();
  Result<Model> model();  ///< updated from older formats and checked
  /// Choices that model() made where the file leaves them open, as readable sentences.
  const std::vector<std::string>& remarks() const { return remarks_; }
  Result<std::vector<Surface>> surfaces(const Model& model);  ///< checked
  Result<std::map<std::string, std::string>> metadata();
  Result<std::optional<SessionStatistics>> finish();
  Result<Done> read_columns();  ///< call once, before the first chunk

  /// The verified run with the largest `first` at or below `at`, or none.
  Result<std::optional<Run<TickRecord>>> chunk_at(std::int64_t at);
  Result<std::optional<Run<Event>>> events_at(std::int64_t at);
  /// The keyframe with the largest tick at or below `at`, checked against the Model.
  Result<std::optional<Keyframe>> keyframe_at(std::int64_t at, const Model& model);

  /// The part `initial`, a second copy of keyframe 0 that lies early in the file; none in older sessions.
  Result<std::optional<State>> initial_state(const Model& model);

  /// The keys of a table ("chunk", "keyframe" or "event") in ascending order, without reading the blocks.
  Result<std::vector<std::int64_t>> keys(const std::string& table);

 private:
  Error error(const std::string& message) const { return {database_.path(), message, ""}; }
  Error database_error(const std::string& what) const;
  Result<Done> check_header(bool salvage);
  Result<Done> check_schema();
  Result<Done> prepare();
  Result<Done> read_identity();
  template <class Fill>
  Result<Done> decode_fields(const std::string& name, const Bytes& content, Fill&& fill) const;
  Result<State> state_of(const std::string& name, const Bytes& content, const Model& model) const;
  Result<std::optional<Bytes>> block_of(Statement& statement, const std::string& what, bool has_count,
                                        std::uint64_t max_size, std::int64_t& first, std::int64_t& count);

  Database database_;
  Statement part_, chunk_, keyframe_, event_;
  int version_ = 0;
  bool lacks_log_ = false;
  std::uint64_t memory_limit_ = 0;  ///< of one block, decoded [bytes]
  SessionIdentity identity_;
  std::vector<std::string> remarks_;
  RecordDecoder decoder_;
};

}  // namespace ctpm::recordings::session_file
