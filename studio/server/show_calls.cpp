// A scene that is shown while its author works on it, and what can be measured of it.

#include <mutex>
#include <set>
#include <string>

#include "core/model/errors.h"
#include "core/model/state.h"
#include "studio/fidelity/scene.h"
#include "studio/fidelity/thickness.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/oddities.h"
#include "studio/loading/tick_time.h"
#include "studio/server/call_table.h"
#include "studio/server/picture.h"
#include "studio/server/scene_text.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::server {
namespace {

std::uint32_t stage_of(Parameters& parameters, const CallContext& context) {
  const std::uint32_t stage = std::uint32_t(parameters.number("stage", 0, Desk::kMostStages - 1));
  if (!context.desk) parameters.refuse("stage", "only a page with a WebSocket has stages");
  return stage;
}

/// What is known of each organ's mesh and spheres.
void write_organs(output::JsonWriter& json, const loading::LoadedScene& scene,
                  const std::vector<views::OrganTissues>& tissues) {
  const Model& model = scene.built.model;
  json.begin_list();
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    const importers::ImportReport& report = scene.reports[i];
    std::int64_t anchored = 0;
    const std::int64_t first = model.organs[i].first, end = first + model.organs[i].count;
    for (std::int64_t sphere = first; sphere < end; ++sphere)
      anchored += model.held_axes[std::size_t(sphere)] == kAnchored;
    json.begin_object().member("spheres", scene.organs[i].centre.size()).member("anchored", anchored);
    const bool is_filled = !report.path.empty();  // a rig has no mesh
    json.member("report", is_filled ? importers::to_text(report) : std::string());
    json.member("shape_error", is_filled ? importers::to_text(report.fill.shape) : std::string());
    json.member("thin_parts", fidelity::thin_parts_text(scene.organs[i])).key("findings");
    write_findings(json, report.findings);
    write_tissues(json, tissues[i]);
    json.end_object();
  }
  json.end_list();
}

/// Forces on the ball at each depth: mean, scatter, most over least.
void write_scatter(output::JsonWriter& json, const std::vector<fidelity::OrientationResult::Row>& rows) {
  json.begin_list();
  for (const fidelity::OrientationResult::Row& row : rows) {
    const fidelity::Spread spread = fidelity::spread_of(row.forces);
    json.begin_object().member("depth_m", row.depth).member("force_n", spread.mean);
    json.member("scatter", spread.deviation).member("most_over_least", spread.ratio()).end_object();
  }
  json.end_list();
}

}  // namespace

/// Loads a scene with its meshes, as `check` does, and shows it at rest.
Result<std::string> show_scene(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  scenes::LoadOptions options;
  options.text = parameters.text_if("text");
  const std::uint32_t stage = stage_of(parameters, context);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = options.text ? context.folder.place(path) : context.folder.find(path);
  if (!file) return file.errors();
  const auto told = [&](const std::string&, double share) { context.progress(std::int64_t(1000 * share), 1000); };
  Result<loading::LoadedScene> loaded = loading::load_whole_scene(*file, options, {}, context.should_stop, told);
  if (!loaded) return loaded.errors();
  const auto kept = std::make_shared<KeptScene>(*std::move(loaded));
  const loading::LoadedScene& scene = kept->scene();
  const Model& model = scene.built.model;
  output::JsonWriter organs;
  const std::vector<views::OrganTissues> tissues = views::tissues_of(scene.scene.spec, scene.organs);
  write_organs(organs, scene, tissues);
  PictureMaker maker(model, stage);
  context.desk->outbox().send_bytes(shapes_message(model, stage));
  context.desk->outbox().send_bytes(spheres_message(model, tissues, stage));
  context.desk->outbox().show(maker.make(rest_state(model), {}));
  context.desk->keep(stage, kept);
  Errors warnings = scene.scene.warnings;
  append(warnings, loading::find_odd_places(scene));
  return "{\"view\": " + view_json(scene.scene.spec, model) + ", \"organs\": " + organs.text() +
         ", \"spheres\": " + std::to_string(model.sphere_count()) +
         ", \"elements\": " + std::to_string(model.element_count()) + ", \"warnings\": " + errors_json(warnings) + "}";
}

