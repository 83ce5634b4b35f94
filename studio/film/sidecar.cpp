#include "studio/film/sidecar.h"

#include <filesystem>

#include "recordings/byte_hash.h"
#include "studio/output/json_writer.h"
#include "studio/version/version.h"

namespace ctpm::film {
namespace {

/// The name of a view in LookRequest::view.
const char* name_of(render::View view) {
  switch (view) {
    case render::View::surface:
      return "surface";
    case render::View::spheres:
      return "spheres";
    case render::View::both:
      return "both";
    case render::View::elements:
      return "elements";
  }
  return "";
}

void write_point(output::JsonWriter& json, const char* key, Vec3 p, double scale) {
  json.key(key).begin_list();
  for (const double x : {p.x, p.y, p.z}) json.value(scale * x);
  json.end_list();
}

Result<Done> write_session(output::JsonWriter& json, const SidecarSession& session) {
  const SessionFilm& film = *session.film;
  const recordings::SessionReader& reader = film.reader();
  const Result<std::uint64_t> hash = recordings::file_hash(reader.path());
  if (!hash) return hash.errors();
  const double tick = film.model().tick;
  json.begin_object().member("file", std::filesystem::path(reader.path()).filename().string());
  json.member("session_id", reader.session_id()).member("file_xxh3", recordings::hash_text(*hash));
  json.member("format_version", reader.format_version()).member("recorded_by", reader.start().build_fingerprint);
  const std::int32_t revision = reader.start().physics_revision;
  json.member("physics_revision", revision).member("physics_remark", recordings::physics_remark(revision));
  json.member("scene", film.scene().name).member("model", structure_name(film.scene()));
  json.member("verdict", film.is_same() ? "same" : "different");
  json.key("first_different_tick");
  if (film.is_same())
    json.null();
  else
    json.value(film.first_different_tick());
  json.member("tick_s", tick).member("first_tick", film.range().from).member("last_tick", film.range().to);
  json.member("from_s", double(film.range().from) * tick).member("to_s", double(film.range().to) * tick);
  json.member("pieces_came_loose", film.pieces_loose());
  json.member("cells_inside_out_at_end", film.cells_inside_out());
  const render::DrawOptions& draw = session.look->draw;
  json.key("camera").begin_object().member("name", session.look->camera);
  json.member("follows_tool", session.look->follows);
  write_point(json, "eye_mm", draw.camera.eye, 1000), write_point(json, "target_mm", draw.camera.target, 1000);
  json.member("field_of_view_deg", draw.camera.fov_deg).end_object();
  if (draw.cutaway.is_on()) {
    json.key("cutaway").begin_object();
    write_point(json, "point_mm", draw.cutaway.point, 1000);
    write_point(json, "leaves_out_towards", draw.cutaway.normal, 1);
    json.end_object();
  }
  json.end_object();
  return Done{};
}

}  // namespace

std::string sidecar_of(const std::string& video) {
  std::error_code ignored;
  const bool is_folder = video.ends_with('/') || std::filesystem::is_directory(video, ignored);
  return is_folder ? (std::filesystem::path(video) / "video.json").string() : video + ".json";
}

Result<std::string> sidecar_text(const std::vector<SidecarSession>& sessions, const SidecarFacts& facts) {
  const video::VideoFacts& video = facts.video;
  output::JsonWriter json;
  json.begin_object().member("format", "ctpm-video").member("version", 1);
  json.key("video").begin_object().member("file", std::filesystem::path(video.path).filename().string());
  json.member("codec", video.codec).member("note", video.note).member("frames", video.frames);
  json.member("fps", video.fps).member("width", video.width).member("height", video.height);
  json.member("bytes", video.bytes).member("pixels_xxh3", facts.pixels_hash);
  json.member("speed", facts.speed).member("view", name_of(sessions.at(0).look->draw.view));
  const render::Legend legend = render::legend_of(sessions[0].film->model(), sessions[0].look->draw);
  if (!legend.title.empty())
    json.member("colours", legend.title).member("first_colour", legend.low).member("last_colour", legend.high);
  json.end_object();
  json.key("sessions").begin_list();
  for (const SidecarSession& session : sessions)
    if (const Result<Done> done = write_session(json, session); !done) return done.errors();
  json.end_list();
  json.key("made_by").begin_object().member("program", version::build_fingerprint());
  json.member("physics_revision", kPhysicsRevision);
  json.member("drawing", facts.opengl).member("video", video::video_library()).end_object();
  const StageTimes& times = facts.times;
  json.key("times").begin_object().member("elapsed_s", times.elapsed);
  json.member("simulation_s", times.simulation).member("rendering_s", times.rendering);
  json.member("encoding_s", times.encoding).member("video_s", double(video.frames) / video.fps).end_object();
  return json.end_object().text();
}

}  // namespace ctpm::film
