#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/text_strings.h"
#include "studio/server/folder.h"
#include "studio/server/known_files.h"

// Which files of the folder name others: scenes their meshes, courses and sweeps their scenes.
namespace ctpm::server {

/// A JSON file of the folder that may name others.
struct NamingFile {
  std::filesystem::path file;  ///< where it is, or belongs
  std::string path, text;
  std::vector<scenes::TextString> strings;
  bool is_scene = false;

  /// Courses and sweeps say by its path which scene they are of.
  bool names_scenes() const;
};

/// All JSON files but links. Error: one cannot be read, or there are more than are listed: then who names a file is not
/// known.
Result<std::vector<NamingFile>> naming_files(const Folder& folder);

/// The file that a text in `from` names by `value`.
std::filesystem::path named_by(const std::filesystem::path& from, const std::string& value);

/// The first of the files that uses a mesh; empty: none.
std::string user_of_mesh(const std::filesystem::path& mesh, const std::vector<NamingFile>& files);

/// Removes an upload that no file names: an import made a scene of it, which has its own mesh, or its page is gone.
/// Where who names it is not known, it stays.
void remove_unused_upload(const Folder& folder, KnownFiles& uploads, const std::string& file);

}  // namespace ctpm::server
