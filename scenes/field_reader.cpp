#include "scenes/field_reader.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ctpm::scenes {
namespace {

std::string plain_number(double value) { return double_to_decimal(value, 0); }

/// Number of letters to change, add, drop or swap to turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

/// The key without the unit at its end: "spring_kpa_per_mm" -> "spring".
std::string without_unit(std::string_view key) {
  static constexpr std::string_view parts[] = {
      "mm", "cm", "um", "m",   "km",  "in", "inch", "kpa", "pa",  "mpa", "s",   "ms", "us",  "n",   "mn", "kn",
      "kg", "g",  "m3", "mm3", "mm2", "m2", "s2",   "deg", "rad", "per", "cm3", "hz", "sec", "pas", "min"};
  for (;;) {
    const auto mark = key.rfind('_');
    if (mark == std::string_view::npos) return std::string(key);
    if (std::find(std::begin(parts), std::end(parts), key.substr(mark + 1)) == std::end(parts)) return std::string(key);
    key = key.substr(0, mark);
  }
}

/// The word in lower case with '-' and ' ' as '_'.
std::string normal_form(std::string_view word) {
  std::string result(word);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-' || c == ' ') c = '_';
  }
  return result;
}

}  // namespace

std::string to_string(const Range& range) {
  return (range.is_low_open ? "(" : "[") + plain_number(range.low) + ", " + plain_number(range.high) +
         (range.is_high_open ? ")" : "]");
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::string::npos;
  const std::string normal = normal_form(word.substr(0, 100));
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(normal, normal_form(candidate));
    if (distance < best_distance) best = candidate, best_distance = distance;
  }
  return best_distance <= std::max<std::size_t>(2, normal.size() / 3) ? best : "";
}

void check_direction(Problems& problems, const std::string& pointer, Vec3 direction) {
  if (norm(direction) < 1e-9) problems.add_rule(pointer, "must not be zero, or shorter than 1e-9");
}

const JsonNode* FieldReader::take(const Key& key) {
  known_.push_back({key.name, key.is_required});
  return object_.find(key.name);
}

const JsonNode* FieldReader::take_list(const Key& key, std::size_t least) {
  const JsonNode* node = take(key);
  if (node == nullptr) return nullptr;
  const std::string pointer = child_pointer(pointer_, key.name);
  if (node->kind != JsonKind::list) {
    problems_.add(pointer, node->place, "got " + describe(*node) + ", must be a list");
    return nullptr;
  }
  if (node->children.size() < least) {
    problems_.add(pointer, node->place, "got " + describe(*node) + ", must have at least " + std::to_string(least));
  }
  return node;
}

void FieldReader::constant(const Key& key, const char* value) {
  static const std::map<std::string, std::string> kOthers{{"ctpm-scene", "a scene"},
                                                          {"ctpm-script", "a script"},
                                                          {"ctpm-course", "a course"},
                                                          {"ctpm-sweep", "a sweep"},
                                                          {"ctpm-materials", "materials"}};
  const JsonNode* node = take(key);
  if (node == nullptr || (node->kind == JsonKind::text && node->text == value)) return;
  const std::string pointer = child_pointer(pointer_, key.name), must = ", must be " + in_quotes(value);
  const auto other = node->kind == JsonKind::text ? kOthers.find(node->text) : kOthers.end();
  if (other == kOthers.end())
    problems_.add(pointer, node->place, "got " + describe(*node) + must);
  else  // its keys are none of these
    problems_.add_only(pointer, node->place, "got " + describe(*node) + must, "this file holds " + other->second);
}

void FieldReader::constant(const Key& key, int value) {
  const JsonNode* node = take(key);
  if (node == nullptr || (node->kind == JsonKind::number && node->raw == std::to_string(value))) return;
  problems_.add(child_pointer(pointer_, key.name), node->place,
                "got " + describe(*node) + ", must be " + std::to_string(value),
                "this program knows version " + std::to_string(value) + " only");
}

