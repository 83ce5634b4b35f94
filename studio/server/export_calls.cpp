#include <filesystem>

#include "recordings/session_reader.h"
#include "studio/compare/matched_moments.h"
#include "studio/compare/session_track.h"
#include "studio/film/expert_cut_of.h"
#include "studio/film/export_video.h"
#include "studio/film/sidecar.h"
#include "studio/film/stills.h"
#include "studio/output/json_writer.h"
#include "studio/server/call_table.h"
#include "studio/server/scene_text.h"

namespace ctpm::server {

namespace {

constexpr int kMostSide = 4096;  ///< of a drawing, which is sent as it is [pixels]

views::LookRequest look_of(Parameters& parameters) {
  views::LookRequest look;
  look.view = parameters.text_if("view").value_or(look.view);
  look.by = parameters.text_if("by").value_or("");
  look.cutaway = parameters.text_if("cutaway").value_or("");
  look.camera = parameters.text_if("camera").value_or("");
  return look;
}

/// What the picture of a film or of a moment is to be like.
Result<Done> read_picture(Parameters& parameters, film::ExportOptions& options) {
  const std::string size = parameters.text_if("size").value_or("1280x720");
  options.look = look_of(parameters);
  options.caption = parameters.text_if("caption").value_or("");
  options.overlay = parameters.text_if("overlay").value_or(options.overlay);
  options.allow_diverged = parameters.flag("allow_diverged", false);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<render::PictureSize> parsed = render::parse_picture_size(size);
  if (!parsed) return parsed.errors();
  options.size = *parsed;
  return Done{};
}

/// Sessions of which a film or a picture is made.
struct Filmed {
  std::vector<recordings::SessionReader> readers;
  std::vector<recordings::SessionReader*> sessions;  ///< of them, those that stand side by side
  std::string note;                                  ///< what is left out; empty: nothing
};

/// A session, and another one beside it or as its ghost.
struct Pair {
  std::string path, beside, ghost, align;
  bool has_expert_line;
};

Pair read_pair(Parameters& parameters) {
  Pair pair{parameters.text("path"), parameters.text_if("beside").value_or(""),
            parameters.text_if("ghost").value_or(""), parameters.text_if("align").value_or(""),
            parameters.flag("expert_line", true)};
  if (!pair.beside.empty() && !pair.ghost.empty())
    parameters.refuse("ghost", "a session has another one beside it or a ghost");
  return pair;
}

/// Opens them, and writes to `options` what brings both together.
Result<Filmed> open_pair(const Pair& pair, const CallContext& context, film::ExportOptions& options) {
  const auto& [path, beside, ghost, align, has_expert_line] = pair;
  Filmed filmed;
  for (const std::string& name : {path, beside, ghost}) {
    if (name.empty()) continue;
    Result<recordings::SessionReader> reader = open_reader(context, name);
    if (!reader) return reader.errors();
    filmed.readers.push_back(std::move(*reader));
  }
  std::vector<recordings::SessionReader*>& sessions = filmed.sessions;
  for (recordings::SessionReader& reader : filmed.readers) sessions.push_back(&reader);
  if (sessions.size() < 2) return filmed;
  Result<compare::MatchedMoments> matched = compare::match_sessions(*sessions[0], *sessions[1], align);
  if (!matched) return matched.errors();
  options.matched = std::move(*matched);
  const Result<Done> same = compare::check_same_scene(*sessions[0], *sessions[1]);
  if (!same && !ghost.empty()) return same.errors();
  const Result<Done> line = film::pair_up(sessions, !ghost.empty(), same && has_expert_line, options);
  if (!line) filmed.note = "without the line of the expert's cut: " + to_string(line.errors()[0]);
  return filmed;
}

/// What lies where that video or its sidecar would be written; empty: nothing.
std::string in_the_way_of(const std::string& video) {
  std::error_code ignored;
  for (const std::string& file : {video, film::sidecar_of(video)})
    if (std::filesystem::exists(file, ignored)) return file;
  return "";
}

}  // namespace

/// A stage is drawn as a video of it would be; without a size by the page, which is told how.
Result<std::string> draw_session(Parameters& parameters, const CallContext& context) {
  const std::uint32_t stage = std::uint32_t(parameters.number("stage", 0, Desk::kMostStages - 1));
  const std::optional<std::string> size = parameters.text_if("size");
  const std::optional<std::string> expert = parameters.text_if("expert");
  DrawingRequest request{look_of(parameters), {}};
  if (!context.desk) parameters.refuse("stage", "only a page with a WebSocket has stages");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  if (size) {
    const Result<render::PictureSize> parsed = render::parse_picture_size(*size);
    if (!parsed) return parsed.errors();
    if (parsed->width > kMostSide || parsed->height > kMostSide)
      return Error{"size", "got " + *size + ", a page's drawings have at most " + std::to_string(kMostSide) + " a side",
                   ""};
    request.size = *parsed;
  }
  if (expert) {
    const Result<std::string> file = context.folder.find(*expert);
    if (!file) return file.errors();
    request.expert = *file;
  }
  const Result<DrawingPlan> plan = context.desk->draw_as(stage, request);
  if (!plan) return plan.errors();
  const render::Legend& legend = plan->legend;
  output::JsonWriter json;
  json.begin_object().member("title", std::string_view(legend.title)).member("low", std::string_view(legend.low));
  json.member("high", std::string_view(legend.high)).key("colours").begin_list();
  for (const render::Colour& colour : legend.colours) write_vector(json, {colour[0], colour[1], colour[2]});
  json.end_list().key("camera"), write_camera(json, plan->look.camera, plan->look.draw.camera);
  return json.end_object().text();
}

/// A name that is taken gets a number.
Result<std::string> name_export(Parameters& parameters, const CallContext& context) {
  const std::string wanted = parameters.text("path");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> name =
      context.folder.free_name(wanted, [](const std::string& place) { return !in_the_way_of(place).empty(); });
  if (!name) return name.errors();
  return "{\"path\": " + json_text(*name) + "}";
}

/// The picture of a moment, as `export --at-s` draws it.
Result<std::string> export_moment(Parameters& parameters, const CallContext& context) {
  const Pair pair = read_pair(parameters);
  const std::string output = parameters.text("output");
  const double at = parameters.number("at_s", 0, 1e9);
  film::ExportOptions options;
  if (!output.empty() && !output.ends_with(".png")) parameters.refuse("output", "the picture of a moment is a .png");
  if (const Result<Done> read = read_picture(parameters, options); !read) return read.errors();
  const Result<std::string> place = context.folder.place(output);
  if (!place) return place.errors();
  const Result<Filmed> filmed = open_pair(pair, context, options);
  if (!filmed) return filmed.errors();
  const Result<Done> written = film::write_still(filmed->sessions, *place, at, options);
  if (!written) return written.errors();
  if (context.films) context.films->add(*place);
  output::JsonWriter json;
  json.begin_object().member("path", std::string_view(output)).member("note", std::string_view(filmed->note));
  return json.end_object().text();
}

Result<std::string> export_session(Parameters& parameters, const CallContext& context) {
  const Pair pair = read_pair(parameters);
  const std::string output = parameters.text("output");
  film::ExportOptions options;
  options.fps = parameters.number_if("fps", 1, 240).value_or(options.fps);
  options.speed = parameters.number_if("speed", 0.001, 1000).value_or(options.speed);
  options.range.from_s = parameters.number_if("from_s", 0, 1e9).value_or(0);
  options.range.to_s = parameters.number_if("to_s", 0, 1e9);
  options.slow_at = parameters.text_if("slow_at").value_or("");
  if (const Result<Done> read = read_picture(parameters, options); !read) return read.errors();
  const Result<std::string> place = context.folder.place(output);
  if (!place) return place.errors();
  if (const std::string file = in_the_way_of(*place); !file.empty())
    return Error{file, "exists already", "choose another name"};
  const Result<Filmed> filmed = open_pair(pair, context, options);
  if (!filmed) return filmed.errors();
  const std::string& note = filmed->note;
  options.progress = context.progress;
  options.should_stop = context.should_stop;
  const Result<film::ExportOutcome> outcome = film::export_video(filmed->sessions, *place, options);
  if (!outcome) return outcome.errors();
  if (context.films) context.films->add(*place);
  output::JsonWriter json;
  json.begin_object()
      .member("path", std::string_view(output))
      .member("frames", outcome->video.frames)
      .member("bytes", std::int64_t(outcome->video.bytes))
      .member("codec", outcome->video.codec)
      .member("same_as_recorded", outcome->same_as_recorded())
      .member("elapsed_s", outcome->times.elapsed)
      .member("note", outcome->video.note + (outcome->video.note.empty() || note.empty() ? "" : "; ") + note)
      .end_object();
  return json.text();
}

}  // namespace ctpm::server
