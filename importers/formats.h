#pragma once

#include <string>
#include <vector>

namespace ctpm::importers {

/// How the names of files end that read_mesh() takes, with the dot, the usual ones first. assimp reads more than are
/// listed; label maps are listed where this build reads them.
std::vector<std::string> readable_endings();

/// Whether a file's name ends in one of them, in capitals or not.
bool has_readable_ending(const std::string& name);

}  // namespace ctpm::importers
