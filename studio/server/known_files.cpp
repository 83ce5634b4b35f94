#include "studio/server/known_files.h"

namespace ctpm::server {

namespace fs = std::filesystem;

std::optional<KnownFiles::Stamp> KnownFiles::stamp_of(const std::string& path) {
  std::error_code failure;
  if (fs::symlink_status(path, failure).type() != fs::file_type::regular || failure) return std::nullopt;
  const Stamp stamp{fs::last_write_time(path, failure), fs::file_size(path, failure)};
  return failure ? std::nullopt : std::optional(stamp);
}

void KnownFiles::add(const std::string& path) {
  if (const std::optional<Stamp> stamp = stamp_of(path)) add(path, *stamp);
}

void KnownFiles::add(const std::string& path, const Stamp& stamp) {
  const std::lock_guard lock(mutex_);
  files_[path] = stamp;
}

bool KnownFiles::is_as_it_was(const std::string& path) const {
  const auto known = files_.find(path);
  return known != files_.end() && stamp_of(path) == known->second;
}

bool KnownFiles::holds(const std::string& path) const {
  const std::lock_guard lock(mutex_);
  return is_as_it_was(path);
}

bool KnownFiles::remove(const std::string& path) {
  const std::lock_guard lock(mutex_);
  if (!is_as_it_was(path)) return false;
  std::error_code failure;
  files_.erase(path);
  return fs::remove(path, failure);
}

}  // namespace ctpm::server
