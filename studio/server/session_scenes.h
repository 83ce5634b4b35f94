#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "core/model/model.h"
#include "core/model/result.h"
#include "studio/server/known_files.h"

namespace ctpm::server {

/// The scene in which a session was recorded.
struct SceneOfSession {
  std::string name;  ///< as the scene's text has it
  std::string key;   ///< scene_key()
};

/// What only sessions of one scene share.
std::string scene_key(const Model& model);

/// The scenes of sessions that were looked at in this run: to read one again takes longer than to list a folder. Any
/// thread may ask.
class SessionScenes {
 public:
  /// That of a session file, absolute. Errors: those of SessionReader::open().
  Result<SceneOfSession> of(const std::string& file);

 private:
  std::mutex mutex_;
  std::map<std::string, std::pair<KnownFiles::Stamp, SceneOfSession>> known_;
};

}  // namespace ctpm::server
