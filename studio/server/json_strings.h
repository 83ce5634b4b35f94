#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ctpm::server {

/// A string of a JSON text, and where it stands there, with its quotes.
struct JsonString {
  std::size_t at = 0, size = 0;
  std::string value;
};

/// All strings of a JSON text in their order, keys among them. What stands in comments is none. A text that is no JSON
/// has those that can be told.
std::vector<JsonString> strings_of(const std::string& text);

/// The text with each of these strings, which it has in this order, said anew.
std::string with_strings(const std::string& text, const std::vector<JsonString>& changed);

}  // namespace ctpm::server
