#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"
#include "scenes/text_places.h"

// JSON text as a tree that keeps the place and the spelling of each value. Internal to scenes.
namespace ctpm::scenes {

enum class JsonKind { null, boolean, number, text, list, object };

struct JsonNode {
  JsonKind kind = JsonKind::null;
  Place place;                     ///< of the value's first character
  std::size_t begin = 0, end = 0;  ///< bytes of the value in the text without comments: [begin, end)
  std::string raw;   ///< a scalar as it is written; numbers are converted from this text, not from a double
  std::string text;  ///< a text without quotes and escapes
  std::vector<std::string> keys;   ///< of an object, in the order of the text, repeated ones included (child_count)
  std::vector<Place> key_places;   ///<                                                               (child_count)
  std::vector<JsonNode> children;  ///< of a list or an object (child_count)

  /// The first member of that name; null if there is none.
  const JsonNode* find(std::string_view key) const;
  /// The member or the item that a part of a JSON pointer names; null if there is none.
  const JsonNode* child(const std::string& part) const;
};

/// "the number 4", "the text "abc"", "a list of 3" ...: what was got, for messages.
std::string describe(const JsonNode& node);

/// Longest text that is read [bytes]; shipped scenes have some thousand.
inline constexpr std::size_t kMostTextBytes = 16 << 20;
/// The error of a longer one.
Error too_long(const std::string& file_name, std::uintmax_t bytes);

/// The text of a file. Errors: it does not exist, is no file, is too long or cannot be read.
Result<std::string> text_of_file(const std::string& path);

/// Comments, // and /* */, count as spaces. Error: one, at the place where the text stops being JSON, or is nested
/// deeper than 64 levels; a text longer than kMostTextBytes or of more than 200,000 values.
Result<JsonNode> parse_json(std::string_view commented, const std::string& file_name);

/// `text` in quotes, escaped.
std::string in_quotes(std::string_view text);

/// "/organs/0" + "fill" -> "/organs/0/fill", escaped as RFC 6901 asks.
std::string child_pointer(const std::string& pointer, std::string_view key);
std::string child_pointer(const std::string& pointer, std::size_t index);

/// The decimal number in `raw`, times 10^exponent, rounded once. So `4.1` in mm is the double nearest to
/// 0.0041.
double decimal_to_double(std::string_view raw, int exponent);

/// The shortest decimal that decimal_to_double(., exponent) turns into `value` again; `value` must be finite.
std::string double_to_decimal(double value, int exponent);

}  // namespace ctpm::scenes
