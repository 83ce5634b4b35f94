#pragma once

#include <string>
#include <vector>

#include "studio/server/folder.h"

namespace ctpm::server {

/// The scenes of a folder, by path: JSON files that begin like one, also those that their authors have to mend.
std::vector<FolderEntry> scenes_of(const Folder& folder);

/// Whether a file of that path can be a scene: it ends in .json, and not as scripts, notes and other files do.
bool may_name_scene(const std::string& path);

/// A place for a scene. Errors: those of Folder::place(); its name is none of a scene.
Result<std::string> place_of_scene(const Folder& folder, const std::string& path);

/// The file of a scene that is listed, to be moved. Errors: those of Folder::find(); it is not among scenes_of(); it is
/// a link, which stands for a file elsewhere.
Result<std::string> find_listed_scene(const Folder& folder, const std::string& path);

}  // namespace ctpm::server
