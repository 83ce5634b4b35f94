#include "studio/session/record_script.h"

#include <cmath>

#include "core/step.h"
#include "recordings/session_writer.h"
#include "studio/session/script_source.h"

namespace ctpm {

std::string build_fingerprint() {
#ifdef __clang__
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
#ifdef __OPTIMIZE__
  const std::string kind = "optimised";
#else
  const std::string kind = "unoptimised";
#endif
  return std::string("ctpm ") + CTPM_VERSION + ", " + compiler + ", " + kind;
}

Result<RecordOutcome> record_script(const LoadedScene& scene, const Script& script, const std::string& path,
                                    bool overwrite, const RunOptions& options) {
  const SceneSpec& spec = scene.scene.spec;
  const Model& model = scene.built.model;
  State state = rest_state(model);
  Stepper(model).settle(state, std::llround(spec.settle / model.tick));

  SessionStart start;
  start.scene_text = scene.scene.text;
  start.model = model;
  start.surfaces = surfaces_of(scene.organs);
  start.initial_state = state;
  start.build_fingerprint = build_fingerprint();
  start.metadata = {{"scene_name", spec.name}, {"source", "script"}, {"script", write_script(script)}};
  WriterOptions writing;
  writing.overwrite = overwrite;
  writing.wait_when_full = !options.in_real_time;
  Result<SessionWriter> writer = SessionWriter::create(path, start, writing);
  if (!writer) return writer.errors();

  ScriptSource source(ScriptPlayer(script, model.tools, model.tick));
  RecordOutcome outcome;
  RunOptions running = options;
  running.damage_force = damage_force_of(spec);
  outcome.run = run_session(model, state, source, *writer, running);
  const Result<SessionStatistics> statistics = writer->finish();
  if (!statistics) return statistics.errors();
  outcome.statistics = *statistics;
  return outcome;
}

}  // namespace ctpm
