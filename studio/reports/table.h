#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "studio/output/json_writer.h"

namespace ctpm::reports {

/// The verdict on a condition.
enum class ReportVerdict {
  met,      ///< holds
  missed,   ///< must hold and does not hold
  shown,    ///< need not hold; the value is only shown
  refused,  ///< was refused beforehand, which is allowed
};

/// A word that leads to another page, by its relative address.
struct Link {
  std::string text, address;
};

/// A number, a word, a verdict, a link, or empty.
using Cell = std::variant<std::monostate, std::string, double, std::int64_t, ReportVerdict, Link>;

struct Column {
  std::string key;       ///< name in JSON and CSV, contains the unit (`force_n`)
  std::string title;     ///< name for people, with the unit
  int digits = 4;        ///< significant digits in the page; JSON and CSV keep all
  bool decides = false;  ///< stands beside a row's first cell on narrow screens, as verdicts do
};

/// Rows under named columns, for the page and for programs.
struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< (row_count x column_count)
  std::string caption;
};

/// "met", "missed", "shown", "refused".
const char* to_word(ReportVerdict verdict);

/// The table without the columns in which no row has a value.
Table without_empty_columns(Table table);

/// The table as an HTML element; numbers are right-aligned, verdicts coloured.
std::string to_html(const Table& table);

/// The table as CSV (RFC 4180): a header line, then one line per row; text is quoted where necessary.
std::string to_csv(const Table& table);

/// Writes a list of objects, one per row; empty cells are left out.
void write_rows(output::JsonWriter& json, const Table& table);

}  // namespace ctpm::reports
