#include "scenes/json_text.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "scenes/json_words.h"

namespace ctpm::scenes {
namespace {

namespace fs = std::filesystem;

constexpr int max_depth = 64;
constexpr std::size_t most_values = 200'000;  // of a text; a node of the tree takes some hundred bytes

/// Checks the grammar and the depth; keeps the first error. Builds nothing.
class GrammarCheck : public nlohmann::json_sax<nlohmann::json> {
 public:
  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return count(); }
  bool start_object(std::size_t) override { return ++depth_ <= max_depth && count(); }
  bool key(string_t&) override { return true; }
  bool end_object() override { return --depth_, true; }
  bool start_array(std::size_t) override { return ++depth_ <= max_depth && count(); }
  bool end_array() override { return --depth_, true; }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& problem) override {
    // `position` is behind the first character that does not fit; the token before it may begin long before.
    offset = position == 0 ? 0 : position - 1;
    message = problem.what();
    return false;
  }

  bool has_too_many() const { return values_ > most_values; }

  std::size_t offset = 0;
  std::string message;

 private:
  bool count() { return ++values_ <= most_values; }

  int depth_ = 0;
  std::size_t values_ = 0;
};

/// The package's message without its own name and place, which we give ourselves.
std::string plain_message(const std::string& message) {
  if (message.find("number overflow") != std::string::npos) return "the number is too large for a double";
  const auto start = message.find("syntax error");
  return start == std::string::npos ? "not JSON: " + message : message.substr(start);
}

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

void advance(Place& place, char c) {
  if (c == '\n') {
    ++place.line, place.column = 1;
  } else if (!is_continuation(c)) {
    ++place.column;
  }
}

std::string at(const std::string& file_name, Place place) {
  return file_name + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

/// Walks text whose grammar has been checked.
class Walker {
 public:
  explicit Walker(std::string_view text) : text_(text) {}

  JsonNode value() {
    skip_space();
    JsonNode node;
    node.place = place_;
    node.begin = next_;
    switch (peek()) {
      case '{':
        container(node, JsonKind::object, '}');
        break;
      case '[':
        container(node, JsonKind::list, ']');
        break;
      case '"':
        node.kind = JsonKind::text, node.text = string(node.raw);
        break;
      case 't':
      case 'f':
        node.kind = JsonKind::boolean, node.raw = scalar();
        break;
      case 'n':
        node.kind = JsonKind::null, node.raw = scalar();
        break;
      default:
        node.kind = JsonKind::number, node.raw = scalar();
    }
    node.end = next_;
    return node;
  }

 private:
  char peek() const {
    CTPM_CHECK(next_ < text_.size(), "the walker ran past text that the grammar check accepted");
    return text_[next_];
  }
  char take() {
    const char c = peek();
    advance(place_, c), ++next_;
    return c;
  }
  void skip_space() {
    while (next_ < text_.size() && std::string_view(" \t\r\n").find(text_[next_]) != std::string_view::npos) take();
  }
  std::string scalar() {
    std::string raw;
    while (next_ < text_.size() && std::string_view(" \t\r\n,]}").find(text_[next_]) == std::string_view::npos) {
      raw += take();
    }
    return raw;
  }
  std::string string(std::string& raw) {
    raw = take();
    for (char c = take();; c = take()) {
      raw += c;
      if (c == '\\') {
        raw += take();
      } else if (c == '"') {
        break;
      }
    }
    return nlohmann::json::parse(raw).get<std::string>();
  }
  void container(JsonNode& node, JsonKind kind, char end) {
    node.kind = kind;
    take();
    for (skip_space(); peek() != end; skip_space()) {
      if (peek() == ',') take(), skip_space();
      if (kind == JsonKind::object) {
        node.key_places.push_back(place_);
        std::string raw;
        node.keys.push_back(string(raw));
        skip_space(), take();
      }
      node.children.push_back(value());
    }
    take();
  }

  std::string_view text_;
  std::size_t next_ = 0;
  Place place_;
};

/// Place of the bracket that opens one level too many.
Place too_deep_place(std::string_view text) {
  Place place;
  int depth = 0;
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_in_string) {
      is_in_string = c != '"';
      if (c == '\\') advance(place, text[i++]);
    } else if (c == '"') {
      is_in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > max_depth) break;
    } else if (c == '}' || c == ']') {
      --depth;
    }
    if (i < text.size()) advance(place, text[i]);
  }
  return place;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t limit = 60;
  if (text.size() <= limit) return text;
  std::size_t end = limit;
  while (end > 0 && is_continuation(text[end])) --end;
  return text.substr(0, end) + "...";
}

}  // namespace

const JsonNode* JsonNode::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == key) return &children[i];
  }
  return nullptr;
}

const JsonNode* JsonNode::child(const std::string& part) const {
  if (kind == JsonKind::object) return find(part);
  if (kind != JsonKind::list) return nullptr;
  std::size_t index = 0;
  const auto parsed = std::from_chars(part.data(), part.data() + part.size(), index);
  return parsed.ec == std::errc() && index < children.size() ? &children[index] : nullptr;
}

