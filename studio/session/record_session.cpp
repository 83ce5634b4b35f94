#include "studio/session/record_session.h"

#include <algorithm>
#include <cmath>

#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "recordings/session_writer.h"
#include "scenes/scene_file.h"
#include "studio/loading/standing.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/sources/script_source.h"
#include "studio/version/version.h"

namespace ctpm::session {

std::optional<recordings::SessionStart> start_session(
    const loading::LoadedScene& scene, const std::function<bool()>& should_stop,
    const std::function<void(std::int64_t done, std::int64_t most)>& progress) {
  recordings::SessionStart start;
  start.scene_text = scene.scene.found_text;
  start.model = scene.built.model;
  std::optional<loading::Standing> settled =
      loading::settle_scene(scene.scene.spec, start.model, {}, should_stop, progress);
  if (!settled) return std::nullopt;
  start.initial_state = std::move(settled->state);
  start.build_fingerprint = version::build_fingerprint();
  start.metadata = {{"scene_name", scene.scene.spec.name}};
  return start;
}

recordings::SessionStart start_session(const loading::LoadedScene& scene) { return *start_session(scene, {}); }

Result<recordings::SessionStart> continue_session_at(const std::string& file, double at_s) {
  Result<recordings::SessionReader> parent = recordings::SessionReader::open(file);
  if (!parent) return parent.errors();
  const double tick = parent->start().model.tick, end_s = double(parent->tick_count()) * tick;
  if (!(at_s >= 0 && at_s <= end_s + 0.5 * tick))
    return Error{
        output::option_name("continue.at_s"),
        "got " + output::fixed(at_s, 3) + ", must be in [0, " + output::fixed(end_s, 3) + "] s: so long lasts " + file,
        ""};
  Result<recordings::SessionStart> start =
      recordings::continue_session(*parent, std::min<std::int64_t>(std::llround(at_s / tick), parent->tick_count()));
  if (!start) return start.errors();
  start->build_fingerprint = version::build_fingerprint();
  // The parent's motion is not this session's.
  std::erase_if(start->metadata, [](const auto& entry) {
    return entry.first != "scene_name" && entry.first != recordings::parent_session_key &&
           entry.first != recordings::parent_tick_key;
  });
  return start;
}

Result<RecordOutcome> record_session(const recordings::SessionStart& start, sources::InputSource& source,
                                     const std::string& path, bool overwrite, const RunOptions& options) {
  recordings::WriterOptions writing;
  writing.overwrite = overwrite;
  writing.wait_when_full = !options.in_real_time;
  // Who waits needs no queue for the seconds that a disk may take; to fill a long one costs more than a short session.
  if (writing.wait_when_full) writing.queue_ticks = 1 << 11;
  Result<recordings::SessionWriter> writer = recordings::SessionWriter::create(path, start, writing);
  if (!writer) return writer.errors();

  RunOptions running = options;
  if (const Result<scenes::SceneText> scene = scenes::read_scene(start.scene_text, path))
    running.damage_force = loading::damage_force_of(scene->spec);
  RecordOutcome outcome;
  State state = start.initial_state;
  outcome.run = run_session(start.model, state, source, *writer, running);
  std::vector<recordings::NamedValue> values = source.statistics();
  if (options.in_real_time) values.emplace_back(kWaited, outcome.run.waited);
  const Result<recordings::SessionStatistics> statistics = writer->finish(std::move(values));
  if (!statistics) return statistics.errors();
  outcome.statistics = *statistics;
  return outcome;
}

Result<RecordOutcome> record_script(const loading::LoadedScene& scene, const scenes::Script& script,
                                    const std::string& path, bool overwrite, const RunOptions& options) {
  recordings::SessionStart start = start_session(scene);
  start.metadata["source"] = "script", start.metadata["script"] = scenes::write_script(script);
  sources::ScriptSource source(scenes::ScriptPlayer(script, start.model.tools, start.model.tick));
  return record_session(start, source, path, overwrite, options);
}

}  // namespace ctpm::session
