#pragma once

#include <optional>
#include <string>

#include "studio/server/folder.h"
#include "studio/server/known_files.h"

namespace ctpm::server {

/// In the name of an upload that is not whole yet.
inline constexpr const char* kPart = ".part-";

/// The uploads of one run that go with their pages, in a hidden file of the folder. The file is locked as long as the
/// run lasts, so that the next one knows a list whose run was killed, and removes what is left of its uploads.
class UploadList {
 public:
  explicit UploadList(const Folder& folder) : folder_(folder) {}
  ~UploadList();
  UploadList(const UploadList&) = delete;
  UploadList& operator=(const UploadList&) = delete;

  /// Names an upload before it gets its place at `path`, with the stamp that it has there. No stamp: it grows still,
  /// and its name is one that nobody else would give. Where the list cannot be written, nothing is named.
  void add(const std::string& path, const std::optional<KnownFiles::Stamp>& stamp);

  /// Removes the uploads of runs that were killed, but for those that somebody has changed since or a file names.
  static void remove_left(const Folder& folder);

 private:
  void open();

  const Folder& folder_;
  std::string path_;
  int file_ = -1;
};

}  // namespace ctpm::server
