#pragma once

#include <string>

#include "core/model/result.h"
#include "importers/import.h"
#include "studio/authoring/import_scene.h"
#include "studio/authoring/tissue_choice.h"

namespace ctpm::authoring {

/// A mesh file, and which tissue it is of as a whole.
struct NamedFile {
  Tissue tissue;
  importers::RepairedFile file;
};

/// Reads and repairs all meshes that a request names. The tissue is the one that it asks for, else the one in the name
/// of the file or of the only mesh in it; its usual size is that by which a unit is guessed. `folder`: of own
/// materials. Errors: those of importers::repair_file() and choose_tissue().
Result<NamedFile> repair_named(const ImportRequest& request, const std::string& folder,
                               importers::ImportOptions options);

}  // namespace ctpm::authoring
