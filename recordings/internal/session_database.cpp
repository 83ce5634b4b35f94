#include "recordings/internal/session_database.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "recordings/internal/field_codec.h"
#include "recordings/internal/schema.h"
#include "recordings/internal/tick_codec.h"

namespace ctpm::recordings::session_file {
namespace {

Error system_error(const std::string& path, const std::string& what) {
  return Error{path, what + ": " + std::strerror(errno), ""};
}

bool exists(const std::string& path) {
  struct stat info {};
  return ::lstat(path.c_str(), &info) == 0;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

/// A rename is durable once its folder is synced.
Result<Done> sync_folder(const std::string& path) {
  const int folder = ::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return system_error(path, "its folder cannot be opened");
  const bool good = ::fsync(folder) == 0 || errno == EINVAL;
  ::close(folder);
  if (!good) return system_error(path, "its folder cannot be synced");
  return Done{};
}

/// Renames the finished `temporary`. Removes the log of an older file of that name, so that it is not applied to the
/// new one.
Result<Done> put_in_place(const std::string& temporary, const std::string& path, bool overwrite) {
  if (overwrite) {
    for (const char* ending : {"-journal", "-wal", "-shm"}) ::unlink((path + ending).c_str());
    if (::rename(temporary.c_str(), path.c_str()) != 0) return system_error(path, "cannot be replaced");
    return sync_folder(path);
  }
  int outcome = ::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
  if (outcome != 0 && errno == EINVAL && !exists(path)) outcome = ::rename(temporary.c_str(), path.c_str());
  if (outcome != 0) return system_error(path, "cannot be created");
  return sync_folder(path);
}

Result<Done> check_place(const std::string& path, bool overwrite) {
  if (path.empty()) return Error{path, "the name of the session file is empty", ""};
  struct stat info {};
  if (::stat(folder_of(path).c_str(), &info) != 0 || !S_ISDIR(info.st_mode))
    return Error{path, "the folder " + folder_of(path) + " does not exist", "create it first"};
  if (::access(folder_of(path).c_str(), W_OK) != 0)
    return Error{path, "the folder " + folder_of(path) + " cannot be written", ""};
  if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode)) return Error{path, "is not a regular file", ""};
  if (is_being_recorded(path)) return Error{path, "is being recorded by another process", ""};
  if (overwrite) return Done{};
  if (exists(path)) return Error{path, "exists already", "choose another name, or allow it to be replaced"};
  if (exists(path + "-wal"))
    return Error{path + "-wal", "is left over from another session of that name",
                 "move it to its session file, or delete it"};
  return Done{};
}

constexpr std::string_view part_ending = ".part";

/// Removes the unfinished files of `path` whose process is gone: `PATH.PID-HEX.part`.
void remove_left_behind(const std::string& path) {
  const std::string prefix = std::filesystem::path(path).filename().string() + ".";
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder_of(path), failure)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(part_ending)) continue;
    pid_t process = 0;
    const char* const end = name.data() + name.size();
    const auto [last, problem] = std::from_chars(name.data() + prefix.size(), end, process);
    // The name is as long as it says, so that it is no other file of a user.
    const bool is_ours = problem == std::errc() && *last == '-' && end - last == 1 + 8 + std::ssize(part_ending);
    if (is_ours && process > 0 && ::kill(process, 0) != 0 && errno == ESRCH)
      remove_with_companions(entry.path().string());
  }
}

struct NamedContent {
  const char* name;
  Bytes content;
};

/// Writes all parts known at the start.
std::vector<NamedContent> start_parts(const SessionStart& start, const SessionIdentity& identity) {
  std::vector<NamedContent> parts;
  const auto add_text = [&](const char* name, const std::string& text) {
    parts.push_back({name, Bytes(text.begin(), text.end())});
  };
  const auto add_fields = [&](const char* name, const auto& give) {
    parts.push_back({name, {}});
    put_field_set(parts.back().content, give);
  };
  add_fields("session", [&](FieldWriter& w) { for_each_field(identity, w); });
  add_text("scene", start.scene_text);
  add_text("look", start.look);
  add_fields("model", [&](FieldWriter& w) { for_each_field(start.model, w); });
  add_fields("surfaces", [&](FieldWriter& w) { w("surfaces", start.model.surfaces); });
  add_fields("metadata", [&](FieldWriter& w) {
    for (const auto& [key, value] : start.metadata) w(key, value);
  });
  add_text("columns", column_text(start.model.hands));
  parts.push_back({"initial", {}});
  put_fields(parts.back().content, start.initial_state);
  return parts;
}

std::string sql_of_new_file() {
  std::string sql =
      "PRAGMA page_size=4096; PRAGMA auto_vacuum=NONE; PRAGMA encoding='UTF-8'; PRAGMA journal_mode=DELETE; "
      "PRAGMA synchronous=FULL; "
      "BEGIN;";
  for (const Table& table : tables) sql += std::string(table.sql) + ";";
  return sql + "PRAGMA application_id=" + std::to_string(application_id) +
         "; PRAGMA user_version=" + std::to_string(format_version);
}

}  // namespace

bool is_being_recorded(const std::string& path) {
  const int log = ::open((path + "-wal").c_str(), O_RDONLY | O_CLOEXEC);
  if (log < 0) return false;
  const bool is_locked = ::flock(log, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(log);
  return is_locked;
}

void remove_with_companions(const std::string& path) {
  for (const char* ending : {"", "-journal", "-wal", "-shm"}) ::unlink((path + ending).c_str());
}

SessionIdentity new_identity(const SessionStart& start) {
  SessionIdentity identity;
  std::uint64_t random[3] = {};
  CTPM_CHECK(::getrandom(random, sizeof random, 0) == static_cast<ssize_t>(sizeof random),
             "random bytes from the system");
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(random[0]),
                static_cast<unsigned long long>(random[1]));
  identity.id = text;
  identity.seed = random[2];
  identity.build = start.build_fingerprint;
  identity.physics_revision = start.physics_revision;
  identity.created_unix_s = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  return identity;
}

