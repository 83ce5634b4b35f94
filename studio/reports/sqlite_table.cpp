#include "studio/reports/sqlite_table.h"

#include "recordings/table_file.h"

namespace ctpm::reports {
namespace {

recordings::TableValue text_or_null(const std::string& text) {
  return text.empty() ? recordings::TableValue() : recordings::TableValue(text);
}

recordings::TableValue value_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return text_or_null(*text);
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  if (const auto* count = std::get_if<std::int64_t>(&cell)) return *count;
  if (const auto* verdict = std::get_if<ReportVerdict>(&cell)) return std::string(to_word(*verdict));
  if (const auto* link = std::get_if<Link>(&cell)) return text_or_null(link->text);
  return {};
}

}  // namespace

Result<Done> write_sqlite(const std::string& path, const std::string& name, const Table& table) {
  recordings::DataTable data{name, {}, {}};
  for (const Column& column : table.columns) data.columns.push_back(column.key);
  for (const std::vector<Cell>& row : table.rows) {
    data.rows.emplace_back();
    for (const Cell& cell : row) data.rows.back().push_back(value_of(cell));
  }
  return recordings::write_table_file(path, {data});
}

}  // namespace ctpm::reports
