#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/model/result.h"
#include "studio/server/desk.h"
#include "studio/server/desks.h"
#include "studio/server/folder.h"
#include "studio/server/kept_answers.h"
#include "studio/server/known_files.h"
#include "studio/server/parameters.h"
#include "studio/server/session_scenes.h"

namespace ctpm::server {

/// What a call may use besides its parameters.
struct CallContext {
  const Folder& folder;
  Desk* desk = nullptr;  ///< of the page that calls; null for a call by POST
  std::function<void(std::int64_t done, std::int64_t total)> progress = [](std::int64_t, std::int64_t) {};
  std::function<bool()> should_stop = [] { return false; };
  KnownFiles* uploads = nullptr;       ///< of which an import may make a scene, if there are any
  KnownFiles* films = nullptr;         ///< an export is added to them, if there are any
  KnownFiles* verified = nullptr;      ///< so is a session that replays as it was recorded; comparisons ask for it
  KeptAnswers* comparisons = nullptr;  ///< known ones are answered from them
  SessionScenes* scenes = nullptr;     ///< of sessions that were looked at
  Desks* desks = nullptr;              ///< of all pages; null: no scene is in use
};

/// Runs the call `name`; PROTOCOL.md lists them. Returns its result as JSON. May take long; any thread may run it.
/// Errors: there is no such call; its parameters are wrong; those of the call.
Result<std::string> run_call(const std::string& name, Parameters& parameters, const CallContext& context);

}  // namespace ctpm::server
