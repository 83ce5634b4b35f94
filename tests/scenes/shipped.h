#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace ctpm {

inline std::string content_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Paths of every scene in scenes/ and scenes/paper/, sorted; a scene that is added later is tested without
/// anybody naming it here.
inline std::vector<std::string> shipped_scenes() {
  std::vector<std::string> paths;
  for (const char* folder : {"/scenes", "/scenes/paper"})
    for (const auto& entry : std::filesystem::directory_iterator(CTPM_SOURCE_DIR + std::string(folder))) {
      const std::string path = entry.path().string();
      if (!path.ends_with(".json") || path.ends_with(".schema.json")) continue;
      if (content_of_file(path).find("\"ctpm-scene\"") != std::string::npos) paths.push_back(path);
    }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace ctpm
