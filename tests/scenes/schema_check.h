#pragma once

#include <algorithm>
#include <string>

#include "scenes/json_text.h"

// A validator for the part of JSON Schema that the schemas of this project use; an unknown word in a schema
// is a problem.
namespace ctpm {

class SchemaCheck {
 public:
  explicit SchemaCheck(const std::string& schema) : schema_(parsed(schema)) {}

  /// Where and why a text does not fit; empty if it fits.
  std::string problem_of(const std::string& text) const { return problem(schema_, parsed(text), ""); }

 private:
  static scenes::JsonNode parsed(const std::string& text) {
    Result<scenes::JsonNode> node = scenes::parse_json(text, "text");
    CTPM_CHECK(bool(node), node ? "" : to_string(node.errors().front()).c_str());
    return *node;
  }
  static double number(const scenes::JsonNode& node) { return scenes::decimal_to_double(node.raw, 0); }
  static bool are_equal(const scenes::JsonNode& a, const scenes::JsonNode& b) {
    return a.kind == b.kind &&
           (a.kind == scenes::JsonKind::number ? number(a) == number(b) : a.text == b.text && a.raw == b.raw);
  }
  static bool has_type(const scenes::JsonNode& node, const std::string& type) {
    switch (node.kind) {
      case scenes::JsonKind::null:
        return type == "null";
      case scenes::JsonKind::boolean:
        return type == "boolean";
      case scenes::JsonKind::number:
        return type == "number" || (type == "integer" && number(node) == double((long long)number(node)));
      case scenes::JsonKind::text:
        return type == "string";
      case scenes::JsonKind::list:
        return type == "array";
      case scenes::JsonKind::object:
        return type == "object";
    }
    return false;
  }

  std::string problem(const scenes::JsonNode& schema, const scenes::JsonNode& value, const std::string& at) const {
    for (std::size_t i = 0; i < schema.keys.size(); ++i)
      if (const std::string found = problem_with(schema.keys[i], schema.children[i], schema, value, at); !found.empty())
        return found;
    return "";
  }

  std::string problem_with(const std::string& word, const scenes::JsonNode& rule, const scenes::JsonNode& schema,
                           const scenes::JsonNode& value, const std::string& at) const {
    const auto unless = [&](bool fits) { return fits ? "" : at + ": " + word; };
    const bool is_number = value.kind == scenes::JsonKind::number, is_list = value.kind == scenes::JsonKind::list;
    const double count = double(value.children.size());
    if (word == "oneOf")
      return unless(std::count_if(rule.children.begin(), rule.children.end(),
                                  [&](const scenes::JsonNode& one) { return problem(one, value, at).empty(); }) == 1);
    if (word == "$schema" || word == "title" || word == "description" || word == "default" || word == "$defs")
      return "";
    if (word == "type" && rule.kind == scenes::JsonKind::list)
      return unless(std::any_of(rule.children.begin(), rule.children.end(),
                                [&](const scenes::JsonNode& type) { return has_type(value, type.text); }));
    if (word == "type") return unless(has_type(value, rule.text));
    if (word == "const") return unless(are_equal(rule, value));
    if (word == "enum")
      return unless(std::any_of(rule.children.begin(), rule.children.end(),
                                [&](const scenes::JsonNode& w) { return are_equal(w, value); }));
    if (word == "pattern") return unless(!value.text.empty());  // the one pattern: a line that is not empty
    if (word == "minimum") return unless(!is_number || number(value) >= number(rule));
    if (word == "maximum") return unless(!is_number || number(value) <= number(rule));
    if (word == "exclusiveMinimum") return unless(!is_number || number(value) > number(rule));
    if (word == "exclusiveMaximum") return unless(!is_number || number(value) < number(rule));
    if (word == "minItems") return unless(!is_list || count >= number(rule));
    if (word == "minProperties") return unless(count >= number(rule));
    if (word == "maxItems" || word == "maxProperties") return unless(count <= number(rule));
    if (word == "required")
      return unless(std::all_of(rule.children.begin(), rule.children.end(),
                                [&](const scenes::JsonNode& key) { return value.find(key.text) != nullptr; }));
    if (word == "$ref") {
      const scenes::JsonNode* target = schema_.find("$defs")->find(rule.text.substr(std::string("#/$defs/").size()));
      return target == nullptr ? at + ": no " + rule.text : problem(*target, value, at);
    }
    if (word == "items") {
      for (std::size_t i = 0; is_list && i < value.children.size(); ++i)
        if (const std::string found = problem(rule, value.children[i], scenes::child_pointer(at, i)); !found.empty())
          return found;
      return "";
    }
    if (word == "properties") {
      for (std::size_t i = 0; i < value.keys.size(); ++i)
        if (const scenes::JsonNode* of_key = rule.find(value.keys[i]))
          if (const std::string found = problem(*of_key, value.children[i], scenes::child_pointer(at, value.keys[i]));
              !found.empty())
            return found;
      return "";
    }
    if (word == "additionalProperties")  // false everywhere
      return unless(std::all_of(value.keys.begin(), value.keys.end(), [&](const std::string& key) {
        return schema.find("properties")->find(key) != nullptr;
      }));
    return "the schema has a word that is not known here: " + word;
  }

  scenes::JsonNode schema_;
};

}  // namespace ctpm
