#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ctpm::output {

/// One value of a row of a CSV table, without the blanks and the quotes around it.
struct CsvCell {
  std::string_view text;
  std::size_t column = 0;  ///< where it starts in its line, counted from 1
};

/// The values of a line, which must outlive them. Commas part values, also between quotes.
std::vector<CsvCell> csv_cells(std::string_view line);

/// Whether semicolons or tabs part the values of a line, as spreadsheets write where a comma is part of numbers.
bool has_other_separators(std::string_view line);
inline constexpr const char* kOtherSeparators = "semicolons or tabs part the values";
inline constexpr const char* kSeparatorHint = "save it with commas between the values, and points in the numbers";

/// A line of a CSV table that is not blank.
struct CsvLine {
  std::size_t number = 0;  ///< from 1
  std::string_view text;   ///< without its end
};

/// The lines of a text, which must outlive them; a byte order mark is left out.
std::vector<CsvLine> csv_lines(std::string_view text);

}  // namespace ctpm::output
