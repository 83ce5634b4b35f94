#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "studio/output/json_writer.h"

namespace ctpm::reports {

/// What became of something that must hold.
enum class ReportVerdict {
  met,      ///< holds
  missed,   ///< must hold and does not
  shown,    ///< does not agree and need not; it is shown as it is
  refused,  ///< was refused beforehand, as it may be
};

/// A number, a word, a verdict, or nothing.
using Cell = std::variant<std::monostate, std::string, double, std::int64_t, ReportVerdict>;

struct Column {
  std::string key;    ///< name in JSON and CSV, with the unit in it (`force_n`)
  std::string title;  ///< as a person reads it, with the unit
  int digits = 4;     ///< significant digits in the page; JSON and CSV keep all
};

/// Rows under named columns: once shown in a page, once written for programs.
struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< each with one cell a column
  std::string caption;
};

/// "met", "missed", "shown", "refused".
const char* to_word(ReportVerdict verdict);

/// The table as an HTML element; numbers stand right, verdicts are coloured.
std::string to_html(const Table& table);

/// One header line, then one line a row; text is quoted where it must be (RFC 4180).
std::string to_csv(const Table& table);

/// A list of objects, one a row; empty cells are left out.
void write_rows(output::JsonWriter& json, const Table& table);

}  // namespace ctpm::reports
