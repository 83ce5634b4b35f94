#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// A material of an author's own.
struct NamedMaterial {
  std::string name;
  MaterialSpec material;
};

/// Reads the text of a materials file: a list of materials, each with a name and the keys of a scene's material
/// (FORMAT.md). Reports every error at once, each with `file:line:col`: those of the text, its values and the rules of
/// a material; a name that is taken, by another or a preset.
Result<std::vector<NamedMaterial>> read_materials(std::string_view text, const std::string& file_name);

}  // namespace ctpm::scenes
