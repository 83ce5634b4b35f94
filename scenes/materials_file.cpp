#include "scenes/materials_file.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "scenes/field_reader.h"
#include "scenes/field_writer.h"
#include "scenes/json_text.h"
#include "scenes/presets.h"
#include "scenes/rewrite_json.h"
#include "scenes/scene_keys.h"
#include "scenes/scene_rules.h"

namespace ctpm::scenes {

namespace {

struct MaterialsFile {
  std::vector<NamedMaterial> materials;
};

}  // namespace

inline RecordInfo info_of(const NamedMaterial&) { return {"named material", "A material of an author's own."}; }
template <class V>
void describe_fields(V& v, NamedMaterial& named) {
  v.text(required("name", "Name by which an import takes it."), named.name);
  describe_fields(v, named.material);
}

inline RecordInfo info_of(const MaterialsFile&) { return {"materials", "The whole file."}; }
template <class V>
void describe_fields(V& v, MaterialsFile& file) {
  v.constant(required("format", "Says that these are materials."), "ctpm-materials");
  v.constant(required("version", "Version of the format."), 1);
  v.list(required("materials", "The materials."), file.materials, 1);
}

Result<std::vector<NamedMaterial>> read_materials(std::string_view text, const std::string& file_name) {
  Result<JsonNode> parsed = parse_json(text, file_name);
  if (!parsed) return parsed.errors();
  const auto root = std::make_shared<const JsonNode>(*std::move(parsed));
  MaterialsFile file;
  Problems problems(TextPlaces(root, file_name));
  FieldReader::read_record(*root, "", problems, file);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < file.materials.size(); ++i) {
    const std::string at = "/materials/" + std::to_string(i), &name = file.materials[i].name;
    check_material(problems, at, file.materials[i].material);
    if (!problems.is_good(at + "/name")) continue;
    if (find_preset(name) != nullptr)
      problems.add_rule(at + "/name", "got " + in_quotes(name) + ", which is a preset of the program");
    else if (!seen.insert(name).second)
      problems.add_rule(at + "/name", "got " + in_quotes(name) + ", which is taken already");
  }
  if (!problems.is_empty()) return problems.errors();
  return file.materials;
}

Result<std::string> with_material(const std::string& text, const std::string& file_name,
                                  const NamedMaterial& material) {
  MaterialsFile before, after;
  if (!text.empty()) {
    Result<std::vector<NamedMaterial>> read = read_materials(text, file_name);
    if (!read) return read.errors();
    before.materials = *std::move(read);
  }
  after = before;
  const auto own = std::find_if(after.materials.begin(), after.materials.end(),
                                [&](const NamedMaterial& one) { return one.name == material.name; });
  if (own != after.materials.end())
    *own = material;
  else
    after.materials.push_back(material);
  const std::string new_text = FieldWriter::record_text(after, 0) + "\n";
  const std::optional<std::string> changed =
      text.empty() ? std::nullopt : rewrite_json(text, FieldWriter::record_text(before, 0) + "\n", new_text);
  for (const std::string& candidate : {changed.value_or(""), new_text})
    if (const auto read = read_materials(candidate, file_name); read && *read == after.materials) return candidate;
  return read_materials(new_text, file_name).errors();
}

}  // namespace ctpm::scenes
