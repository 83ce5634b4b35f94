#include "scenes/text_strings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenes/json_text.h"
#include "scenes/json_words.h"

namespace ctpm::scenes {
namespace {

/// Behind the string that begins at `at`; there, if it does not end in its line.
std::size_t end_of_string(const std::string& text, std::size_t at) {
  for (std::size_t i = at + 1; i < text.size() && text[i] != '\n'; ++i)
    if (text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      return i + 1;
  return at;
}

}  // namespace

std::vector<TextString> strings_of(const std::string& text) {
  std::vector<std::size_t> origin;
  const std::string plain = without_comments(text, &origin);
  std::vector<TextString> found;
  for (std::size_t at = plain.find('"'); at != std::string::npos; at = plain.find('"', at)) {
    const std::size_t end = end_of_string(plain, at);
    if (end == at) {  // the rest of the line is no string
      at = std::min(plain.find('\n', at), plain.size());
      continue;
    }
    const auto value = nlohmann::json::parse(plain.substr(at, end - at), nullptr, false);
    if (value.is_string()) found.push_back({origin[at], end - at, value.get<std::string>()});
    at = end;
  }
  return found;
}

std::string with_strings(const std::string& text, const std::vector<TextString>& changed) {
  std::string result;
  std::size_t done = 0;
  for (const TextString& one : changed) {
    result += text.substr(done, one.at - done) + in_quotes(one.value);
    done = one.at + one.size;
  }
  return result + text.substr(done);
}

}  // namespace ctpm::scenes
