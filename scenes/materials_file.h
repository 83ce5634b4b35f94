#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// Name of the file in a scene's folder.
inline constexpr const char* kMaterialsFile = "materials.json";

/// A material of an author's own.
struct NamedMaterial {
  std::string name;
  MaterialSpec material;

  friend bool operator==(const NamedMaterial&, const NamedMaterial&) = default;
};

/// Reads the text of a materials file: a list of materials, each with a name and the keys of a scene's material
/// (FORMAT.md). Reports every error at once, each with `file:line:col`: those of the text, its values and the rules of
/// a material; a name that is taken, by another or a preset.
Result<std::vector<NamedMaterial>> read_materials(std::string_view text, const std::string& file_name);

/// The text of a materials file with `material` in place of that of its name, or added to the others; comments and
/// layout are kept where no key must go. An empty `text` is that of no file yet. Errors: those of read_materials; the
/// name is a preset's.
Result<std::string> with_material(const std::string& text, const std::string& file_name, const NamedMaterial& material);

}  // namespace ctpm::scenes
