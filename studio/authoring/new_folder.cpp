#include "studio/authoring/new_folder.h"

#include <system_error>

namespace ctpm::authoring {

namespace fs = std::filesystem;

NewFolder::~NewFolder() {
  if (top_.empty()) return;
  std::error_code trouble;
  // Only empty folders go.
  for (fs::path folder = made_; fs::remove(folder, trouble) && folder != top_;) folder = folder.parent_path();
}

Errors NewFolder::make(const std::string& path) {
  std::error_code trouble;
  fs::path top;
  for (fs::path at = fs::path(path).lexically_normal(); !at.empty() && !fs::exists(at, trouble); at = at.parent_path())
    if (at.has_filename()) top = at;
  if (top.empty()) return {};
  fs::create_directories(path, trouble);
  if (trouble) return {{path, "cannot be made: " + trouble.message(), "choose a folder that may be written to"}};
  top_ = top, made_ = fs::path(path).lexically_normal();
  if (!made_.has_filename()) made_ = made_.parent_path();
  return {};
}

}  // namespace ctpm::authoring
