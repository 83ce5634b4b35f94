#pragma once

#include <cstddef>
#include <string>
#include <vector>

// The strings of a JSON text, for whoever looks for one of them or says it anew.
namespace ctpm::scenes {

/// A string of a JSON text, and where it stands there, with its quotes.
struct TextString {
  std::size_t at = 0, size = 0;  ///< [bytes]
  std::string value;             ///< without quotes and escapes
};

/// All strings of a text in their order, keys among them; what stands in comments is none. The text need not be JSON:
/// one that its author has to mend, or is writing, still names files, and they must not go as if nothing did. Of such a
/// text these are its strings: whatever stands between two quotes of a line and is a string there. A comment that does
/// not end is none.
std::vector<TextString> strings_of(const std::string& text);

/// The text with each of these strings, which it has in this order, said anew.
std::string with_strings(const std::string& text, const std::vector<TextString>& changed);

}  // namespace ctpm::scenes
