#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/model/result.h"

namespace ctpm::server {

/// A file of the folder.
struct FolderEntry {
  std::string path;         ///< relative to the folder, with '/'
  std::uint64_t bytes = 0;  ///< its size
  double modified_s = 0;    ///< [s] since 1970
};

/// A file's time [s] since 1970.
double unix_seconds(std::filesystem::file_time_type time);

/// The folder that the studio may read and write. Nothing outside of it can be named, through "..", an absolute path
/// or a link.
class Folder {
 public:
  /// Errors: it does not exist, is no folder, or cannot be read.
  static Result<Folder> open(const std::string& path);

  /// The file of that relative path, after resolving links. Errors: it lies outside, or does not exist.
  Result<std::string> find(const std::string& relative) const;

  /// A place for a new file. Errors: it would lie outside; its folder does not exist; its name is empty or hidden.
  Result<std::string> place(const std::string& relative) const;

  /// A name for new files: the wanted one, or the first with a number at its end (-2, -3) whose place is not taken.
  /// Errors: those of place().
  Result<std::string> free_name(const std::string& wanted,
                                const std::function<bool(const std::string& place)>& is_taken) const;

  /// All files below the folder whose names end in `ending`, by path; hidden folders and links to folders are not
  /// entered. At most kMostListed.
  std::vector<FolderEntry> list(const std::string& ending) const;

  /// The path from the folder to a file in it, with '/'.
  std::string relative(const std::string& path) const;

  /// A text that begins with a file of the folder, with that file as the page names it: relative().
  std::string shown(const std::string& text) const;

  const std::filesystem::path& root() const { return root_; }  ///< absolute, links resolved

  static constexpr std::size_t kMostListed = 5000;

 private:
  explicit Folder(std::filesystem::path root) : root_(std::move(root)) {}
  bool holds(const std::filesystem::path& resolved) const;

  std::filesystem::path root_;
};

}  // namespace ctpm::server
