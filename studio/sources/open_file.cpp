#include "studio/sources/open_file.h"

#include <utility>

#include "studio/output/files.h"
#include "studio/sources/motion_source.h"
#include "studio/sources/odd_motion.h"
#include "studio/sources/script_source.h"

namespace ctpm::sources {

OpenedSource play_script(const scenes::Script& script, const Model& model) {
  OpenedSource opened;
  opened.source = std::make_unique<ScriptSource>(scenes::ScriptPlayer(script, model.tools, model.tick));
  opened.metadata = {{"source", "script"}, {"script", scenes::write_script(script)}};
  return opened;
}

Errors check_script(const std::string& file, const scenes::SceneDraft& scene) {
  const Result<std::string> text = output::read_text_file(file);
  return text ? scenes::check_script(*text, file, scene) : text.errors();
}

Result<OpenedSource> read_script_source(const std::string& text, const std::string& file, const Model& model,
                                        const scenes::SceneSpec& scene) {
  scenes::PlaceFinder finder = scenes::finder_of(model, scene);
  const Result<scenes::Script> script = scenes::read_script_for(text, file, model, &finder);
  if (!script) return script.errors();
  return play_script(*script, model);
}

Result<OpenedSource> open_motion(const std::string& file, const Model& model) {
  const Result<std::string> text = output::read_text_file(file);
  if (!text) return text.errors();
  return read_motion_source(*text, file, model);
}

Result<OpenedSource> read_motion_source(const std::string& text, const std::string& file, const Model& model) {
  Result<Motion> motion = read_motion(text, file, model.tools);
  if (!motion) return motion.errors();
  std::string unused;
  for (const std::string& name : motion->unused_columns) unused += (unused.empty() ? "" : ", ") + name;
  OpenedSource opened;
  if (!unused.empty())
    opened.remarks.push_back(file + ": columns that say nothing about the hand are left out: " + unused);
  for (const Error& odd : find_odd_motion(*motion, file))
    opened.remarks.push_back(odd.where + ": warning: " + odd.message + " (" + odd.hint + ")");
  opened.metadata = {{"source", "motion"}, {"motion_file", file}};
  opened.source = std::make_unique<MotionSource>(std::move(*motion), model.tick);
  return opened;
}

}  // namespace ctpm::sources
