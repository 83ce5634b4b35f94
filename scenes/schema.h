#pragma once

#include <string>

namespace ctpm::scenes {

/// JSON Schema (2020-12) of scenes, scripts and courses: what an editor needs to complete and check them.
/// It holds every key, type, range and default; rules between keys are checked by the reader alone. Checked
/// in as scene.schema.json, script.schema.json and course.schema.json.
std::string scene_schema();
std::string script_schema();
std::string course_schema();

/// Markdown tables of every key of each. Checked in within FORMAT.md, SCRIPT.md and COURSE.md.
std::string scene_reference();
std::string script_reference();
std::string course_reference();

}  // namespace ctpm::scenes
