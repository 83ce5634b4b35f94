#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "importers/mesh.h"
#include "scenes/presets.h"
#include "scenes/scene_spec.h"

namespace ctpm::authoring {

/// The tissue of an organ that is imported.
struct Tissue {
  scenes::MaterialSpec material;
  const scenes::MaterialPreset* preset = nullptr;  ///< sizes and looks are its; never null
  bool is_own = false;                             ///< the author's own material
  bool is_assumed = false;                         ///< no name said which organ it is

  importers::UsualSize usual_size() const { return {preset->usual_size_least, preset->usual_size_most}; }
};

/// The tissue `name`, of the author's materials in `folder` or a preset. If it is empty: the first that one of `hints`
/// contains, else soft tissue of no named organ. Errors: no such tissue; a materials file that cannot be read.
Result<Tissue> choose_tissue(const std::string& folder, const std::string& name, const std::vector<std::string>& hints);

}  // namespace ctpm::authoring
