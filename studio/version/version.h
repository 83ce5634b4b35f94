#pragma once

#include <string>

namespace ctpm::version {

/// Names the program's version, the commit that it was built from (with `-dirty` if files differed from it; `unknown`
/// outside of git), the compiler and the kind of build.
std::string build_fingerprint();

}  // namespace ctpm::version
