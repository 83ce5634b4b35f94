#include "recordings/table_file.h"

#include <unistd.h>

#include <filesystem>
#include <optional>

#include "recordings/internal/database.h"

namespace ctpm::recordings {
namespace {

namespace fs = std::filesystem;
using session_file::Database;
using session_file::Statement;

/// A name within SQL.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

void bind(Statement& statement, int index, const TableValue& value) {
  if (const auto* text = std::get_if<std::string>(&value))
    statement.bind(index, *text);
  else if (const auto* number = std::get_if<double>(&value))
    statement.bind(index, *number);
  else if (const auto* whole = std::get_if<std::int64_t>(&value))
    statement.bind(index, *whole);
  else
    statement.bind_nothing(index);
}

Result<Done> add_table(Database& database, const DataTable& table) {
  std::string names, places;
  for (const std::string& column : table.columns) {
    names += (names.empty() ? "" : ", ") + quoted(column);
    places += places.empty() ? "?" : ", ?";
  }
  if (Result<Done> made = database.run("CREATE TABLE " + quoted(table.name) + " (" + names + ")"); !made) return made;
  Result<Statement> insert = database.prepare("INSERT INTO " + quoted(table.name) + " VALUES (" + places + ")");
  if (!insert) return insert.errors();
  for (const std::vector<TableValue>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) bind(*insert, int(i) + 1, row[i]);
    if (insert->step() == Statement::Outcome::failed) return Error{database.path(), database.problem(), ""};
    insert->reset();
  }
  return Done{};
}

Result<Done> write_all(const std::string& path, const std::vector<DataTable>& tables) {
  Result<Database> database = Database::open(path, Database::Access::create);
  if (!database) return database.errors();
  Result<Done> written = database->run("BEGIN");
  for (std::size_t i = 0; i < tables.size() && written; ++i) written = add_table(*database, tables[i]);
  if (written) written = database->run("COMMIT");
  if (!written) return written;
  return database->close();
}

}  // namespace

Result<Done> write_table_file(const std::string& path, const std::vector<DataTable>& tables) {
  const std::string temporary = path + ".part-" + std::to_string(getpid());
  std::error_code failure;
  fs::remove(temporary, failure);
  Result<Done> written = write_all(temporary, tables);
  if (written) fs::rename(temporary, path, failure);
  if (written && !failure) return written;
  const std::string why = failure ? failure.message() : written.errors().front().message;
  fs::remove(temporary, failure);
  return Error{path, "cannot be written: " + why, ""};
}

}  // namespace ctpm::recordings
