#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "recordings/internal/bytes.h"

struct sqlite3;
struct sqlite3_stmt;

namespace ctpm::recordings::session_file {

class Database;

/// A prepared statement. Values are bound from 1 and read from 0, as in SQLite.
class Statement {
 public:
  enum class Outcome { row, done, failed };

  Statement() = default;
  Statement(Statement&& other) noexcept;
  Statement& operator=(Statement&& other) noexcept;
  ~Statement();

  Statement& bind(int index, std::int64_t value);
  Statement& bind(int index, const std::string& text);
  Statement& bind(int index, ByteView blob);  ///< the bytes must live until reset()

  /// Failed: Database::problem() says why.
  Outcome step();
  void reset();

  bool is_integer(int column) const;
  bool is_text(int column) const;
  bool is_blob(int column) const;
  std::int64_t integer(int column) const;
  std::string text(int column) const;
  ByteView blob(int column) const;  ///< valid until the next step() or reset()

 private:
  friend class Database;
  sqlite3_stmt* statement_ = nullptr;
};

/// One connection to a SQLite file.
class Database {
 public:
  enum class Access {
    create,   ///< a new file
    write,    ///< an existing one
    read,     ///< an existing one that is not trusted
    salvage,  ///< as read, and goes on where the file contradicts itself
  };

  static Result<Database> open(const std::string& path, Access access);

  Database() = default;
  Database(Database&& other) noexcept;
  Database& operator=(Database&& other) noexcept;
  ~Database();

  /// Runs SQL text without results. Error: SQLite's, at the path.
  Result<Done> run(const std::string& sql);
  Result<Statement> prepare(const std::string& sql);
  Result<Done> close();

  std::string problem() const;  ///< of the last call that failed
  bool is_corrupt() const;      ///< the last failure was about the file's content
  bool is_full() const;         ///< the last failure was about the space or the device
  bool in_transaction() const;
  const std::string& path() const { return path_; }

 private:
  sqlite3* connection_ = nullptr;
  std::string path_;
  std::string copy_folder_;  ///< where a copy is read, because no index can be put beside the file; empty if
                             ///< it is not
};

}  // namespace ctpm::recordings::session_file
