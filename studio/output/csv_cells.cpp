#include "studio/output/csv_cells.h"

#include <algorithm>

namespace ctpm::output {

std::vector<CsvCell> csv_cells(std::string_view line) {
  std::vector<CsvCell> cells;
  std::size_t first = 0;
  while (true) {
    const std::size_t end = std::min(line.find(',', first), line.size());
    std::size_t from = first, to = end;
    const auto is_blank = [&](std::size_t i) { return line[i] == ' ' || line[i] == '\t'; };
    while (from < to && is_blank(from)) ++from;
    while (to > from && is_blank(to - 1)) --to;
    if (to - from >= 2 && line[from] == '"' && line[to - 1] == '"') ++from, --to;
    cells.push_back({line.substr(from, to - from), from + 1});
    if (end == line.size()) return cells;
    first = end + 1;
  }
}

bool has_other_separators(std::string_view line) {
  return line.find(',') == std::string_view::npos && line.find_first_of(";\t") != std::string_view::npos;
}

std::vector<CsvLine> csv_lines(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<CsvLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.find_first_not_of(" \t") != std::string_view::npos) lines.push_back({number, line});
  }
  return lines;
}

}  // namespace ctpm::output
