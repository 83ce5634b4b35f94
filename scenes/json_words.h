#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// What keeps a text from being JSON, in words for authors. Internal to scenes.
namespace ctpm::scenes {

/// The first mistake of a text's grammar.
struct JsonMistake {
  std::size_t offset = 0;  ///< of the first byte of what is wrong
  std::string message, hint;
};

/// Finds the first mistake in the grammar of a JSON text without comments; none if it finds nothing.
std::optional<JsonMistake> find_json_mistake(std::string_view text);

/// The text with the comments `// to the end of the line` and `/* ... */` replaced by spaces, so that line and column
/// of all that follows stay the same. A comment without an end is left as it is. `origin`, if given, receives where
/// each byte of the result, and its end, was in `text`.
std::string without_comments(std::string_view text, std::vector<std::size_t>* origin = nullptr);

}  // namespace ctpm::scenes
