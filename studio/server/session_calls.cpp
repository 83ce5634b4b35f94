#include <algorithm>
#include <cmath>
#include <thread>

#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "scenes/scene_file.h"
#include "studio/compare/compare_files.h"
#include "studio/compare/session_track.h"
#include "studio/output/json_writer.h"
#include "studio/output/number_text.h"
#include "studio/server/call_table.h"
#include "studio/server/scene_text.h"
#include "studio/session/session_info.h"
#include "studio/session/whole_verdict.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::server {
namespace {

constexpr double kNone = -1;        ///< of a quantity that is never negative
constexpr double kSpeedRate = 100;  ///< at which the hand's speed is measured, as in a comparison [Hz]

/// The extremes of consecutive values, at most `most` of them.
std::vector<double> thinned(const std::vector<double>& values, std::size_t most) {
  const std::size_t group = std::max<std::size_t>(1, (values.size() + most - 1) / std::max<std::size_t>(most, 1));
  std::vector<double> result;
  for (std::size_t from = 0; from < values.size(); from += group)
    result.push_back(*std::max_element(values.begin() + std::ptrdiff_t(from),
                                       values.begin() + std::ptrdiff_t(std::min(values.size(), from + group))));
  return result;
}

/// Numbers with the digits that a plot can show; null: kNone.
void write_values(output::JsonWriter& json, const char* key, const std::vector<double>& values) {
  json.key(key).begin_list();
  for (const double value : values)
    if (value == kNone)
      json.null();
    else
      json.value(double(float(value)));
  json.end_list();
}

}  // namespace

Result<std::string> open_session(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  const std::optional<double> stage = parameters.number_if("stage", 0, Desk::kMostStages - 1);
  if (stage && !context.desk) parameters.refuse("stage", "only a page with a WebSocket has stages");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = context.folder.find(path);
  if (!file) return file.errors();
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(*file);
  if (!reader) return reader.errors();
  const Result<session::SessionInfo> info = session::read_info(*reader);
  if (!info) return info.errors();
  const Result<scenes::SceneText> scene = scenes::read_scene(reader->start().scene_text, path + " (its scene)");
  if (!scene) return scene.errors();
  if (stage)
    if (const Result<Done> opened = context.desk->open(*file, std::uint32_t(*stage)); !opened) return opened.errors();
  const std::string view = view_json(scene->spec, reader->start().model);
  return "{\"path\": " + json_text(path) + ", \"info\": " + session::info_json(*reader, *info) + ", \"view\": " + view +
         "}";
}

/// Of sessions that cannot be read nothing is said.
Result<std::string> scenes_of_sessions(Parameters& parameters, const CallContext& context) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const std::vector<FolderEntry> sessions = context.folder.list(".ctpm");
  SessionScenes own;
  SessionScenes& scenes = context.scenes ? *context.scenes : own;
  output::JsonWriter json;
  json.begin_list();
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    if (context.should_stop()) return Error{"", "stopped", ""};
    context.progress(std::int64_t(i), std::int64_t(sessions.size()));
    const Result<std::string> file = context.folder.find(sessions[i].path);
    if (!file) continue;  // it went meanwhile
    if (const Result<SceneOfSession> scene = scenes.of(*file))
      json.begin_object()
          .member("path", std::string_view(sessions[i].path))
          .member("scene_name", std::string_view(scene->name))
          .member("scene_key", std::string_view(scene->key))
          .end_object();
  }
  return json.end_list().text();
}

Result<std::string> close_session(Parameters& parameters, const CallContext& context) {
  const double stage = parameters.number("stage", 0, Desk::kMostStages - 1);
  if (!context.desk) parameters.refuse("stage", "only a page with a WebSocket has stages");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  context.desk->close(std::uint32_t(stage));
  return std::string("{}");
}

Result<std::string> session_timeline(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  const double points = parameters.number("points", 2, 20000);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  Result<recordings::SessionReader> reader = open_reader(context, path);
  if (!reader) return reader.errors();
  const Result<compare::SessionTrack> track = compare::read_recorded(*reader);
  if (!track) return track.errors();
  // A tool that was just taken up has no speed yet.
  const std::size_t group = std::size_t(std::max(1.0, std::round(1 / (kSpeedRate * track->tick))));
  std::vector<double> speed(track->tick_count(), 0.0);
  for (const compare::Spell& stroke : track->strokes) {
    const std::span<const Vec3> tips(track->tip.data() + stroke.first, stroke.last - stroke.first);
    const std::vector<double> along =
        compare::speed_along(compare::mean_of_each(tips, group), 1 / (double(group) * track->tick));
    for (std::size_t i = 0; i < along.size() * group; ++i) speed[stroke.first + i] = along[i / group];
  }
  output::JsonWriter json;
  json.begin_object().member("duration_s", track->seconds(track->tick_count()));
  const std::vector<double> force = thinned(track->force, std::size_t(points));
  json.member("points", force.size());
  write_values(json, "force_n", force);
  // What a tick says of depth is a ball's.
  std::vector<double> depth = track->depth;
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (reader->start().model.is_scalpel(track->tool[i])) depth[i] = kNone;
  write_values(json, "depth_m", thinned(depth, std::size_t(points)));
  write_values(json, "speed_m_per_s", thinned(speed, std::size_t(points)));
  return json.end_object().text();
}

