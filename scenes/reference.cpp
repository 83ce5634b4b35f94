#include "scenes/course_keys.h"
#include "scenes/field_lister.h"
#include "scenes/presets.h"
#include "scenes/scene_keys.h"
#include "scenes/schema.h"
#include "scenes/script_keys.h"
#include "scenes/sweep_keys.h"

// The documentation tables.
namespace ctpm::scenes {
namespace {

std::string in_code(const std::string& text) { return "`" + text + "`"; }

std::string range_of(const FieldRow& row) {
  const std::string unit = row.unit.name;
  return "in " + to_string(row.range) + (unit.empty() ? "" : " " + unit);
}

std::string link_to(const std::string& record) { return "[" + record + "](#" + record + ")"; }

std::string at_least(std::size_t count) { return count == 0 ? "" : ", at least " + std::to_string(count); }

std::string value_of(const FieldRow& row) {
  switch (row.kind) {
    case FieldKind::constant:
      return in_code(row.words.front());
    case FieldKind::text:
      return "text of one line";
    case FieldKind::preset:
      return "name of a preset, see below";
    case FieldKind::number:
      return "number " + range_of(row);
    case FieldKind::integer:
      return "whole number " + range_of(row);
    case FieldKind::flag:
      return "`true` or `false`";
    case FieldKind::point:
      return "three numbers, each " + range_of(row);
    case FieldKind::points:
      return "list of three numbers, each " + range_of(row) + at_least(row.least);
    case FieldKind::values:
      return "list of numbers, texts, flags or points" + at_least(row.least);
    case FieldKind::choice: {
      std::string words;
      for (const std::string& word : row.words) words += (words.empty() ? "" : ", ") + in_code(word);
      return words;
    }
    case FieldKind::record:
      return link_to(row.record);
    case FieldKind::list:
      return "list of " + link_to(row.record) + at_least(row.least);
  }
  return "";
}

std::string otherwise_of(const FieldRow& row) {
  if (row.key.is_required) return "required";
  if (!row.standard.empty()) return in_code(row.standard);
  return row.key.otherwise;
}

std::string table_of(const RecordRow& record) {
  std::string text = "### " + std::string(record.info.name) + "\n\n" + record.info.meaning;
  if (record.has_exactly_one)
    text += " Exactly one of these keys" + (record.beside.empty() ? "" : ", beside " + in_code(record.beside)) + ".";
  text += "\n\n| key | value | if not written | meaning |\n| --- | --- | --- | --- |\n";
  for (const FieldRow& row : record.fields)
    text += "| " + in_code(row.key.name) + " | " + value_of(row) + " | " + otherwise_of(row) + " | " + row.key.meaning +
            " |\n";
  return text;
}

std::string tables_of(const std::vector<RecordRow>& records) {
  std::string text;
  for (const RecordRow& record : records) text += (text.empty() ? "" : "\n") + table_of(record);
  return text;
}

std::string preset_table() {
  std::string text =
      "\n### presets\n\nMaterials of the paper, and others by their Young's modulus, which is 2.5 K2 pi R^2 / spacing; "
      "every modulus in kPa/mm, the viscosity in kPa s/mm.\n\n"
      "| preset | K2 | K1 | K' | v1 | ball R mm | spacing mm | source | in the body |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const MaterialPreset& preset : material_presets()) {
    const network::Material& m = preset.material;
    text += "| " + in_code(in_quotes(preset.name)) + " | ";
    for (const double value : {m.spring, m.kelvin, m.constraint, m.viscosity})
      text += double_to_decimal(value, 6) + " | ";
    for (const double length : {preset.ball_radius, m.calibration_spacing})
      text += double_to_decimal(length, -3) + " | ";
    text += std::string(preset.source) + " | " + preset.in_situ.source + " |\n";
  }
  return text;
}

}  // namespace

std::string scene_reference() { return tables_of(FieldLister::list_of<SceneSpec>()) + preset_table(); }

std::string script_reference() { return tables_of(FieldLister::list_of<Script>()); }

std::string course_reference() { return tables_of(FieldLister::list_of<CourseSpec>()); }
std::string sweep_reference() { return tables_of(FieldLister::list_of<SweepSpec>()); }

}  // namespace ctpm::scenes
