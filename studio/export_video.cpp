#include "studio/export_video.h"

#include <algorithm>
#include <cmath>

#include "recordings/replay.h"
#include "scenes/scene_file.h"
#include "studio/console.h"
#include "studio/files.h"
#include "studio/json_writer.h"
#include "studio/loaded_scene.h"
#include "studio/render/overlay.h"
#include "studio/render/renderer.h"

namespace ctpm {
namespace {

constexpr std::size_t kPlotPoints = 600;  ///< most points of the running force plot

Errors check_options(const ExportOptions& options) {
  Errors errors;
  if (!(options.fps >= 1 && options.fps <= 240))
    errors.push_back({"--fps", "got " + fixed(options.fps, 3) + ", must be in [1, 240]", ""});
  if (!(options.speed >= 0.001 && options.speed <= 1000))
    errors.push_back({"--speed", "got " + fixed(options.speed, 3) + ", must be in [0.001, 1000]", ""});
  return errors;
}

const char* structure_name(const SceneSpec& scene) {
  if (scene.organs.empty()) return "";
  switch (scene.organs.front().model) {
    case Structure::mass_spring:
      return "mass-spring";
    case Structure::angle_mass_spring:
      return "angle-mass-spring";
    case Structure::tpm:
      return "TPM";
    case Structure::ctpm:
      return "CTPM";
  }
  return "";
}

/// What the overlay says, gathered tick by tick.
class OverlayFeed {
 public:
  OverlayFeed(const SceneSpec& scene, const Model& model) : tick_(model.tick) {
    data_.title = scene.name + " (" + structure_name(scene) + ")";
    for (const OrganRange& organ : model.organs)
      if (organ.damage_depth > 0 && (data_.damage_depth == 0 || organ.damage_depth < data_.damage_depth))
        data_.damage_depth = organ.damage_depth;
    data_.damage_force = damage_force_of(scene);
    every_ = std::max<std::int64_t>(1, std::llround(data_.plot_span / tick_ / double(kPlotPoints)));
  }

  void take(const ReplayCursor& cursor) {
    data_.tick = cursor.tick();
    data_.time = double(cursor.tick()) * tick_;
    data_.force = norm(cursor.report().tool_force);
    data_.depth = cursor.report().depth;
    if (cursor.tick() % every_ == 0) data_.history.push_back({data_.time, data_.force});
    if (data_.history.size() > 2 * kPlotPoints)
      data_.history.erase(data_.history.begin(), data_.history.end() - kPlotPoints - 1);
    if (!cursor.same_so_far() && same_) {
      same_ = false;
      data_.verdict = "replay differs from the recording since " + fixed(data_.time, 3) + " s";
      data_.verdict_tone = VerdictTone::bad;
    } else if (same_) {
      data_.verdict = "replay same as recorded";
      data_.verdict_tone = VerdictTone::good;
    }
  }

  const OverlayData& data() const { return data_; }
  bool same() const { return same_; }

 private:
  double tick_;
  std::int64_t every_ = 1;
  OverlayData data_;
  bool same_ = true;
};

/// Ctrl-C is an error of this export: nothing is left behind.
Error stopped(const std::string& path) { return {path, "stopped before the end; no video was written", ""}; }

std::string sidecar(SessionReader& reader, const ExportOptions& options, const ExportOutcome& outcome) {
  JsonWriter json;
  json.begin_object().member("video", outcome.video.path).member("session", reader.path());
  json.member("session_id", reader.session_id()).member("session_format_version", reader.format_version());
  json.member("recorded_by", reader.start().build_fingerprint).member("exported_by", CTPM_VERSION);
  json.member("verdict", outcome.same_as_recorded ? "same" : "different");
  json.member("first_tick", options.range.from).member("last_tick", options.range.to);
  json.member("frames", outcome.video.frames).member("fps", outcome.video.fps).member("speed", options.speed);
  json.member("codec", outcome.video.codec)
      .member("width", outcome.video.width)
      .member("height", outcome.video.height);
  json.member("camera", options.camera).member("bytes", outcome.video.bytes);
  return json.end_object().text();
}

}  // namespace

Result<ExportOutcome> export_video(SessionReader& reader, const std::string& path,
                                   const ExportOptions& options) {
  if (Errors errors = check_options(options); !errors.empty()) return errors;
  if (Result<Done> writable = check_writable(path); !writable) return writable.errors();
  const Result<SceneText> scene = read_scene(reader.start().scene_text, reader.path() + " (its scene)");
  if (!scene) return scene.errors();
  const Model& model = reader.start().model;
  const auto [width, height] = options.size;
  SceneView view = view_of(scene->spec, model, reader.start().surfaces);
  const Result<Camera> camera = find_camera(scene->spec, view, options.camera, double(width) / height);
  if (!camera) return camera.errors();
  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(width, height, std::move(view));
  if (!renderer) return renderer.errors();
  Result<std::unique_ptr<VideoWriter>> writer = VideoWriter::create(path, width, height, options.fps);
  if (!writer) return writer.errors();
  Result<ReplayCursor> cursor = ReplayCursor::create(reader);
  if (!cursor) return cursor.errors();
  if (const Result<Done> found = cursor->seek(options.range.from); !found) return found.errors();

  Overlay overlay(width, height);
  OverlayFeed feed(scene->spec, model);
  DrawOptions draw;
  draw.camera = *camera;
  const double ticks_a_frame = options.speed / (options.fps * model.tick);
  const auto frames = std::int64_t(std::ceil(double(options.range.to - options.range.from) / ticks_a_frame));
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    if (options.should_stop && options.should_stop()) return stopped(path);
    const auto shown = std::min<std::int64_t>(
        options.range.to, options.range.from + std::llround(double(frame + 1) * ticks_a_frame));
    while (cursor->tick() < shown) {
      if (const Result<bool> went_on = cursor->step(); !went_on) return went_on.errors();
      feed.take(*cursor);
    }
    if (!feed.same() && !options.allow_diverged)
      return Error{
          reader.path(), "the " + feed.data().verdict + "; no video was written",
          "ctpm verify names what differs; --allow-diverged exports all the same and says so on every frame"};
    Frame picture = (*renderer)->draw(cursor->state(), draw);
    overlay.draw(picture, feed.data());
    if (const Result<Done> added = (*writer)->add(picture); !added) return added.errors();
    if (options.progress) options.progress(frame + 1, frames);
  }
  const Result<VideoFacts> video = (*writer)->finish();
  if (!video) return video.errors();
  const ExportOutcome outcome{*video, feed.same()};
  if (const Result<Done> written = write_text_file(video->path + ".json", sidecar(reader, options, outcome));
      !written)
    return written.errors();
  return outcome;
}

}  // namespace ctpm
