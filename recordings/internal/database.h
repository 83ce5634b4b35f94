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
  Statement& bind(int index, double value);
  Statement& bind(int index, const std::string& text);
  Statement& bind(int index, ByteView blob);  ///< the bytes must live until reset()
  Statement& bind_nothing(int index);

  /// If failed, Database::problem() gives the reason.
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
    write,    ///< an existing file
    read,     ///< an existing untrusted file
    salvage,  ///< like read, but tolerates inconsistencies of the file
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

  bool is_open() const { return connection_ != nullptr; }
  std::string problem() const;  ///< message of the last failed call
  bool is_corrupt() const;      ///< the last failure was damaged file content
  bool is_full() const;         ///< the last failure was lack of space or a device error
  bool in_transaction() const;
  const std::string& path() const { return path_; }

 private:
  sqlite3* connection_ = nullptr;
  std::string path_;
  std::string copy_folder_;  ///< folder of the copy read in place of the file; empty: no copy
};

}  // namespace ctpm::recordings::session_file