Result<std::string> verify_session(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = context.folder.find(path);
  if (!file) return file.errors();
  const std::optional<KnownFiles::Stamp> before = KnownFiles::stamp_of(*file);
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(*file);
  if (!reader) return reader.errors();
  recordings::VerifyOptions options;
  options.progress = context.progress, options.should_stop = context.should_stop;
  // Somebody waits for it, and the session that they recorded is over.
  options.threads = std::max(1, int(std::thread::hardware_concurrency()));
  const Result<session::WholeVerdict> verdict = session::verify_whole(*reader, options);
  if (!verdict) return verdict.errors();
  // With the stamp from before: what was written to meanwhile may not be what was read.
  if (context.verified && before && verdict->same()) context.verified->add(*file, *before);
  output::JsonWriter json;
  json.begin_object()
      .member("same", verdict->same())
      .member("text", verdict->text())
      .member("ticks", verdict->ticks.ticks_compared)
      .member("first_different_s",
              verdict->ticks.first_tick < 0 ? NAN : double(verdict->ticks.first_tick) * reader->start().model.tick);
  return json.end_object().text();
}

Result<std::string> are_comparable(Parameters& parameters, const CallContext& context) {
  const std::string expert = parameters.text("expert"), trainee = parameters.text("trainee");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<recordings::SessionReader> first = open_reader(context, expert), second = open_reader(context, trainee);
  for (const auto* session : {&first, &second})
    if (!*session) return session->errors();
  const Result<Done> same = compare::check_same_scene(*first, *second);
  const std::string text = same ? "" : same.errors()[0].where + " " + same.errors()[0].message;
  output::JsonWriter json;
  json.begin_object().member("comparable", bool(same)).member("text", std::string_view(context.folder.shown(text)));
  return json.end_object().text();
}

Result<std::string> compare_sessions(Parameters& parameters, const CallContext& context) {
  const std::string expert = parameters.text("expert"), trainee = parameters.text("trainee");
  const std::optional<double> force_limit = parameters.number_if("force_limit_n", 1e-6, 1e6);
  const bool only_known = parameters.flag("only_known", false);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> expert_file = context.folder.find(expert), trainee_file = context.folder.find(trainee);
  for (const auto* file : {&expert_file, &trainee_file})
    if (!*file) return file->errors();
  const KeptAnswers::Files read = KeptAnswers::now({*expert_file, *trainee_file});
  Result<compare::OpenedFiles> opened = compare::open_files(*expert_file, *trainee_file);
  if (!opened) return opened.errors();
  compare::CompareFilesOptions options;
  options.force_limit = force_limit, options.progress = context.progress, options.should_stop = context.should_stop;
  if (context.verified) {
    options.is_expert_known = context.verified->holds(*expert_file);
    options.is_trainee_known = context.verified->holds(*trainee_file);
  }
  const std::string question = (force_limit ? output::short_number(*force_limit, 17) : "") +
                               (options.is_expert_known ? " expert known" : "") +
                               (options.is_trainee_known ? " trainee known" : "");
  if (context.comparisons)
    if (const std::optional<std::string> known = context.comparisons->find(question, read)) return *known;
  if (only_known) return std::string("null");
  const Result<compare::ComparedFiles> files = compare::compare_files(std::move(*opened), options);
  if (!files) return files.errors();
  const compare::ComparedSessions compared = files->sessions();
  output::JsonWriter json;
  json.begin_list();
  for (const std::string& remark : compare::remarks_of(compared)) json.value(context.folder.shown(remark));
  json.end_list();
  // Moments of both sessions that belong together, along the path.
  output::JsonWriter path;
  path.begin_list();
  const compare::Comparison& comparison = files->comparison;
  const std::size_t every = std::max<std::size_t>(1, comparison.alignment.pairs.size() / 500);
  for (std::size_t i = 0; i < comparison.alignment.pairs.size(); i += every) {
    const compare::AlignedPair& pair = comparison.alignment.pairs[i];
    path.begin_list().value(comparison.expert_time[pair.a]).value(comparison.trainee_time[pair.b]).end_list();
  }
  path.end_list();
  const std::string answer = "{\"comparison\": " + compare::comparison_json(compared) +
                             ", \"remarks\": " + json.text() + ", \"path_s\": " + path.text() + "}";
  if (context.comparisons) context.comparisons->keep(question, read, answer);
  return answer;
}

}  // namespace ctpm::server
