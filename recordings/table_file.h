#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/model/result.h"

namespace ctpm::recordings {

/// Empty, a text, a number or a whole number.
using TableValue = std::variant<std::monostate, std::string, double, std::int64_t>;

struct DataTable {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::vector<TableValue>> rows;  ///< (row_count x column_count)
};

/// Writes tables for other programs to an SQLite file of their own, in place of one that is there, by one rename.
/// Error: it cannot be written; then the file is what it was.
Result<Done> write_table_file(const std::string& path, const std::vector<DataTable>& tables);

}  // namespace ctpm::recordings
