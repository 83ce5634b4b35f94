#include "studio/output/printable.h"

#include <cstdint>
#include <cstdio>

namespace ctpm::output {
namespace {

struct Letter {
  std::uint32_t code = 0;
  std::size_t size = 0;  ///< bytes; 0: no UTF-8
};

/// The letter at the start of `text`, which is not empty.
Letter first_letter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::size_t size = byte(0) < 0x80       ? 1
                           : byte(0) >> 5 == 6  ? 2
                           : byte(0) >> 4 == 14 ? 3
                           : byte(0) >> 3 == 30 ? 4
                                                : 0;
  if (size <= 1) return {byte(0), size};
  if (text.size() < size) return {};
  std::uint32_t code = byte(0) & (0x7f >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if (byte(i) >> 6 != 2) return {};
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  return code < least[size] || code > 0x10ffff ? Letter{} : Letter{code, size};
}

bool is_control(std::uint32_t code) {
  const bool turns = code == 0x200e || code == 0x200f || code == 0x61c || (code >= 0x202a && code <= 0x202e) ||
                     (code >= 0x2066 && code <= 0x2069);
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029 || turns;
}

}  // namespace

std::string printable(std::string_view text, bool lines) {
  std::string shown;
  while (!text.empty()) {
    const Letter letter = first_letter(text);
    const std::size_t size = letter.size == 0 ? 1 : letter.size;
    if (letter.size > 0 && (!is_control(letter.code) || (lines && letter.code == '\n'))) {
      shown += text.substr(0, size);
    } else {
      char code[16];
      if (size == 1)
        std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(static_cast<std::uint8_t>(text[0])));
      else
        std::snprintf(code, sizeof code, "\\u{%04x}", static_cast<unsigned>(letter.code));
      shown += code;
    }
    text.remove_prefix(size);
  }
  return shown;
}

std::string json_string(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const Letter letter = first_letter(text);
    const std::size_t size = letter.size == 0 ? 1 : letter.size;
    const std::uint32_t code = letter.size == 0 ? 0xfffd : letter.code;
    if (letter.size == 0 || is_control(code)) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(code));
      json += escaped;
    } else {
      if (code == '"' || code == '\\') json += '\\';
      json += text.substr(0, size);
    }
    text.remove_prefix(size);
  }
  return json + "\"";
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string shell_word(const std::string& text) {
  constexpr const char* kSafe = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./:,+@%";
  if (!text.empty() && text.find_first_not_of(kSafe) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace ctpm::output
