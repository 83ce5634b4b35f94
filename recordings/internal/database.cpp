#include "recordings/internal/database.h"

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

namespace ctpm::recordings::session_file {
namespace {

/// `path` as a file URI with parameters.
std::string file_uri(const std::string& path, const std::string& parameters) {
  static constexpr char hex[] = "0123456789ABCDEF";
  std::string uri = path.front() == '/' ? "file://" : "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#')
      uri += {'%', hex[c >> 4], hex[c & 15]};
    else
      uri += c;
  }
  return uri + "?" + parameters;
}

bool has_content(const std::string& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && info.st_size > 0;
}

/// Whether SQLite needs to create an index of the log beside the file and cannot.
bool needs_a_copy(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return !has_content(path + "-shm") && ::access(folder.empty() ? "." : folder.c_str(), W_OK) != 0;
}

/// Copies a file and its log to a new folder and returns the folder; empty on failure.
std::string copy_with_log(const std::string& path) {
  std::error_code problem;
  std::string folder = (std::filesystem::temp_directory_path(problem) / "ctpm-XXXXXX").string();
  if (problem || !::mkdtemp(folder.data())) return "";
  for (const char* ending : {"", "-wal"})
    if (!problem) std::filesystem::copy_file(path + ending, folder + "/copy" + ending, problem);
  if (!problem) return folder;
  std::filesystem::remove_all(folder, problem);
  return "";
}

/// Nothing in an untrusted file may run, allocate without bound or write.
void defend(sqlite3* connection, bool salvage) {
  sqlite3_db_config(connection, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(connection, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(connection, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  // Salvage must read a truncated file. SQLite allows that only outside its defensive mode.
  if (salvage)
    sqlite3_db_config(connection, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
  else
    sqlite3_db_config(connection, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, 1 << 30);
  sqlite3_limit(connection, SQLITE_LIMIT_SQL_LENGTH, 10000);
  sqlite3_limit(connection, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_exec(connection, "PRAGMA cell_size_check=ON; PRAGMA query_only=ON; PRAGMA mmap_size=0;", nullptr, nullptr,
               nullptr);
}

}  // namespace

Statement::Statement(Statement&& other) noexcept : statement_(std::exchange(other.statement_, nullptr)) {}
Statement& Statement::operator=(Statement&& other) noexcept {
  std::swap(statement_, other.statement_);
  return *this;
}
Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::bind(int index, std::int64_t value) {
  sqlite3_bind_int64(statement_, index, value);
  return *this;
}
Statement& Statement::bind(int index, double value) {
  sqlite3_bind_double(statement_, index, value);
  return *this;
}
Statement& Statement::bind_nothing(int index) {
  sqlite3_bind_null(statement_, index);
  return *this;
}
Statement& Statement::bind(int index, const std::string& text) {
  sqlite3_bind_text(statement_, index, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  return *this;
}
Statement& Statement::bind(int index, ByteView blob) {
  sqlite3_bind_blob64(statement_, index, blob.data(), blob.size(), SQLITE_STATIC);
  return *this;
}

Statement::Outcome Statement::step() {
  const int code = sqlite3_step(statement_);
  return code == SQLITE_ROW ? Outcome::row : code == SQLITE_DONE ? Outcome::done : Outcome::failed;
}
void Statement::reset() { sqlite3_reset(statement_); }

bool Statement::is_integer(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_INTEGER; }
bool Statement::is_text(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_TEXT; }
bool Statement::is_blob(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_BLOB; }
std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_, column); }
std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return text ? std::string(text, sqlite3_column_bytes(statement_, column)) : std::string();
}
ByteView Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
  return {data, data ? static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)) : 0};
}

Result<Database> Database::open(const std::string& path, Access access) {
  Database database;
  database.path_ = path;
  const bool reads = access == Access::read || access == Access::salvage;
  int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_URI;
  flags |= reads ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
  if (access == Access::create) flags |= SQLITE_OPEN_CREATE;
  // A file without a log is opened as immutable, so that SQLite creates no files beside it.
  const bool alone = reads && !has_content(path + "-wal");
  std::string opened = path;
  if (reads && !alone && needs_a_copy(path)) {
    database.copy_folder_ = copy_with_log(path);
    if (!database.copy_folder_.empty()) opened = database.copy_folder_ + "/copy";
  }
  const std::string uri = file_uri(opened, alone ? "immutable=1" : "cache=private");
  const int code = sqlite3_open_v2(uri.c_str(), &database.connection_, flags, nullptr);
  if (code != SQLITE_OK) return Error{path, "cannot be opened: " + database.problem(), ""};
  sqlite3_busy_timeout(database.connection_, 2000);
  if (reads) defend(database.connection_, access == Access::salvage);
  return database;
}

Database::Database(Database&& other) noexcept
    : connection_(std::exchange(other.connection_, nullptr)),
      path_(std::move(other.path_)),
      copy_folder_(std::exchange(other.copy_folder_, "")) {}
Database& Database::operator=(Database&& other) noexcept {
  std::swap(connection_, other.connection_);
  std::swap(path_, other.path_);
  std::swap(copy_folder_, other.copy_folder_);
  return *this;
}
Database::~Database() {
  sqlite3_close_v2(connection_);
  std::error_code ignored;
  if (!copy_folder_.empty()) std::filesystem::remove_all(copy_folder_, ignored);
}

Result<Done> Database::run(const std::string& sql) {
  if (sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    return Error{path_, problem(), ""};
  return Done{};
}

Result<Statement> Database::prepare(const std::string& sql) {
  Statement statement;
  if (sqlite3_prepare_v3(connection_, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &statement.statement_, nullptr) !=
      SQLITE_OK)
    return Error{path_, problem(), ""};
  return statement;
}

Result<Done> Database::close() {
  if (sqlite3_close(connection_) != SQLITE_OK) return Error{path_, problem(), ""};
  connection_ = nullptr;
  return Done{};
}

std::string Database::problem() const {
  if (!connection_) return "out of memory";
  std::string text = sqlite3_errmsg(connection_);
  const int system_error = sqlite3_system_errno(connection_);
  if (system_error != 0 && !is_corrupt()) text += " (system error " + std::to_string(system_error) + ")";
  return text;
}

bool Database::is_corrupt() const {
  const int code = sqlite3_errcode(connection_) & 0xff;
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
}
bool Database::is_full() const {
  const int code = sqlite3_errcode(connection_) & 0xff;
  return code == SQLITE_FULL || code == SQLITE_IOERR;
}
bool Database::in_transaction() const { return connection_ && sqlite3_get_autocommit(connection_) == 0; }

}  // namespace ctpm::recordings::session_file
