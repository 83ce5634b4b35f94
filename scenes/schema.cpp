#include "scenes/schema.h"

#include <nlohmann/json.hpp>

#include "scenes/course_keys.h"
#include "scenes/field_lister.h"
#include "scenes/presets.h"
#include "scenes/scene_keys.h"
#include "scenes/script_keys.h"
#include "scenes/sweep_keys.h"

namespace ctpm::scenes {
namespace {

using Json = nlohmann::ordered_json;

/// A number as JSON that is printed as short as it can be.
Json number_of(double value) { return Json::parse(double_to_decimal(value, 0)); }

Json ranged(const char* type, const Range& range) {
  Json schema{{"type", type}};
  schema[range.is_low_open ? "exclusiveMinimum" : "minimum"] = number_of(range.low);
  schema[range.is_high_open ? "exclusiveMaximum" : "maximum"] = number_of(range.high);
  return schema;
}

Json point_of(const Range& range) {
  return {{"type", "array"}, {"items", ranged("number", range)}, {"minItems", 3}, {"maxItems", 3}};
}

Json list_of(Json items, std::size_t least) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}};
}

Json record_of(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

Json words_of(const std::vector<std::string>& words) {
  Json schema{{"enum", Json::array()}};
  for (const std::string& word : words) schema["enum"].push_back(Json::parse(word));
  return schema;
}

Json value_of(const FieldRow& row) {
  switch (row.kind) {
    case FieldKind::constant:
      return {{"const", Json::parse(row.words.front())}};
    case FieldKind::text:
      return {{"type", "string"}, {"pattern", "^[^\\u0000-\\u001f\\u007f]+$"}};
    case FieldKind::preset:
      return {{"enum", preset_names()}};
    case FieldKind::number:
      return ranged("number", row.range);
    case FieldKind::integer:
      return ranged("integer", row.range);
    case FieldKind::flag:
      return {{"type", "boolean"}};
    case FieldKind::point:
      return point_of(row.range);
    case FieldKind::points:
      return list_of(point_of(row.range), row.least);
    case FieldKind::values:
      return list_of(
          {{"type", {"number", "string", "boolean", "array"}}, {"items", {{"type", "number"}}}, {"minItems", 1}},
          row.least);
    case FieldKind::choice:
      return words_of(row.words);
    case FieldKind::record:
      return record_of(row.record);
    case FieldKind::list:
      return list_of(record_of(row.record), row.least);
  }
  return {};
}

Json object_of(const RecordRow& record) {
  Json schema{{"description", record.info.meaning}, {"type", "object"}, {"properties", Json::object()}};
  Json required = Json::array();
  for (const FieldRow& row : record.fields) {
    Json value{{"description", row.key.meaning}};
    value.update(value_of(row));
    if (row.key.is_required)
      required.push_back(row.key.name);
    else if (!row.standard.empty())
      value["default"] = Json::parse(row.standard);
    schema["properties"][row.key.name] = std::move(value);
  }
  if (!required.empty()) schema["required"] = std::move(required);
  schema["additionalProperties"] = false;
  if (record.has_exactly_one && record.beside.empty()) schema["minProperties"] = 1, schema["maxProperties"] = 1;
  if (!record.beside.empty())
    for (const FieldRow& row : record.fields)
      if (row.key.name != record.beside) schema["oneOf"].push_back({{"required", Json::array({row.key.name})}});
  return schema;
}

std::string schema_of(const std::vector<RecordRow>& records, const std::string& title) {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  schema.update(object_of(records.front()));
  for (std::size_t i = 1; i < records.size(); ++i) schema["$defs"][records[i].info.name] = object_of(records[i]);
  return schema.dump(2) + "\n";
}

}  // namespace

std::string scene_schema() {
  return schema_of(FieldLister::list_of<SceneSpec>(),
                   std::string(scene_format_name) + " " + std::to_string(scene_format_version));
}

std::string script_schema() {
  return schema_of(FieldLister::list_of<Script>(),
                   std::string(script_format_name) + " " + std::to_string(script_format_version));
}

std::string course_schema() {
  return schema_of(FieldLister::list_of<CourseSpec>(),
                   std::string(course_format_name) + " " + std::to_string(course_format_version));
}

std::string sweep_schema() {
  return schema_of(FieldLister::list_of<SweepSpec>(),
                   std::string(sweep_format_name) + " " + std::to_string(sweep_format_version));
}

}  // namespace ctpm::scenes