/// A stage shows no scene any more.
Result<std::string> close_scene(Parameters& parameters, const CallContext& context) {
  const std::uint32_t stage = stage_of(parameters, context);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  context.desk->let_go(stage);
  return std::string("{}");
}

/// Of which scenes the page has changes that are not saved.
Result<std::string> hold_scenes(Parameters& parameters, const CallContext& context) {
  const std::vector<std::string> paths = parameters.texts_if("paths");
  if (!context.desk) parameters.refuse("paths", "only a page with a WebSocket holds scenes");
  Errors errors = parameters.errors();
  std::set<std::string> files;
  for (const std::string& path : paths) {
    const Result<std::string> file = context.folder.place(path);  // it may be gone by now
    if (file)
      files.insert(*file);
    else
      append(errors, file);
  }
  if (!errors.empty()) return errors;
  context.desk->hold(std::move(files));
  return std::string("{}");
}

/// The time of a tick of the scene that a stage shows.
Result<std::string> measure_scene(Parameters& parameters, const CallContext& context) {
  const std::uint32_t stage = stage_of(parameters, context);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const std::shared_ptr<KeptScene> kept = context.desk->kept(stage);
  if (!kept) return Error{"", "no scene is shown there", ""};
  const Model& model = kept->scene().built.model;
  // In ticks: those in which it settles, of which it may not need all, and those that are measured.
  std::int64_t settled = 0;
  const auto settling = [&](std::int64_t done, std::int64_t most) {
    settled = done;
    context.progress(done, most + loading::kTicksToMeasure);
  };
  const auto measuring = [&](std::int64_t done) {
    context.progress(settled + done, settled + loading::kTicksToMeasure);
  };
  const std::shared_ptr<const recordings::SessionStart> start = kept->start(context.should_stop, settling);
  const std::optional<double> time =
      start ? loading::measure_tick(model, start->initial_state, context.should_stop, measuring) : std::nullopt;
  if (!time) return Error{"", "stopped", ""};
  output::JsonWriter json;
  json.begin_object().member("measured_tick_time_s", *time).member("tick_s", model.tick);
  json.member("ticks", loading::kMeasuredTicks).key("warnings");
  write_errors(json, loading::find_unsteady(kept->scene(), start->initial_state));
  return json.end_object().text();
}

/// The scatter of the force on the scene's first ball, as `fidelity SCENE` measures it.
Result<std::string> measure_scatter(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  scenes::LoadOptions options;
  options.text = parameters.text_if("text");
  const bool is_quick = parameters.flag("quick", false);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = options.text ? context.folder.place(path) : context.folder.find(path);
  if (!file) return file.errors();
  const Result<fidelity::SceneOrgan> organ = fidelity::read_scene_organ(*file, options);
  if (!organ) return organ.errors();
  std::vector<Quat> turns = fidelity::twelve_turns();
  if (is_quick) turns.resize(fidelity::kQuickTurns);
  const int places = is_quick ? fidelity::kQuickPlaces : 3;
  std::mutex mutex;
  std::int64_t begun = 0;
  const auto next_press = [&] {
    const std::lock_guard lock(mutex);
    context.progress(begun++, std::int64_t(turns.size()) + places * places);
    return context.should_stop();
  };
  const Result<fidelity::SceneResult> turned = fidelity::measure_scene_turns(*organ, turns, next_press);
  if (!turned) return turned.errors();
  const Result<fidelity::SceneResult> moved = fidelity::measure_scene_places(*organ, places, next_press);
  if (!moved) return moved.errors();
  output::JsonWriter json;
  json.begin_object().member("name", std::string_view(turned->name)).key("turns");
  write_scatter(json, turned->turns);
  json.key("places"), write_scatter(json, moved->places);
  return json.end_object().text();
}

}  // namespace ctpm::server
