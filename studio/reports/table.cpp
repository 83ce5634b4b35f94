#include "studio/reports/table.h"

#include <algorithm>
#include <cstdio>

#include "core/model/result.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"
#include "studio/reports/plot.h"

namespace ctpm::reports {
namespace {

std::string whole_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Names its column, because narrow screens show a row as lines without the table's head.
std::string html_cell(const Cell& cell, const Column& column, bool is_only_verdict) {
  const std::string title = " data-title=\"" + escape_html(column.title) + "\">";
  if (const auto* text = std::get_if<std::string>(&cell))
    return std::string("<td") + (column.decides ? " class=\"verdict-cell\"" : "") + title + escape_html(*text) +
           "</td>";
  if (const auto* value = std::get_if<double>(&cell))
    return "<td class=\"n\"" + title + output::short_number(*value, column.digits) + "</td>";
  if (const auto* count = std::get_if<std::int64_t>(&cell))
    return "<td class=\"n\"" + title + std::to_string(*count) + "</td>";
  if (const auto* verdict = std::get_if<ReportVerdict>(&cell))
    return "<td" + (is_only_verdict || column.decides ? " class=\"verdict-cell\">" : title) + "<span class=\"v " +
           to_word(*verdict) + "\">" + to_word(*verdict) + "</span></td>";
  if (const auto* link = std::get_if<Link>(&cell))
    return "<td" + title + "<a href=\"" + escape_html(link->address) + "\">" + escape_html(link->text) + "</a></td>";
  return "<td></td>";
}

std::string csv_cell(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return output::csv_text(*text);
  if (const auto* value = std::get_if<double>(&cell)) return whole_number(*value);
  if (const auto* count = std::get_if<std::int64_t>(&cell)) return std::to_string(*count);
  if (const auto* verdict = std::get_if<ReportVerdict>(&cell)) return to_word(*verdict);
  if (const auto* link = std::get_if<Link>(&cell)) return output::csv_text(link->text);
  return "";
}

void check_shape(const Table& table) {
  for (const auto& row : table.rows) CTPM_CHECK(row.size() == table.columns.size(), "one cell for each column");
}

}  // namespace

const char* to_word(ReportVerdict verdict) {
  switch (verdict) {
    case ReportVerdict::met:
      return "met";
    case ReportVerdict::missed:
      return "missed";
    case ReportVerdict::shown:
      return "shown";
    case ReportVerdict::refused:
      return "refused";
  }
  return "";
}

Table without_empty_columns(Table table) {
  check_shape(table);
  const auto is_empty = [](const Cell& cell) {
    const auto* text = std::get_if<std::string>(&cell);
    return std::holds_alternative<std::monostate>(cell) || (text && text->empty());
  };
  for (std::size_t i = table.columns.size(); i-- > 0;) {
    if (!std::ranges::all_of(table.rows, [&](const auto& row) { return is_empty(row[i]); })) continue;
    const auto at = std::ptrdiff_t(i);
    table.columns.erase(table.columns.begin() + at);
    for (std::vector<Cell>& row : table.rows) row.erase(row.begin() + at);
  }
  return table;
}

std::string to_html(const Table& table) {
  check_shape(table);
  std::string html = "<div class=\"table\">";
  if (!table.title.empty()) html += "<p class=\"head\">" + escape_html(table.title) + "</p>";
  html += "<table><thead><tr>";
  for (const Column& column : table.columns) html += "<th>" + escape_html(column.title) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    const auto is_verdict = [](const Cell& cell) { return std::holds_alternative<ReportVerdict>(cell); };
    const bool has_one = std::count_if(row.begin(), row.end(), is_verdict) == 1;
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += html_cell(row[i], table.columns[i], has_one);
    html += "</tr>\n";
  }
  html += "</tbody></table>";
  if (!table.caption.empty()) html += "<p class=\"caption\">" + escape_html(table.caption) + "</p>";
  return html + "</div>\n";
}

std::string to_csv(const Table& table) {
  check_shape(table);
  std::string csv;
  for (std::size_t i = 0; i < table.columns.size(); ++i) csv += (i ? "," : "") + output::csv_text(table.columns[i].key);
  csv += "\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) csv += (i ? "," : "") + csv_cell(row[i]);
    csv += "\n";
  }
  return csv;
}

void write_rows(output::JsonWriter& json, const Table& table) {
  check_shape(table);
  json.begin_list();
  for (const auto& row : table.rows) {
    json.begin_object();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string& key = table.columns[i].key;
      if (const auto* text = std::get_if<std::string>(&row[i])) json.member(key, std::string_view(*text));
      if (const auto* value = std::get_if<double>(&row[i])) json.member(key, *value);
      if (const auto* count = std::get_if<std::int64_t>(&row[i])) json.member(key, *count);
      if (const auto* verdict = std::get_if<ReportVerdict>(&row[i])) json.member(key, to_word(*verdict));
      if (const auto* link = std::get_if<Link>(&row[i])) json.member(key, std::string_view(link->text));
    }
    json.end_object();
  }
  json.end_list();
}

}  // namespace ctpm::reports
