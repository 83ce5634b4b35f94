#pragma once

namespace ctpm::version {

/// The commit of this build: its short hash, with `-dirty` if files differed from it; `unknown` outside of git. Defined
/// in a source that the build generates (write_commit.cmake).
const char* build_commit();

}  // namespace ctpm::version
