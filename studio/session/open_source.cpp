#include "studio/session/open_source.h"

#include "scenes/script.h"
#include "studio/console.h"
#include "studio/devices/motion_source.h"
#include "studio/files.h"
#include "studio/session/script_source.h"

namespace ctpm {
namespace {

Result<OpenedSource> open_script(const std::string& file, const Model& model) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.errors();
  std::vector<std::string> tools;
  for (const Tool& tool : model.tools) tools.push_back(tool.name);
  const Result<Script> script = read_script(*text, file, tools);
  if (!script) return script.errors();
  OpenedSource opened;
  opened.source = std::make_unique<ScriptSource>(ScriptPlayer(*script, model.tools, model.tick));
  opened.metadata = {{"source", "script"}, {"script", write_script(*script)}};
  return opened;
}

Result<OpenedSource> open_motion(const std::string& file, const Model& model) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.errors();
  Result<Motion> motion = read_motion(*text, file, model.tools);
  if (!motion) return motion.errors();
  std::string unused;
  for (const std::string& name : motion->unused_columns) unused += (unused.empty() ? "" : ", ") + name;
  if (!unused.empty()) print_remark(file + ": columns that say nothing about the hand are left out: " + unused);
  OpenedSource opened;
  opened.metadata = {{"source", "motion"}, {"motion_file", file}};
  opened.source = std::make_unique<MotionSource>(std::move(*motion), model.tick);
  return opened;
}

}  // namespace

int count_of(const SourceRequest& request) { return int(!request.script.empty()) + int(!request.motion.empty()); }

Result<OpenedSource> open_source(const SourceRequest& request, const Model& model) {
  CTPM_CHECK(count_of(request) == 1, "one source is asked for");
  return request.script.empty() ? open_motion(request.motion, model) : open_script(request.script, model);
}

}  // namespace ctpm
