#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "recordings/session_reader.h"

namespace ctpm::session {

/// A probe of a session's scene, and the sphere that it follows.
struct Probe {
  std::string name;
  std::size_t sphere = 0;
};

/// None where the session's scene cannot be read, which another version may have written.
std::vector<Probe> probes_of(const recordings::SessionReader& session);

}  // namespace ctpm::session
