#include "studio/server/naming_files.h"

#include <algorithm>
#include <set>
#include <utility>

#include "studio/output/files.h"
#include "studio/server/file_moves.h"
#include "studio/server/scene_list.h"

namespace ctpm::server {

namespace fs = std::filesystem;

bool NamingFile::names_scenes() const {
  return std::any_of(strings.begin(), strings.end(), [](const scenes::TextString& string) {
    return string.value == "ctpm-course" || string.value == "ctpm-sweep";
  });
}

Result<std::vector<NamingFile>> naming_files(const Folder& folder) {
  const std::vector<FolderEntry> all = folder.list(".json");
  if (all.size() >= Folder::kMostListed)
    return Error{"", "the folder has too many files to tell what names a scene", ""};
  std::set<std::string> scenes;
  for (const FolderEntry& entry : scenes_of(folder)) scenes.insert(entry.path);
  std::vector<NamingFile> files;
  for (const FolderEntry& entry : all) {
    const fs::path file = folder.root() / entry.path;
    if (!is_own_file(file)) continue;
    Result<std::string> text = output::read_text_file(file.string());
    if (!text) return text.errors();
    std::vector<scenes::TextString> strings = scenes::strings_of(*text);
    files.push_back({file, entry.path, std::move(*text), std::move(strings), scenes.contains(entry.path)});
  }
  return files;
}

fs::path named_by(const fs::path& from, const std::string& value) {
  return (from.parent_path() / value).lexically_normal();
}

std::string user_of_mesh(const fs::path& mesh, const std::vector<NamingFile>& files) {
  // A sweep names meshes as its scene does, wherever that lies.
  for (const NamingFile& one : files)
    for (const scenes::TextString& string : one.strings)
      if (one.is_scene ? named_by(one.file, string.value) == mesh
                       : fs::path(string.value).filename() == mesh.filename())
        return one.path;
  return "";
}

void remove_unused_upload(const Folder& folder, KnownFiles& uploads, const std::string& file) {
  const Result<std::vector<NamingFile>> all = naming_files(folder);
  if (all && user_of_mesh(file, *all).empty()) uploads.remove(file);
}

}  // namespace ctpm::server
