#include "studio/server/scene_list.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace ctpm::server {

namespace fs = std::filesystem;

namespace {

/// Whether a JSON file is a scene, or one that is being written: its beginning names the format, or has organs.
bool begins_as_scene(const fs::path& path) {
  constexpr std::size_t kLooked = 64 << 10;  // [bytes]
  std::string text(kLooked, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(file.gcount()));
  return text.find("\"ctpm-scene\"") != std::string::npos || text.find("\"organs\"") != std::string::npos;
}

}  // namespace

bool may_name_scene(const std::string& path) {
  // Notes, the sidecars of videos and whatever other programs write; scripts and a schema, which name the same keys.
  for (const char* ending : {".script.json", ".notes.json", ".mp4.json", ".avi.json", "results.json", ".schema.json"})
    if (path.ends_with(ending)) return false;
  const bool is_script = path.starts_with("scripts/") || path.find("/scripts/") != std::string::npos;
  return path.ends_with(".json") && !is_script;
}

std::vector<FolderEntry> scenes_of(const Folder& folder) {
  std::vector<FolderEntry> scenes = folder.list(".json");
  std::erase_if(scenes, [&](const FolderEntry& entry) {
    return !may_name_scene(entry.path) || !begins_as_scene(folder.root() / entry.path);
  });
  return scenes;
}

Result<std::string> place_of_scene(const Folder& folder, const std::string& path) {
  if (!path.ends_with(".json")) return Error{path, "a scene's name must end in .json", ""};
  return folder.place(path);
}

Result<std::string> find_listed_scene(const Folder& folder, const std::string& path) {
  const Result<std::string> file = folder.find(path);
  if (!file) return file.errors();
  const std::vector<FolderEntry> scenes = scenes_of(folder);
  if (std::none_of(scenes.begin(), scenes.end(), [&](const FolderEntry& entry) { return entry.path == path; }))
    return Error{path, "is not among the scenes of the folder", ""};
  if (*file != (folder.root() / path).string()) return Error{path, "is a link, and stays as it is", ""};
  return *file;
}

}  // namespace ctpm::server
