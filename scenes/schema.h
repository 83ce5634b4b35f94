#pragma once

#include <string>

namespace ctpm::scenes {

/// JSON Schema (2020-12) of scene text and of script text: what an editor needs to complete and check them.
/// It holds every key, type, range and default; rules between keys are checked by the reader alone. Checked
/// in as scene.schema.json and script.schema.json.
std::string scene_schema();
std::string script_schema();

/// Markdown tables of every key of scenes and scripts. Checked in within FORMAT.md and SCRIPT.md.
std::string scene_reference();
std::string script_reference();

}  // namespace ctpm::scenes
