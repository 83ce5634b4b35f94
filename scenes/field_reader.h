#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"
#include "core/model/vec3.h"
#include "scenes/json_text.h"
#include "scenes/key_types.h"
#include "scenes/problems.h"
#include "scenes/sweep.h"

// The visitor that reads: text -> struct, and reports every error with its place. Internal to scenes.
namespace ctpm::scenes {

/// Reports a direction that is too short to be one: below 1e-9, so that its length neither vanishes nor loses
/// digits.
void check_direction(Problems& problems, const std::string& pointer, Vec3 direction);

/// The word of `known` that `word` was probably meant to be; empty if none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// Reads the members of one object. A table calls its methods, one for each field; then finish().
class FieldReader {
 public:
  FieldReader(const JsonNode& object, std::string pointer, Problems& problems)
      : object_(object), pointer_(std::move(pointer)), problems_(problems) {}

  void constant(const Key& key, const char* value);
  void constant(const Key& key, int value);
  void text(const Key& key, std::string& value);
  void preset(const Key& key, std::string& value) { text(key, value); }
  void number(const Key& key, double& value, const Unit& unit, const Range& range);
  void number(const Key& key, std::optional<double>& value, const Unit& unit, const Range& range);
  void flag(const Key& key, bool& value);
  void flag(const Key& key, std::optional<bool>& value);
  void integer(const Key& key, std::int32_t& value, const Range& range);
  void integer(const Key& key, std::optional<std::int32_t>& value, const Range& range);
  void point(const Key& key, Vec3& value, const Unit& unit, const Range& range);
  void point(const Key& key, std::optional<Vec3>& value, const Unit& unit, const Range& range);
  void points(const Key& key, std::vector<Vec3>& value, const Unit& unit, const Range& range, std::size_t least);

  void values(const Key& key, std::vector<SweepValue>& value, std::size_t least);

  template <class E>
  void choice(const Key& key, E& value) {
    std::vector<std::string> names;
    for (const auto& choice : choices_of<E>()) names.emplace_back(choice.name);
    if (const int found = read_choice(key, names); found >= 0)
      value = choices_of<E>()[static_cast<std::size_t>(found)].value;
  }
  template <class T>
  void record(const Key& key, T& value) {
    if (const JsonNode* node = take(key)) read_record(*node, child_pointer(pointer_, key.name), problems_, value);
  }
  template <class T>
  void record(const Key& key, std::optional<T>& value) {
    if (const JsonNode* node = take(key)) {
      read_record(*node, child_pointer(pointer_, key.name), problems_, value.emplace());
    }
  }
  template <class T>
  void list(const Key& key, std::vector<T>& value, std::size_t least) {
    const JsonNode* node = take_list(key, least);
    if (node == nullptr) return;
    const std::string pointer = child_pointer(pointer_, key.name);
    for (std::size_t i = 0; i < node->children.size(); ++i) {
      read_record(node->children[i], child_pointer(pointer, i), problems_, value.emplace_back());
    }
  }

  /// Exactly one of the keys of this object may be given, and perhaps the key `beside` with it.
  void exactly_one(const char* beside = "") { needs_exactly_one_ = true, beside_ = beside; }

  /// Reports unknown and repeated keys.
  void finish();

  template <class T>
  static void read_record(const JsonNode& node, const std::string& pointer, Problems& problems, T& value) {
    if (node.kind != JsonKind::object) {
      problems.add(pointer, node.place, "got " + describe(node) + ", must be an object");
      return;
    }
    FieldReader reader(node, pointer, problems);
    describe_fields(reader, value);
    reader.finish();
  }

 private:
  const JsonNode* take(const Key& key);
  const JsonNode* take_list(const Key& key, std::size_t least);
  int read_choice(const Key& key, const std::vector<std::string>& names);
  bool read_number(const JsonNode& node, const std::string& pointer, const Unit& unit, const Range& range,
                   double& value);
  bool read_point(const JsonNode& node, const std::string& pointer, const Unit& unit, const Range& range, Vec3& value);
  bool read_integer(const JsonNode& node, const std::string& pointer, const Range& range, std::int32_t& value);
  void report_unknown(std::size_t member, const std::vector<std::string>& names);

  struct KnownKey {
    std::string name;
    bool is_required;
  };
  const JsonNode& object_;
  std::string pointer_;
  Problems& problems_;
  std::vector<KnownKey> known_;
  bool needs_exactly_one_ = false;
  std::string beside_;
};

}  // namespace ctpm::scenes
