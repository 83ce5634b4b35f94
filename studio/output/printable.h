#pragma once

#include <string>
#include <string_view>

namespace ctpm::output {

/// `text` with its control characters written out, `\xHH` or `\u{HHHH}`, so that a text from a file cannot steer a
/// terminal: C0, DEL, C1, and those that change the direction of writing. Bytes that are no UTF-8 become `\xHH` as
/// well. With `lines`, newlines stay.
std::string printable(std::string_view text, bool lines = false);

/// `text` as a JSON string with its quotes. The same characters are escaped; bytes that are no UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

/// `text` as a value of a CSV table: in quotes if it holds a comma, a quote or the end of a line.
std::string csv_text(const std::string& text);

/// `text` as one word of a shell's command line: as it is where that is safe, else in single quotes.
std::string shell_word(const std::string& text);

}  // namespace ctpm::output
