#include "studio/server/folder.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

namespace ctpm::server {

namespace fs = std::filesystem;

namespace {

Error outside(const std::string& relative) {
  return {relative, "lies outside the folder that the studio was started in", ""};
}

/// "." is not the beginning of a hidden name, ".x" is.
bool is_hidden(const fs::path& name) {
  const std::string text = name.string();
  return text.size() > 1 && text[0] == '.';
}

}  // namespace

double unix_seconds(fs::file_time_type time) {
  const auto system = std::chrono::file_clock::to_sys(time);
  return std::chrono::duration<double>(system.time_since_epoch()).count();
}

Result<Folder> Folder::open(const std::string& path) {
  std::error_code failure;
  const fs::path root = fs::canonical(path, failure);
  if (failure == std::errc::no_such_file_or_directory) return Error{path, "does not exist", "create the folder first"};
  if (!failure && !fs::is_directory(root, failure)) return Error{path, "is not a folder", ""};
  if (!failure && access(root.c_str(), R_OK | X_OK) != 0) failure = std::error_code(errno, std::generic_category());
  if (failure) return Error{path, "cannot be read: " + failure.message(), ""};
  return Folder(root);
}

bool Folder::holds(const fs::path& resolved) const {
  const auto [end, at] = std::mismatch(root_.begin(), root_.end(), resolved.begin(), resolved.end());
  return end == root_.end();
}

Result<std::string> Folder::find(const std::string& relative) const {
  if (relative.find('\0') != std::string::npos || fs::path(relative).is_absolute()) return outside(relative);
  std::error_code failure;
  const fs::path resolved = fs::weakly_canonical(root_ / relative, failure);
  if (failure || !holds(resolved)) return outside(relative);
  if (!fs::exists(resolved, failure)) return Error{relative, "does not exist", ""};
  return resolved.string();
}

Result<std::string> Folder::place(const std::string& relative) const {
  const fs::path wanted(relative), name = wanted.filename();
  if (name.empty() || name == "." || name == ".." || is_hidden(name) || relative.size() > 1000 ||
      name.string().size() > 200)
    return Error{relative, "is no name for a file", ""};
  // An existing link at the place itself is followed by find(): it must not lead outside either.
  const Result<std::string> folder = find(wanted.parent_path().empty() ? "." : wanted.parent_path().string());
  if (!folder) return folder.errors();
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(fs::path(*folder) / name, ignored))) return find(relative);
  return (fs::path(*folder) / name).string();
}

Result<std::string> Folder::free_name(const std::string& wanted,
                                      const std::function<bool(const std::string&)>& is_taken) const {
  const fs::path path(wanted);
  std::string name = path.generic_string();
  for (int number = 2;; ++number) {
    const Result<std::string> at = place(name);
    if (!at) return at.errors();
    if (!is_taken(*at)) return name;
    const std::string numbered = path.stem().string() + "-" + std::to_string(number) + path.extension().string();
    name = (path.parent_path() / numbered).generic_string();
  }
}

std::vector<FolderEntry> Folder::list(const std::string& ending) const {
  std::vector<FolderEntry> entries;
  std::error_code failure;
  fs::recursive_directory_iterator it(root_, fs::directory_options::skip_permission_denied, failure), end;
  for (; !failure && it != end && entries.size() < kMostListed; it.increment(failure)) {
    if (is_hidden(it->path().filename())) {
      it.disable_recursion_pending();
      continue;
    }
    std::error_code ignored;
    if (!it->path().filename().string().ends_with(ending) || !it->is_regular_file(ignored)) continue;
    const std::string name = relative(it->path().string());
    if (!find(name)) continue;  // a link that leads outside
    entries.push_back({name, it->file_size(ignored), unix_seconds(it->last_write_time(ignored))});
  }
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return entries;
}

std::string Folder::shown(const std::string& text) const {
  const std::string begin = root_.string() + "/";
  std::string shown = text;
  for (std::size_t at = 0; (at = shown.find(begin, at)) != std::string::npos;) shown.erase(at, begin.size());
  return shown;
}

std::string Folder::relative(const std::string& path) const {
  return fs::path(path).lexically_relative(root_).generic_string();
}

}  // namespace ctpm::server