std::string describe(const JsonNode& node) {
  switch (node.kind) {
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return node.raw;
    case JsonKind::number:
      return "the number " + shortened(node.raw);
    case JsonKind::text:
      return "the text " + in_quotes(shortened(node.text));
    case JsonKind::list:
      return "a list of " + std::to_string(node.children.size());
    case JsonKind::object:
      return "an object";
  }
  return "";
}

Error too_long(const std::string& file_name, std::uintmax_t bytes) {
  return {file_name, "has " + std::to_string(bytes) + " bytes, at most " + std::to_string(kMostTextBytes) + " are read",
          ""};
}

Result<std::string> text_of_file(const std::string& path) {
  std::error_code failure;
  if (!fs::exists(path, failure))
    return Error{path, failure ? "cannot be read: " + failure.message() : "does not exist", ""};
  if (!fs::is_regular_file(path, failure)) return Error{path, "is not a file", ""};
  if (const std::uintmax_t bytes = fs::file_size(path, failure); !failure && bytes > kMostTextBytes)
    return too_long(path, bytes);
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Error{path, std::string("cannot be read: ") + std::strerror(errno), ""};
  return text.str();
}

Result<JsonNode> parse_json(std::string_view commented, const std::string& file_name) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (commented.starts_with(byte_order_mark)) commented.remove_prefix(byte_order_mark.size());

  if (commented.size() > kMostTextBytes) return too_long(file_name, commented.size());
  const std::string text = without_comments(commented);
  GrammarCheck check;
  if (!nlohmann::json::sax_parse(text, &check)) {
    if (check.has_too_many()) return Error{file_name, "holds more than " + std::to_string(most_values) + " values", ""};
    if (check.message.empty())
      return Error{at(file_name, too_deep_place(text)), "nested deeper than " + std::to_string(max_depth) + " levels",
                   ""};
    const std::optional<JsonMistake> mistake = find_json_mistake(text);
    const std::size_t offset = mistake ? mistake->offset : check.offset;
    Place place;
    for (std::size_t i = 0; i < std::min(offset, text.size()); ++i) advance(place, text[i]);
    if (mistake) return Error{at(file_name, place), mistake->message, mistake->hint};
    return Error{at(file_name, place), plain_message(check.message), ""};
  }
  return Walker(text).value();
}

std::string in_quotes(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string child_pointer(const std::string& pointer, std::string_view key) {
  std::string result = pointer + "/";
  for (const char c : key) {
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

std::string child_pointer(const std::string& pointer, std::size_t index) {
  return pointer + "/" + std::to_string(index);
}

double decimal_to_double(std::string_view raw, int exponent) {
  // Split off the exponent that is written, and add ours to it.
  const auto mark = raw.find_first_of("eE");
  std::string text(raw.substr(0, mark));
  long long written = 0;
  if (mark != std::string_view::npos) {
    const char* first = raw.data() + mark + 1;
    const char* last = raw.data() + raw.size();
    const bool is_negative = first < last && *first == '-';
    if (first < last && *first == '+') ++first;
    if (std::from_chars(first, last, written).ec != std::errc()) written = is_negative ? -100000 : 100000;
    written = std::clamp<long long>(written, -100000, 100000);
  }
  text += "e" + std::to_string(written + exponent);

  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) {
    // Both too large and too small end here; the sign of the exponent tells which.
    const bool is_large = written + exponent > 0;
    value = is_large ? std::numeric_limits<double>::infinity() : 0.0;
    if (text.front() == '-') value = -value;
  }
  return value;
}

std::string double_to_decimal(double value, int exponent) {
  CTPM_CHECK(std::isfinite(value), "only finite numbers are written");
  // Shortest digits that give `value` again, as d.ddde+xx.
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
  const std::string_view text(buffer, static_cast<std::size_t>(end - buffer));
  const auto mark = text.find('e');
  std::string digits(text.substr(0, mark));
  const bool is_negative = digits.front() == '-';
  if (is_negative) digits.erase(0, 1);
  if (const auto point = digits.find('.'); point != std::string::npos) digits.erase(point, 1);
  int power = 0;
  const std::size_t sign = text[mark + 1] == '+' ? 1 : 0;
  std::from_chars(text.data() + mark + 1 + sign, text.data() + text.size(), power);
  power -= exponent;

  // Place the point: plainly for everyday numbers, with an exponent for the rest.
  const int count = static_cast<int>(digits.size());
  std::string result = is_negative ? "-" : "";
  if (value == 0) return result + "0";
  if (power >= 15 || power < -5) {
    result += digits.substr(0, 1);
    if (count > 1) result += "." + digits.substr(1);
    return result + "e" + std::to_string(power);
  }
  if (power < 0) return result + "0." + std::string(static_cast<std::size_t>(-power - 1), '0') + digits;
  if (count <= power + 1) return result + digits + std::string(static_cast<std::size_t>(power + 1 - count), '0');
  const auto whole = static_cast<std::size_t>(power + 1);
  return result + digits.substr(0, whole) + "." + digits.substr(whole);
}

}  // namespace ctpm::scenes
