#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/model/result.h"
#include "recordings/internal/bytes.h"

namespace ctpm::recordings::session_file {

/// One row as a page of a SQLite file holds it. Nothing of it is verified.
struct ScannedRow {
  using Value = std::variant<std::monostate, std::int64_t, std::string, Bytes>;
  std::int64_t key = 0;  ///< the row's number; 0 in a table WITHOUT ROWID
  std::vector<Value> values;
};

/// Visits the rows on all pages of the SQLite file `path` and of the log beside it, whether or not an inner page leads
/// to them: the format of pages and records is that of https://www.sqlite.org/fileformat2.html, sections 1.6 and 2.
/// Rows that were deleted or moved may appear as well, and a row twice. Numbers other than integers are not read.
/// Reads at most a few times the file. Error: the file cannot be read.
Result<Done> scan_rows(const std::string& path, const std::function<void(const ScannedRow&)>& visit);

}  // namespace ctpm::recordings::session_file
