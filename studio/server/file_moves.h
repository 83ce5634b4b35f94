#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "studio/server/folder.h"

// Files of the folder that change their place, and never over another one.
namespace ctpm::server {

using Moves = std::vector<std::pair<std::filesystem::path, std::filesystem::path>>;  ///< from, to

/// A file itself, and no link to one.
bool is_own_file(const std::filesystem::path& path);

/// Whether anything has that name, a link that leads nowhere too.
bool is_taken(const std::filesystem::path& path);

/// Moves all of them, or none. Error: a place is taken, or a file cannot be moved.
Result<Done> move_all(const Folder& folder, const Moves& moves);

}  // namespace ctpm::server
