#include "scenes/json_words.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace ctpm::scenes {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '+' || c == '-' || c == '.' ||
         (static_cast<unsigned char>(c) & 0x80) != 0;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether the word is a number as JSON writes it: -? (0 | [1-9] digits) (. digits)? ([eE] [+-]? digits)?
bool is_number(std::string_view word) {
  std::size_t at = 0;
  const auto digits = [&] {
    const std::size_t begin = at;
    while (at < word.size() && is_digit(word[at])) ++at;
    return at > begin;
  };
  if (at < word.size() && word[at] == '-') ++at;
  const bool is_zero_first = at < word.size() && word[at] == '0';
  const std::size_t begin = at;
  if (!digits() || (is_zero_first && at > begin + 1)) return false;
  if (at < word.size() && word[at] == '.')
    if (++at; !digits()) return false;
  if (at < word.size() && (word[at] == 'e' || word[at] == 'E')) {
    ++at;
    if (at < word.size() && (word[at] == '+' || word[at] == '-')) ++at;
    if (!digits()) return false;
  }
  return at == word.size();
}

std::size_t line_of(std::string_view text, std::size_t offset) {
  return 1 + std::size_t(std::count(text.begin(), text.begin() + std::ptrdiff_t(offset), '\n'));
}

class MistakeFinder {
 public:
  explicit MistakeFinder(std::string_view text) : text_(text) {}

  std::optional<JsonMistake> find() {
    if (skip_space(); is_at_end()) return mistake("the text is empty", "it should begin with {");
    if (text_.starts_with("SQLite format 3"))
      return mistake("this is a recorded session, or another database, and no text", "");
    // No text of any encoding that is read holds zeros, and what is said about single letters would help nobody.
    if (text_.find('\0') != std::string_view::npos) return mistake("this is no text", "");
    enum class Wanted { value, first_value, key, first_key, more, nothing } wanted = Wanted::value;
    const auto after_value = [&] { return open_.empty() ? Wanted::nothing : Wanted::more; };
    for (skip_space();; skip_space()) {
      if (is_at_end()) return wanted == Wanted::nothing ? std::optional<JsonMistake>() : too_short();
      const char c = text_[at_];
      if (wanted == Wanted::nothing) return mistake("something follows the end of the text", "remove it");
      if (wanted == Wanted::more) {
        if (c == ',') {
          comma_ = at_++;
          wanted = is_object() ? Wanted::key : Wanted::value;
          continue;
        }
        if (c == '}' || c == ']') {
          if (auto wrong = close(c)) return wrong;
          wanted = after_value();
          continue;
        }
        if (c == ':') return mistake("there is a : too many", is_object() ? "" : "a list in [ ] has no keys");
        return mistake("a comma is missing before " + shown(), "");
      }
      if ((c == '}' || c == ']') && (wanted == Wanted::first_key || wanted == Wanted::first_value)) {
        if (auto wrong = close(c)) return wrong;
        wanted = after_value();
        continue;
      }
      if ((c == '}' || c == ']') && comma_ != std::string_view::npos && !after_colon_) {
        at_ = comma_;
        return mistake("this comma is one too many: nothing follows it but " + std::string(1, c), "remove it");
      }
      if ((c == '}' || c == ']') && after_colon_) return mistake("the key " + key_ + " has no value", "");
      if (c == ',') return mistake("there is a comma too many, or nothing before it", "");
      if (wanted == Wanted::key || wanted == Wanted::first_key) {
        if (c != '"') return mistake("a key in double quotes must stand here, not " + shown(), quotes_hint());
        if (auto wrong = take_string()) return wrong;
        skip_space();
        if (is_at_end()) return too_short();
        if (text_[at_] != ':')
          return mistake("a : is missing between the key " + key_ + " and its value",
                         text_[at_] == '=' ? "write : for =" : "");
        ++at_, after_colon_ = true;
        wanted = Wanted::value;
        continue;
      }
      after_colon_ = false;
      if (c == '{' || c == '[') {
        open_.push_back(at_++);
        wanted = c == '{' ? Wanted::first_key : Wanted::first_value;
        continue;
      }
      if (auto wrong = c == '"' ? take_string() : take_scalar()) return wrong;
      wanted = after_value();
    }
  }

