#pragma once

#include <string>

namespace ctpm::testing {

/// Changes some fields, rows or lists of the session file at `path` and makes every checksum right again. Seeded. True
/// if what it now says is false for sure, so that it must not be "same"; `what` gets the changes.
bool forge_session(const std::string& path, unsigned seed, std::string& what);

/// Makes `count` session files, each with some fields, rows or lists changed and every checksum made right again, and
/// opens, lists and verifies each in a process of its own. None may crash, abort, take 1 GB of memory or 10 s of
/// computing time, and none whose ticks, keyframes, events or statistics changed may be "same". Seeded.
void verify_forgeries(int count, unsigned seed);

}  // namespace ctpm::testing
