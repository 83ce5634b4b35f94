#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"
#include "studio/sources/input_source.h"

namespace ctpm::sources {

/// A source that is ready.
struct OpenedSource {
  std::unique_ptr<InputSource> source;
  std::map<std::string, std::string> metadata;  ///< what the session stores about its source
  std::vector<std::string> remarks;             ///< for the user; each a sentence with the file's name
};

/// A script as a source for `model`.
OpenedSource play_script(const scenes::Script& script, const Model& model);

/// The errors of a script for a scene that may have refused values; its tools are not judged where the scene's are
/// refused.
Errors check_script(const std::string& file, const scenes::SceneDraft& scene);

/// The motion in `file`. Errors: the file cannot be read; those of read_motion(), with places. Remark: columns that are
/// not used.
Result<OpenedSource> open_motion(const std::string& file, const Model& model);

/// The script in a text that stands for the file's. `scene` has the probes that its places may name. Errors: those of
/// read_script(), with places.
Result<OpenedSource> read_script_source(const std::string& text, const std::string& file, const Model& model,
                                        const scenes::SceneSpec& scene);

/// As open_motion() for a text that stands for the file's.
Result<OpenedSource> read_motion_source(const std::string& text, const std::string& file, const Model& model);

}  // namespace ctpm::sources
