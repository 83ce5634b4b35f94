#include "studio/server/session_scenes.h"

#include <cstdio>
#include <optional>

#include "recordings/session_reader.h"
#include "studio/compare/session_track.h"

namespace ctpm::server {

std::string scene_key(const Model& model) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", (unsigned long long)compare::scene_hash(model));
  return text;
}

Result<SceneOfSession> SessionScenes::of(const std::string& file) {
  const std::optional<KnownFiles::Stamp> stamp = KnownFiles::stamp_of(file);
  if (stamp) {
    const std::lock_guard lock(mutex_);
    if (const auto known = known_.find(file); known != known_.end() && known->second.first == *stamp)
      return known->second.second;
  }
  const Result<recordings::SessionReader> reader = recordings::SessionReader::open(file);
  if (!reader) return reader.errors();
  const recordings::SessionStart& start = reader->start();
  const auto name = start.metadata.find("scene_name");
  const SceneOfSession scene{name == start.metadata.end() ? "" : name->second, scene_key(start.model)};
  if (stamp) {
    const std::lock_guard lock(mutex_);
    known_.insert_or_assign(file, std::pair(*stamp, scene));
  }
  return scene;
}

}  // namespace ctpm::server
