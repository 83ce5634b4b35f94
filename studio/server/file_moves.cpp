#include "studio/server/file_moves.h"

#include <fcntl.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

namespace ctpm::server {

namespace fs = std::filesystem;

namespace {

/// Never over a file that is there. Returns errno, 0: it was moved.
int move_file(const fs::path& from, const fs::path& to) {
  int outcome = ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
  // Some file systems, of a network or another machine, know no such move.
  if (outcome != 0 && errno == EINVAL && !is_taken(to)) outcome = ::rename(from.c_str(), to.c_str());
  return outcome == 0 ? 0 : errno;
}

}  // namespace

bool is_own_file(const fs::path& path) {
  std::error_code failure;
  return fs::symlink_status(path, failure).type() == fs::file_type::regular && !failure;
}

bool is_taken(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

Result<Done> move_all(const Folder& folder, const Moves& moves) {
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const int failure = move_file(moves[i].first, moves[i].second);
    if (failure == 0) continue;
    const fs::path where = failure == EEXIST ? moves[i].second : moves[i].first;
    while (i-- > 0) move_file(moves[i].second, moves[i].first);
    return Error{folder.relative(where.string()), std::generic_category().message(failure) + "; nothing was moved", ""};
  }
  return Done{};
}

}  // namespace ctpm::server
