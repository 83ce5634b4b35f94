#pragma once

#include <cstdint>
#include <string>

#include "core/model/result.h"
#include "recordings/internal/block.h"
#include "recordings/internal/database.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// The part `session`.
struct SessionIdentity {
  std::string id;          ///< 32 hexadecimal digits
  std::uint64_t seed = 0;  ///< of the checksums of all other blocks
  std::string build;       ///< build fingerprint
  double created_unix_s = 0;
  std::int32_t physics_revision = 0;  ///< 0: recorded before revisions were stored
};

template <class S, class Visit>
requires std::is_same_v<std::remove_const_t<S>, SessionIdentity>
void for_each_field(S& s, Visit&& visit) {
  visit("id", s.id);
  visit("seed", s.seed);
  visit("build", s.build);
  visit("created_unix_s", s.created_unix_s);
  visit("physics_revision", s.physics_revision);
}

/// A new random identity, from the operating system, for a session that begins with `start`.
SessionIdentity new_identity(const SessionStart& start);

/// Name of a block in its checksum and in messages.
std::string part_name(const std::string& name);
std::string chunk_name(std::int64_t first, std::int64_t count);
std::string keyframe_name(std::int64_t tick);
std::string event_name(std::int64_t first, std::int64_t count);

/// Whether a process records the session at `path` now. Its writer holds a lock on the log.
bool is_being_recorded(const std::string& path);

/// Makes a complete session file without ticks at `path`: writes a temporary file beside it, syncs and renames it. An
/// error leaves no file behind, nor do the unfinished files of starts that were killed. `overwrite` replaces an
/// existing file, unless it is being recorded.
Result<Done> create_session_file(const std::string& path, const SessionStart& start, const SessionIdentity& identity,
                                 bool overwrite, int level);

/// Removes a file and SQLite's files beside it.
void remove_with_companions(const std::string& path);

/// The tables of an open session file, for writing. All errors name the file's path.
class SessionTables {
 public:
  /// The empty tables of a new file, in a transaction that has begun; to be ended by commit() and close_new().
  static Result<SessionTables> create(const std::string& path);
  static Result<SessionTables> open_for_writing(const std::string& path);

  Result<Done> begin() { return database_.run("BEGIN IMMEDIATE"); }
  Result<Done> commit() { return database_.run("COMMIT"); }
  void rollback();

  Result<Done> insert_part(const std::string& name, const Block& block);
  Result<Done> insert_chunk(std::int64_t first, std::int64_t count, const Block& block);
  Result<Done> insert_keyframe(std::int64_t tick, const Block& block);
  Result<Done> insert_events(std::int64_t first, std::int64_t count, const Block& block);

  /// Copies what the log holds into the file, without waiting for other connections.
  Result<Done> checkpoint() { return database_.run("PRAGMA wal_checkpoint(PASSIVE)"); }

  /// Checkpoints the log, so that one file remains.
  Result<Done> close();
  /// Closes a file that was just created and has no log.
  Result<Done> close_new();

 private:
  Result<Done> prepare();
  Result<Done> insert(Statement& statement, int bound, const Block& block);

  Database database_;
  Statement part_, chunk_, keyframe_, event_;
};

}  // namespace ctpm::recordings::session_file
