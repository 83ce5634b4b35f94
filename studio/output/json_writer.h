#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "studio/output/printable.h"

namespace ctpm::output {

/// Writes JSON for programs. Numbers keep all digits; non-finite numbers become null.
class JsonWriter {
 public:
  JsonWriter& begin_object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_list() { return open('['); }
  JsonWriter& end_list() { return close(']'); }

  JsonWriter& key(std::string_view name) {
    separate();
    write_text(name);
    text_ += ": ";
    after_key_ = true;
    return *this;
  }
  JsonWriter& value(std::string_view text) { return separate(), write_text(text), *this; }
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(bool flag) { return raw(flag ? "true" : "false"); }
  JsonWriter& value(std::int64_t number) { return raw(std::to_string(number)); }
  JsonWriter& value(std::int32_t number) { return raw(std::to_string(number)); }
  JsonWriter& value(std::size_t number) { return raw(std::to_string(number)); }
  JsonWriter& value(double number) {
    if (!std::isfinite(number)) return raw("null");
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.17g", number);
    return raw(digits);
  }
  JsonWriter& null() { return raw("null"); }
  template <class T>
  JsonWriter& member(std::string_view name, const T& v) {
    return key(name), value(v);
  }

  /// The finished document, with a newline at its end.
  std::string text() const { return text_ + "\n"; }

 private:
  JsonWriter& open(char bracket) {
    separate();
    text_ += bracket;
    ++depth_;
    is_first_ = true;
    return *this;
  }
  JsonWriter& close(char bracket) {
    --depth_;
    if (!is_first_) new_line();
    text_ += bracket;
    is_first_ = false;
    return *this;
  }
  JsonWriter& raw(std::string_view word) {
    separate();
    text_ += word;
    return *this;
  }
  void separate() {
    if (after_key_) {
      after_key_ = false;
      return;
    }
    if (depth_ == 0) return;
    if (!is_first_) text_ += ',';
    new_line();
    is_first_ = false;
  }
  void new_line() { text_.append("\n").append(std::size_t(2 * depth_), ' '); }
  void write_text(std::string_view text) { text_ += json_string(text); }

  std::string text_;
  int depth_ = 0;
  bool is_first_ = true, after_key_ = false;
};

}  // namespace ctpm::output
