#include "studio/authoring/tissue_choice.h"

#include <algorithm>
#include <filesystem>

#include "scenes/materials_file.h"
#include "studio/output/files.h"
#include "studio/output/option_name.h"

namespace ctpm::authoring {
namespace {

Tissue tissue_of(const scenes::MaterialPreset& preset) {
  Tissue tissue;
  tissue.preset = &preset;
  tissue.material.preset = preset.name;
  return tissue;
}

Tissue tissue_of(const scenes::NamedMaterial& own) {
  const scenes::MaterialPreset* preset = scenes::find_preset(own.material.preset);
  if (preset == nullptr) preset = scenes::preset_in_name(own.name);
  Tissue tissue = tissue_of(preset != nullptr ? *preset : *scenes::find_preset(scenes::kGenericPreset));
  tissue.material = own.material, tissue.is_own = true;
  return tissue;
}

/// The author's materials in a folder; none if there is no such file.
Result<std::vector<scenes::NamedMaterial>> own_materials(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / scenes::kMaterialsFile).string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::vector<scenes::NamedMaterial>{};
  const Result<std::string> text = output::read_text_file(path);
  if (!text) return text.errors();
  return scenes::read_materials(*text, path);
}

}  // namespace

Result<Tissue> choose_tissue(const std::string& folder, const std::string& name,
                             const std::vector<std::string>& hints) {
  const Result<std::vector<scenes::NamedMaterial>> own = own_materials(folder);
  if (!own) return own.errors();
  if (!name.empty()) {
    for (const scenes::NamedMaterial& material : *own)
      if (material.name == name) return tissue_of(material);
    if (const scenes::MaterialPreset* preset = scenes::find_preset(name)) return tissue_of(*preset);
    std::string known;
    for (const scenes::NamedMaterial& material : *own) known += (known.empty() ? "" : ", ") + material.name;
    for (const std::string& preset : scenes::preset_names()) known += (known.empty() ? "" : ", ") + preset;
    return Error{output::option_name("import.organ"), "there is no preset '" + name + "'",
                 "known: " + known + "; own materials belong into " + std::string(scenes::kMaterialsFile) +
                     " in the scene's folder"};
  }
  for (const std::string& hint : hints) {
    for (const scenes::NamedMaterial& material : *own)
      if (hint.find(material.name) != std::string::npos) return tissue_of(material);
    if (const scenes::MaterialPreset* preset = scenes::preset_in_name(hint)) return tissue_of(*preset);
  }
  Tissue tissue = tissue_of(*scenes::find_preset(scenes::kGenericPreset));
  tissue.is_assumed = true;
  return tissue;
}

}  // namespace ctpm::authoring