void FieldReader::text(const Key& key, std::string& value) {
  const JsonNode* node = take(key);
  if (node == nullptr) return;
  const std::string pointer = child_pointer(pointer_, key.name);
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (node->kind != JsonKind::text) {
    problems_.add(pointer, node->place, "got " + describe(*node) + ", must be a text");
  } else if (node->text.empty() || std::any_of(node->text.begin(), node->text.end(), is_control)) {
    problems_.add(pointer, node->place, "got " + describe(*node) + ", must be one line and not empty");
  } else {
    value = node->text;
  }
}

bool FieldReader::read_number(const JsonNode& node, const std::string& pointer, const Unit& unit, const Range& range,
                              double& value) {
  const std::string of_unit = unit.name[0] == '\0' ? "" : std::string(" ") + unit.name;
  if (node.kind != JsonKind::number) {
    problems_.add(pointer, node.place, "got " + describe(node) + ", must be a number in " + to_string(range) + of_unit);
    return false;
  }
  if (!range.contains(decimal_to_double(node.raw, 0))) {
    problems_.add(pointer, node.place, "got " + node.raw + ", must be in " + to_string(range) + of_unit);
    return false;
  }
  value = decimal_to_double(node.raw, unit.exponent);
  return true;
}

void FieldReader::number(const Key& key, double& value, const Unit& unit, const Range& range) {
  if (const JsonNode* node = take(key)) read_number(*node, child_pointer(pointer_, key.name), unit, range, value);
}

void FieldReader::number(const Key& key, std::optional<double>& value, const Unit& unit, const Range& range) {
  double got = 0;
  const JsonNode* node = take(key);
  if (node != nullptr && read_number(*node, child_pointer(pointer_, key.name), unit, range, got)) value = got;
}

bool FieldReader::read_integer(const JsonNode& node, const std::string& pointer, const Range& range,
                               std::int32_t& value) {
  const bool is_whole = node.kind == JsonKind::number && node.raw.find_first_of(".eE") == std::string::npos;
  if (!is_whole) {
    problems_.add(pointer, node.place, "got " + describe(node) + ", must be a whole number in " + to_string(range));
    return false;
  }
  if (!range.contains(decimal_to_double(node.raw, 0))) {
    problems_.add(pointer, node.place, "got " + node.raw + ", must be in " + to_string(range));
    return false;
  }
  value = static_cast<std::int32_t>(decimal_to_double(node.raw, 0));
  return true;
}

void FieldReader::integer(const Key& key, std::int32_t& value, const Range& range) {
  if (const JsonNode* node = take(key)) read_integer(*node, child_pointer(pointer_, key.name), range, value);
}

void FieldReader::integer(const Key& key, std::optional<std::int32_t>& value, const Range& range) {
  std::int32_t got = 0;
  const JsonNode* node = take(key);
  if (node != nullptr && read_integer(*node, child_pointer(pointer_, key.name), range, got)) value = got;
}

bool FieldReader::read_point(const JsonNode& node, const std::string& pointer, const Unit& unit, const Range& range,
                             Vec3& value) {
  if (node.kind != JsonKind::list || node.children.size() != 3) {
    problems_.add(pointer, node.place, "got " + describe(node) + ", must be a list of 3 numbers");
    return false;
  }
  double got[3] = {};
  bool is_good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    is_good &= read_number(node.children[i], child_pointer(pointer, i), unit, range, got[i]);
  }
  if (is_good) value = {got[0], got[1], got[2]};
  return is_good;
}

void FieldReader::flag(const Key& key, bool& value) {
  std::optional<bool> got;
  flag(key, got);
  value = got.value_or(value);
}

void FieldReader::flag(const Key& key, std::optional<bool>& value) {
  const JsonNode* node = take(key);
  if (node == nullptr) return;
  if (node->kind == JsonKind::boolean)
    value = node->raw == "true";
  else
    problems_.add(child_pointer(pointer_, key.name), node->place, "got " + describe(*node) + ", must be true or false");
}

void FieldReader::point(const Key& key, Vec3& value, const Unit& unit, const Range& range) {
  if (const JsonNode* node = take(key)) read_point(*node, child_pointer(pointer_, key.name), unit, range, value);
}