std::string part_name(const std::string& name) { return "part " + name; }
std::string chunk_name(std::int64_t first, std::int64_t count) {
  return "chunk " + std::to_string(first) + " " + std::to_string(count);
}
std::string keyframe_name(std::int64_t tick) { return "keyframe " + std::to_string(tick); }
std::string event_name(std::int64_t first, std::int64_t count) {
  return "event " + std::to_string(first) + " " + std::to_string(count);
}

Result<Done> SessionTables::prepare() {
  const auto one = [&](Statement& statement, const char* sql) -> Result<Done> {
    auto prepared = database_.prepare(sql);
    if (!prepared) return prepared.errors();
    statement = std::move(*prepared);
    return Done{};
  };
  if (auto r = one(part_, "INSERT INTO part VALUES(?1,?2,?3,?4)"); !r) return r;
  if (auto r = one(chunk_, "INSERT INTO chunk VALUES(?1,?2,?3,?4,?5)"); !r) return r;
  if (auto r = one(keyframe_, "INSERT INTO keyframe VALUES(?1,?2,?3,?4)"); !r) return r;
  return one(event_, "INSERT INTO event VALUES(?1,?2,?3,?4,?5)");
}

Result<SessionTables> SessionTables::create(const std::string& path) {
  auto database = Database::open(path, Database::Access::create);
  if (!database) return database.errors();
  SessionTables tables;
  tables.database_ = std::move(*database);
  if (auto r = tables.database_.run(sql_of_new_file()); !r) return r.errors();
  if (auto r = tables.prepare(); !r) return r.errors();
  return tables;
}

Result<SessionTables> SessionTables::open_for_writing(const std::string& path) {
  auto database = Database::open(path, Database::Access::write);
  if (!database) return database.errors();
  SessionTables tables;
  tables.database_ = std::move(*database);
  if (auto r =
          tables.database_.run("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL; PRAGMA wal_autocheckpoint=1024;");
      !r)
    return r.errors();
  if (auto r = tables.prepare(); !r) return r.errors();
  return tables;
}

void SessionTables::rollback() {
  // After some errors SQLite has already rolled back.
  if (database_.in_transaction() && !database_.run("ROLLBACK")) return;
}

Result<Done> SessionTables::insert(Statement& statement, int bound, const Block& block) {
  statement.bind(bound + 1, block.size).bind(bound + 2, block.checksum).bind(bound + 3, ByteView(block.data));
  const Statement::Outcome outcome = statement.step();
  Result<Done> result = Done{};
  if (outcome != Statement::Outcome::done) result = Error{database_.path(), database_.problem(), ""};
  statement.reset();
  return result;
}

Result<Done> SessionTables::insert_part(const std::string& name, const Block& block) {
  part_.bind(1, name);
  return insert(part_, 1, block);
}
Result<Done> SessionTables::insert_chunk(std::int64_t first, std::int64_t count, const Block& block) {
  chunk_.bind(1, first).bind(2, count);
  return insert(chunk_, 2, block);
}
Result<Done> SessionTables::insert_keyframe(std::int64_t tick, const Block& block) {
  keyframe_.bind(1, tick);
  return insert(keyframe_, 1, block);
}
Result<Done> SessionTables::insert_events(std::int64_t first, std::int64_t count, const Block& block) {
  event_.bind(1, first).bind(2, count);
  return insert(event_, 2, block);
}

Result<Done> SessionTables::close_new() {
  part_ = {}, chunk_ = {}, keyframe_ = {}, event_ = {};
  return database_.close();
}

Result<Done> SessionTables::close() {
  if (!database_.is_open()) return Done{};
  part_ = {}, chunk_ = {}, keyframe_ = {}, event_ = {};
  // Fails while another process reads the file. The file is then still complete, with its log beside it.
  if (auto r = database_.run("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode=DELETE;"); !r) return r;
  return database_.close();
}

Result<Done> create_session_file(const std::string& path, const SessionStart& start, const SessionIdentity& identity,
                                 bool overwrite, int level) {
  if (auto r = check_place(path, overwrite); !r) return r;
  remove_left_behind(path);
  const std::string temporary =
      path + "." + std::to_string(::getpid()) + "-" + identity.id.substr(0, 8) + std::string(part_ending);
  const auto write = [&]() -> Result<Done> {
    auto tables = SessionTables::create(temporary);
    if (!tables) return tables.errors();
    for (const NamedContent& part : start_parts(start, identity)) {
      const std::uint64_t seed = std::strcmp(part.name, "session") == 0 ? 0 : identity.seed;
      if (part.content.size() > max_part_size)
        return Error{path, part_name(part.name) + " is larger than a session file may hold", ""};
      if (auto r = tables->insert_part(part.name, pack(part_name(part.name), part.content, seed, level)); !r) return r;
    }
    Bytes state;
    put_fields(state, start.initial_state);
    if (auto r = tables->insert_keyframe(0, pack(keyframe_name(0), state, identity.seed, level)); !r) return r;
    if (auto r = tables->commit(); !r) return r;
    return tables->close_new();
  };

  Result<Done> result = write();
  if (result) result = put_in_place(temporary, path, overwrite);
  if (result) return result;
  remove_with_companions(temporary);
  // Messages name the requested file, not the temporary one.
  Errors errors = result.errors();
  for (Error& error : errors)
    if (error.where == temporary) error.where = path;
  return errors;
}

}  // namespace ctpm::recordings::session_file
