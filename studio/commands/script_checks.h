#pragma once

#include <string>

#include "core/model/model.h"
#include "core/model/result.h"
#include "recordings/session.h"
#include "scenes/script.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::commands {

/// Reads a script of a scene. Errors: those of the file and of scenes::read_script_for().
Result<scenes::Script> read_script(const std::string& file, const loading::LoadedScene& scene);

/// That what was played never touched tissue, or never cut though a blade was taken up. `where`: its file.
Errors find_misses(const recordings::SessionStatistics& did, bool took_blade, const std::string& where);

/// The same before it is played, as far as that can be known then: that no tool of a script comes near an organ,
/// however far it presses. A script without a tool misses nothing.
Errors find_far_script(const scenes::Script& script, const Model& model, const std::string& where);

}  // namespace ctpm::commands