void FieldReader::point(const Key& key, std::optional<Vec3>& value, const Unit& unit, const Range& range) {
  Vec3 got;
  const JsonNode* node = take(key);
  if (node != nullptr && read_point(*node, child_pointer(pointer_, key.name), unit, range, got)) value = got;
}

void FieldReader::points(const Key& key, std::vector<Vec3>& value, const Unit& unit, const Range& range,
                         std::size_t least) {
  const JsonNode* node = take_list(key, least);
  if (node == nullptr) return;
  const std::string pointer = child_pointer(pointer_, key.name);
  for (std::size_t i = 0; i < node->children.size(); ++i) {
    read_point(node->children[i], child_pointer(pointer, i), unit, range, value.emplace_back());
  }
}

int FieldReader::read_choice(const Key& key, const std::vector<std::string>& names) {
  const JsonNode* node = take(key);
  if (node == nullptr) return -1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (node->kind == JsonKind::text && node->text == names[i]) return static_cast<int>(i);
  }
  std::string allowed;
  for (const std::string& name : names) allowed += (allowed.empty() ? "" : ", ") + in_quotes(name);
  std::string hint = node->kind == JsonKind::text ? nearest_word(node->text, names) : "";
  if (!hint.empty()) hint = "did you mean " + in_quotes(hint) + "?";
  problems_.add(child_pointer(pointer_, key.name), node->place,
                "got " + describe(*node) + ", must be one of " + allowed, hint);
  return -1;
}

void FieldReader::report_unknown(std::size_t member, const std::vector<std::string>& names) {
  const std::string& key = object_.keys[member];
  const std::string pointer = child_pointer(pointer_, key);
  if (problems_.is_full()) return problems_.add(pointer, {}, "");  // only counted: searching for hints takes time
  std::string hint, meant;
  // The right name with the wrong unit, or with none.
  for (const std::string& name : names) {
    if (meant.empty() && without_unit(name) == without_unit(normal_form(key))) {
      meant = name;
      hint = "the key is " + in_quotes(name) + (without_unit(name) == name ? "" : ": the unit is part of it");
    }
  }
  if (const std::string nearest = nearest_word(key, names); meant.empty() && !nearest.empty()) {
    meant = nearest;
    hint = "did you mean " + in_quotes(nearest) + "?";
  }
  if (meant.empty()) {
    for (const std::string& name : names) hint += (hint.empty() ? "known here: " : ", ") + name;
  }
  // The key that was meant counts as refused, so that no later stage misses it.
  problems_.add(pointer, object_.key_places[member], "unknown key " + in_quotes(key), hint,
                meant.empty() ? pointer : child_pointer(pointer_, meant));
}

void FieldReader::finish() {
  std::vector<std::string> names, written;
  for (const KnownKey& known : known_) names.push_back(known.name);
  std::map<std::string_view, std::size_t> first_of;
  for (std::size_t i = 0; i < object_.keys.size(); ++i) {
    const std::string& key = object_.keys[i];
    if (const std::size_t first = first_of.emplace(key, i).first->second; first != i) {
      problems_.add(child_pointer(pointer_, key), object_.key_places[i],
                    "the key " + in_quotes(key) + " is given twice",
                    "first in line " + std::to_string(object_.key_places[first].line));
    } else if (std::find(names.begin(), names.end(), key) == names.end()) {
      report_unknown(i, names);
    } else {
      written.push_back(key);
    }
  }
  for (const KnownKey& known : known_) {
    if (known.is_required && object_.find(known.name) == nullptr) {
      problems_.add(pointer_, object_.place, "the key " + in_quotes(known.name) + " is missing", "",
                    child_pointer(pointer_, known.name));
    }
  }
  std::erase(written, beside_);
  if (needs_exactly_one_ && written.size() != 1) {
    std::string allowed;
    for (const std::string& name : names)
      if (name != beside_) allowed += (allowed.empty() ? "" : ", ") + name;
    problems_.add(pointer_, object_.place,
                  "got " + std::to_string(written.size()) + " of the keys, must have exactly one of " + allowed);
  }
}

}  // namespace ctpm::scenes