 private:
  bool is_at_end() const { return at_ >= text_.size(); }
  bool is_object() const { return !open_.empty() && text_[open_.back()] == '{'; }
  void skip_space() {
    while (!is_at_end() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }

  JsonMistake mistake(std::string message, std::string hint) const {
    return {at_, std::move(message), std::move(hint)};
  }

  /// What stands here, for messages.
  std::string shown() const {
    std::size_t end = at_;
    while (end < text_.size() && is_word(text_[end]) && end < at_ + 40) ++end;
    if (end == at_) return std::string(text_.substr(at_, 1));
    return std::string(text_.substr(at_, end - at_));
  }

  std::string quotes_hint() const {
    if (text_[at_] == '\'') return "texts stand in double quotes, not in single ones";
    for (const std::string_view curly : {"\u201c", "\u201d", "\u201e", "\u00ab", "\u00bb"})
      if (text_.substr(at_).starts_with(curly)) return "texts stand in straight double quotes, not in curly ones";
    const auto is_digit = [&](std::size_t at) { return text_[at] >= '0' && text_[at] <= '9'; };
    if (at_ >= 2 && is_digit(at_) && text_[at_ - 1] == ',' && is_digit(at_ - 2))
      return "numbers have a point, not a comma";
    return is_word(text_[at_]) ? "write \"" + shown() + "\"" : "";
  }

  JsonMistake too_short() const {
    JsonMistake end{text_.size(), "the text ends too early", ""};
    if (!open_.empty()) {
      const char open = text_[open_.back()];
      end.hint = std::string("the ") + open + " of line " + std::to_string(line_of(text_, open_.back())) + " has no " +
                 (open == '{' ? "}" : "]");
    }
    return end;
  }

  std::optional<JsonMistake> close(char c) {
    const char open = text_[open_.back()], right = open == '{' ? '}' : ']';
    if (c != right)
      return mistake(std::string("got ") + c + ", but the " + open + " of line " +
                         std::to_string(line_of(text_, open_.back())) + " needs " + right,
                     "");
    open_.pop_back(), ++at_;
    return std::nullopt;
  }

  std::optional<JsonMistake> take_string() {
    const std::size_t begin = at_++;
    for (; !is_at_end() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\n' || text_[at_] == '\r') {
        at_ = begin;
        return mistake("this text has no closing quote in its line", "a text cannot go over two lines");
      }
      if (text_[at_] != '\\') continue;
      ++at_;
      for (std::size_t digit = 1; !is_at_end() && text_[at_] == 'u' && digit <= 4; ++digit)
        if (at_ + digit >= text_.size() || !std::isxdigit(static_cast<unsigned char>(text_[at_ + digit])))
          return mistake("\\u needs four hexadecimal digits", "");
      if (!is_at_end() && std::string_view("\"\\/bfnrtu").find(text_[at_]) == std::string_view::npos)
        return mistake("\\" + shown().substr(0, 1) + " has no meaning in a text",
                       "write \\\\ for a backslash, and / in paths");
    }
    if (is_at_end()) {
      at_ = begin;
      return mistake("this text has no closing quote", "");
    }
    ++at_;
    key_ = std::string(text_.substr(begin, std::min<std::size_t>(at_ - begin, 60)));
    return std::nullopt;
  }

  std::optional<JsonMistake> take_scalar() {
    std::size_t end = at_;
    while (end < text_.size() && is_word(text_[end])) ++end;
    const std::string word(text_.substr(at_, end - at_));
    if (word == "true" || word == "false" || word == "null" || is_number(word)) {
      at_ = end;
      return std::nullopt;
    }
    const std::string got = shown();
    if (text_[at_] == '\'') return mistake("texts stand in double quotes, not in single ones", "");
    if (word.empty()) return mistake("a value must stand here, not " + got, "");
    std::string low = word;
    std::transform(low.begin(), low.end(), low.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (low == "true" || low == "false" || low == "null")
      return mistake("got " + got, "write " + low + ", in small letters");
    const std::string_view sign = "+-";
    const std::string bare = sign.find(low[0]) != std::string_view::npos ? low.substr(1) : low;
    if (bare == "nan" || bare.starts_with("inf")) return mistake(got + " is not a number that a file can hold", "");
    if (is_digit(bare.empty() ? 'x' : bare[0]) || bare.starts_with('.')) {
      std::string hint = "numbers are written like 12, -0.5 or 1e-3";
      const std::size_t rest = at_ + word.size();
      if (rest + 1 < text_.size() && text_[rest] == ',' && is_digit(text_[rest + 1]))
        hint += "; a decimal point, no comma";
      return mistake(got + " is not a number as JSON writes it", hint);
    }
    return mistake("got " + got + ", which is neither a number nor a text",
                   "texts stand in double quotes: \"" + got + "\"");
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t comma_ = std::string_view::npos;
  bool after_colon_ = false;
  std::string key_;
  std::vector<std::size_t> open_;  ///< offsets of the brackets that are open
};

}  // namespace

std::optional<JsonMistake> find_json_mistake(std::string_view text) { return MistakeFinder(text).find(); }

std::string without_comments(std::string_view text, std::vector<std::size_t>* origin) {
  std::string plain;
  plain.reserve(text.size());
  const auto keep = [&](char c, std::size_t from) {
    plain += c;
    if (origin != nullptr) origin->push_back(from);
  };
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
    if (is_in_string) {
      is_in_string = c != '"' && c != '\n';
      keep(c, i);
      if (c == '\\' && i + 1 < text.size()) ++i, keep(text[i], i);
      continue;
    }
    is_in_string = c == '"';
    const std::size_t end = c != '/'      ? std::string_view::npos
                            : next == '/' ? std::min(text.find('\n', i), text.size())
                            : next == '*' ? text.find("*/", i + 2)
                                          : std::string_view::npos;
    if (end == std::string_view::npos) {
      keep(c, i);
      continue;
    }
    // A column is a character: bytes that go on with one take no space.
    const std::size_t last = next == '/' ? end : end + 2;
    for (; i < last; ++i)
      if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80)
        keep(text[i] == '\n' || text[i] == '\r' ? text[i] : ' ', i);
    --i;
  }
  if (origin != nullptr) origin->push_back(text.size());
  return plain;
}

}  // namespace ctpm::scenes
