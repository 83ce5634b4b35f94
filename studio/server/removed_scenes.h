#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/server/folder.h"

// Scenes that were removed: where their files are, and how they come back or go for good.
namespace ctpm::server {

inline constexpr const char* kRemoved = ".ctpm-removed";  ///< below the folder; hidden, so that nothing lists it

/// What went in one removal.
struct RemovedScene {
  /// A file, by the path where it was.
  struct File {
    std::string path;
    std::uint64_t bytes = 0;
    std::string used_by;  ///< a scene of the folder, or one that was removed too, that needs it; empty: none
  };
  std::string removed;      ///< its number
  std::string path;         ///< of the scene; empty: none is among the files
  double removed_s = 0;     ///< when it went [s], since 1970
  std::vector<File> files;  ///< at least one
};

/// Moves files into a folder of their own below kRemoved, whose name, a number, is returned. Errors: one cannot be
/// moved; then all are where they were.
Result<std::string> remove_files(const Folder& folder, const std::vector<std::string>& paths);

/// All that was removed and is there, the newest first. Errors: who uses the files cannot be told.
Result<std::vector<RemovedScene>> removed_scenes(const Folder& folder);

/// Moves what a removal moved back to where it was, and returns the paths. Errors: `removed` is no such folder; a place
/// is taken; then nothing is moved.
Result<std::vector<std::string>> restore_removed(const Folder& folder, const std::string& removed);

/// Deletes what a removal moved, for good. Errors: `removed` is no such folder; its files are others than `listed`, of
/// which somebody knows that they go; one cannot be deleted.
Result<Done> delete_removed(const Folder& folder, const std::string& removed, const std::vector<std::string>& listed);

}  // namespace ctpm::server
