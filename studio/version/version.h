#pragma once

#include <string>

namespace ctpm::version {

/// Version, commit (build_commit()), compiler and build type of this program.
std::string build_fingerprint();

}  // namespace ctpm::version
