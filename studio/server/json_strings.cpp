#include "studio/server/json_strings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace ctpm::server {
namespace {

/// Behind the string that begins at `at`; behind the text if it does not end.
std::size_t end_of_string(const std::string& text, std::size_t at) {
  for (std::size_t i = at + 1; i < text.size(); ++i)
    if (text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      return i + 1;
  return text.size();
}

/// Behind the comment that begins at `at`.
std::size_t end_of_comment(const std::string& text, std::size_t at) {
  const bool is_line = text[at + 1] == '/';
  const std::size_t end = is_line ? text.find('\n', at) : text.find("*/", at + 2);
  return end == std::string::npos ? text.size() : end + (is_line ? 1 : 2);
}

}  // namespace

std::vector<JsonString> strings_of(const std::string& text) {
  std::vector<JsonString> found;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "//") == 0 || text.compare(i, 2, "/*") == 0) {
      i = end_of_comment(text, i);
    } else if (text[i] == '"') {
      const std::size_t end = end_of_string(text, i);
      const auto value = nlohmann::json::parse(text.substr(i, end - i), nullptr, false);
      if (value.is_string()) found.push_back({i, end - i, value.get<std::string>()});
      i = end;
    } else {
      ++i;
    }
  }
  return found;
}

std::string with_strings(const std::string& text, const std::vector<JsonString>& changed) {
  std::string result;
  std::size_t done = 0;
  for (const JsonString& one : changed) {
    result += text.substr(done, one.at - done) + nlohmann::json(one.value).dump();
    done = one.at + one.size;
  }
  return result + text.substr(done);
}

}  // namespace ctpm::server
