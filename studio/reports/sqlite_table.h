#pragma once

#include <string>

#include "core/model/result.h"
#include "studio/reports/table.h"

namespace ctpm::reports {

/// Writes a table under `name` to an SQLite file of its own, by one rename, in place of one that is there: numbers as
/// numbers, empty texts as NULL, columns by their keys. Error: it cannot be written; then the file is what it was.
Result<Done> write_sqlite(const std::string& path, const std::string& name, const Table& table);

}  // namespace ctpm::reports
