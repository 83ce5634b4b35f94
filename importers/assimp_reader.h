#pragma once

#include <string>

#include "importers/child_process.h"

namespace ctpm::importers {

/// Reads the file with assimp and sends it as one message (see wire.h). Call it in a child process.
void send_mesh_file(const std::string& path, const std::string& part, const Send& send);

}  // namespace ctpm::importers
