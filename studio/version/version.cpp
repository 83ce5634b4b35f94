#include "studio/version/version.h"

#include "studio/version/commit.h"

namespace ctpm::version {

std::string build_fingerprint() {
#ifdef __clang__
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
#ifdef __OPTIMIZE__
  const std::string kind = "optimised";
#else
  const std::string kind = "unoptimised";
#endif
  return std::string("ctpm ") + CTPM_VERSION + ", commit " + build_commit() + ", " + compiler + ", " + kind;
}

}  // namespace ctpm::version
