#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/server/folder.h"

// Scenes as files: what belongs to one, who names it, and how it gets another name or goes.
namespace ctpm::server {

/// What happens when a scene goes.
struct Removal {
  /// A file that stays, and why.
  struct Kept {
    std::string path, why;
  };
  std::vector<std::string> goes;  ///< paths: the scene, its script, and its meshes that nothing else names
  std::vector<Kept> stays;        ///< its other meshes, and files that name it
};

/// Errors: those of find_listed_scene().
Result<Removal> plan_removal(const Folder& folder, const std::string& scene);

/// What a scene that was renamed took along.
struct Renamed {
  std::vector<std::string> moved;      ///< paths as they are now: the scene, its script
  std::vector<std::string> rewritten;  ///< courses, sweeps and others that named them, and name them anew
};

/// Gives a scene another name in its folder, where it finds the same meshes. What sessions know of it does not change.
/// Errors: those of find_listed_scene(); `to` is no name of a scene, lies elsewhere or exists; a file cannot be moved
/// or written; then all are as they were.
Result<Renamed> rename_scene(const Folder& folder, const std::string& scene, const std::string& to);

}  // namespace ctpm::server
