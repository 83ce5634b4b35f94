#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/vec3.h"
#include "scenes/json_text.h"
#include "scenes/key_types.h"

// The visitor that writes: struct -> text, in the order of the table. Internal to scenes.
namespace ctpm::scenes {

/// Writes the members of one object. Values that equal the struct's default are written all the same where
/// they are plain, so that an author sees what can be changed; unset optional values, empty lists and empty
/// texts are left out.
class FieldWriter {
 public:
  explicit FieldWriter(int depth) : depth_(depth) {}

  void constant(const Key& key, const char* value) { member(key, in_quotes(value)); }
  void constant(const Key& key, int value) { member(key, std::to_string(value)); }
  void text(const Key& key, const std::string& value) {
    if (!value.empty()) member(key, in_quotes(value));
  }
  void preset(const Key& key, const std::string& value) { text(key, value); }
  void number(const Key& key, double value, const Unit& unit, const Range&) {
    member(key, double_to_decimal(value, unit.exponent));
  }
  void number(const Key& key, const std::optional<double>& value, const Unit& unit, const Range& range) {
    if (value) number(key, *value, unit, range);
  }
  void integer(const Key& key, std::int32_t value, const Range&) { member(key, std::to_string(value)); }
  void integer(const Key& key, const std::optional<std::int32_t>& value, const Range& range) {
    if (value) integer(key, *value, range);
  }
  void flag(const Key& key, const std::optional<bool>& value) {
    if (value) flag(key, *value);
  }
  void flag(const Key& key, bool value) { member(key, value ? "true" : "false"); }
  void point(const Key& key, const Vec3& value, const Unit& unit, const Range&) {
    member(key, point_text(value, unit));
  }
  void point(const Key& key, const std::optional<Vec3>& value, const Unit& unit, const Range& range) {
    if (value) point(key, *value, unit, range);
  }
  void points(const Key& key, const std::vector<Vec3>& value, const Unit& unit, const Range&, std::size_t) {
    if (value.empty()) return;
    std::vector<std::string> items;
    for (const Vec3& p : value) items.push_back(point_text(p, unit));
    member(key, list_text(items));
  }
  template <class E>
  void choice(const Key& key, E value) {
    for (const auto& choice : choices_of<E>())
      if (choice.value == value) member(key, in_quotes(choice.name));
  }
  template <class T>
  void record(const Key& key, T& value) {
    if (const std::string text = record_text(value, depth_ + 1); text != "{}") member(key, text);
  }
  template <class T>
  void record(const Key& key, std::optional<T>& value) {
    if (value) member(key, record_text(*value, depth_ + 1));
  }
  template <class T>
  void list(const Key& key, std::vector<T>& value, std::size_t) {
    if (value.empty()) return;
    std::vector<std::string> items;
    for (T& item : value) items.push_back(record_text(item, depth_ + 2));
    member(key, list_text(items));
  }
  void exactly_one(const char* = "") {}

  /// The object's text. Short ones stand on one line.
  std::string text() const;

  template <class T>
  static std::string record_text(T& value, int depth) {
    FieldWriter writer(depth);
    describe_fields(writer, value);
    return writer.text();
  }

 private:
  void member(const Key& key, const std::string& value) { members_.push_back(in_quotes(key.name) + ": " + value); }
  static std::string point_text(const Vec3& p, const Unit& unit) {
    return "[" + double_to_decimal(p.x, unit.exponent) + ", " + double_to_decimal(p.y, unit.exponent) + ", " +
           double_to_decimal(p.z, unit.exponent) + "]";
  }
  std::string list_text(const std::vector<std::string>& items) const;

  int depth_;
  std::vector<std::string> members_;
};

}  // namespace ctpm::scenes
