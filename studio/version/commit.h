#pragma once

namespace ctpm::version {

/// The commit that this program was built from: its short hash, with `-dirty` if files differed from it; `unknown`
/// outside of git. Defined in a source that the build writes (write_commit.cmake).
const char* build_commit();

}  // namespace ctpm::version
