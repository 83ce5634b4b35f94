#pragma once

#include <filesystem>
#include <string>

#include "core/model/result.h"

namespace ctpm::authoring {

/// Makes a folder with those above it, and takes away again what it made and nothing filled, unless it is kept.
class NewFolder {
 public:
  NewFolder() = default;
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  /// Errors: it cannot be made. An empty path is the working folder.
  Errors make(const std::string& path);
  void keep() { top_.clear(); }

 private:
  std::filesystem::path top_, made_;  ///< the topmost and the lowest folder that were not there
};

}  // namespace ctpm::authoring
