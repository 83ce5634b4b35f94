#include "studio/server/own_files.h"

namespace ctpm::server {

namespace fs = std::filesystem;

/// Nothing: it is no file, or a link to one.
std::optional<OwnFiles::Stamp> OwnFiles::stamp_of(const std::string& path) {
  std::error_code failure;
  if (fs::symlink_status(path, failure).type() != fs::file_type::regular || failure) return std::nullopt;
  const Stamp stamp{fs::last_write_time(path, failure), fs::file_size(path, failure)};
  return failure ? std::nullopt : std::optional(stamp);
}

void OwnFiles::add(const std::string& path) {
  const std::optional<Stamp> stamp = stamp_of(path);
  const std::lock_guard lock(mutex_);
  if (stamp) files_[path] = *stamp;
}

bool OwnFiles::is_as_written(const std::string& path) const {
  const auto known = files_.find(path);
  return known != files_.end() && stamp_of(path) == known->second;
}

bool OwnFiles::holds(const std::string& path) const {
  const std::lock_guard lock(mutex_);
  return is_as_written(path);
}

bool OwnFiles::remove(const std::string& path) {
  const std::lock_guard lock(mutex_);
  if (!is_as_written(path)) return false;
  std::error_code failure;
  files_.erase(path);
  return fs::remove(path, failure);
}

}  // namespace ctpm::server
