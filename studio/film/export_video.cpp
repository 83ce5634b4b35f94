#include "studio/film/export_video.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "recordings/byte_hash.h"
#include "studio/film/session_film.h"
#include "studio/film/sidecar.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/render/overlay.h"
#include "studio/render/renderer.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::film {
namespace {

void append(Errors& errors, const Errors& more) { errors.insert(errors.end(), more.begin(), more.end()); }

/// Where a video's sidecar lies: beside the file, or in the folder of pictures.
std::string sidecar_of(const std::string& video) {
  std::error_code ignored;
  const bool is_folder = video.ends_with('/') || std::filesystem::is_directory(video, ignored);
  return is_folder ? (std::filesystem::path(video) / "video.json").string() : video + ".json";
}

Errors check_options(const std::string& path, const ExportOptions& options) {
  Errors errors;
  const bool is_good_rate = options.fps >= 1 && options.fps <= 240;
  if (!is_good_rate)
    errors.push_back(
        {output::option_name("export.fps"), "got " + output::fixed(options.fps, 3) + ", must be in [1, 240]", ""});
  if (!(options.speed >= 0.001 && options.speed <= 1000))
    errors.push_back({output::option_name("export.speed"),
                      "got " + output::fixed(options.speed, 3) + ", must be in [0.001, 1000]", ""});
  // A folder must not exist yet, which the writer checks.
  for (const std::string& file : {path, sidecar_of(path)})
    if (!path.ends_with('/'))
      if (const Result<Done> is_new = output::check_new(file, options.overwrite); !is_new)
        append(errors, is_new.errors());
  append(errors, video::VideoWriter::check(path, options.size.width, options.size.height,
                                           is_good_rate ? options.fps : ExportOptions().fps));
  return errors;
}

/// The ticks of each session that are shown: the same interval of time, up to each session's end.
Result<std::vector<session::TickRange>> find_ranges(const std::vector<recordings::SessionReader*>& sessions,
                                                    const session::TimeRange& range) {
  const auto longer = [](const recordings::SessionReader* a, const recordings::SessionReader* b) {
    return double(a->tick_count()) * a->start().model.tick < double(b->tick_count()) * b->start().model.tick;
  };
  const recordings::SessionReader& longest = **std::max_element(sessions.begin(), sessions.end(), longer);
  const double tick = longest.start().model.tick;
  const Result<session::TickRange> shown = range.in_ticks(longest.path(), tick, longest.tick_count());
  if (!shown) return shown.errors();
  std::vector<session::TickRange> ranges;
  for (const recordings::SessionReader* session : sessions) {
    const auto there = [&](std::int64_t of_longest) {
      const double ticks = double(of_longest) * tick / session->start().model.tick;
      return std::min<std::int64_t>(session->tick_count(), std::llround(ticks));
    };
    ranges.push_back({there(shown->from), there(shown->to)});
  }
  return ranges;
}

/// One session of the film with its replay, renderer and overlay.
struct Reel {
  std::unique_ptr<SessionFilm> film;
  views::Look look;
  std::unique_ptr<render::Renderer> renderer;
  std::unique_ptr<render::Overlay> overlay;
  double ticks_a_frame = 1;

  /// The tick that a frame shows, at most the last one.
  std::int64_t tick_of(std::int64_t frame) const {
    const session::TickRange& range = film->range();
    return std::min<std::int64_t>(range.to, range.from + std::llround(double(frame + 1) * ticks_a_frame));
  }
  /// The shot of a frame. A session that has ended keeps its last State and says so.
  Result<Shot> shoot(std::int64_t frame) const {
    Result<Shot> shot = film->shoot(tick_of(frame));
    if (shot) shot->overlay.is_over = frame >= frame_count();
    return shot;
  }
  std::int64_t frame_count() const {
    return std::int64_t(std::ceil(double(film->range().to - film->range().from) / ticks_a_frame));
  }
};

Result<Reel> make_reel(recordings::SessionReader& session, const session::TickRange& range, int width,
                       const ExportOptions& options) {
  Reel reel;
  Result<std::unique_ptr<SessionFilm>> film = SessionFilm::create(session, range, options.allow_diverged);
  if (!film) return film.errors();
  reel.film = std::move(*film);
  const Model& model = reel.film->model();
  render::SceneView view = views::view_of(reel.film->scene(), model);
  const int height = options.size.height;
  const Result<views::Look> look = views::find_look(options.look, reel.film->scene(), view, double(width) / height);
  if (!look) return look.errors();
  reel.look = *look;
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(width, height, std::move(view));
  if (!renderer) return renderer.errors();
  reel.renderer = std::move(*renderer);
  reel.overlay = std::make_unique<render::Overlay>(width, height);
  reel.ticks_a_frame = options.speed / (options.fps * model.tick);
  return reel;
}

render::Frame draw_shot(Reel& reel, Shot& shot, double least_top_force) {
  const render::DrawOptions draw = reel.look.at(reel.renderer->scene(), shot.moments);
  render::Frame picture = reel.renderer->draw(shot.state, draw);
  shot.overlay.legend = render::legend_of(reel.film->model(), draw);
  shot.overlay.least_top_force = std::max(shot.overlay.least_top_force, least_top_force);
  reel.overlay->draw(picture, shot.overlay);
  return picture;
}

/// All sessions at one moment, side by side; their plots have one scale.
render::Frame draw_shots(std::vector<Reel>& reels, std::vector<Shot>& shots) {
  double top_force = 0;
  for (const Shot& shot : shots) top_force = std::max(top_force, render::largest_force(shot.overlay));
  render::Frame picture = draw_shot(reels[0], shots[0], top_force);
  for (std::size_t i = 1; i < reels.size(); ++i)
    picture = render::join_beside(picture, draw_shot(reels[i], shots[i], top_force));
  return picture;
}

Result<StageTimes> make_film(std::vector<Reel>& reels, video::VideoWriter& writer, recordings::ByteHash& pixels,
                             const ExportOptions& options) {
  std::int64_t frames = 0, drawn = 0;
  for (const Reel& reel : reels) frames = std::max(frames, reel.frame_count());
  FilmWork work;
  for (Reel& reel : reels) work.shoot.push_back([&reel](std::int64_t frame) { return reel.shoot(frame); });
  work.draw = [&](std::vector<Shot> shots) -> Result<render::Frame> {
    // Ctrl-C is an error of this export: nothing is left behind.
    if (options.should_stop && options.should_stop())
      return Error{writer.path(), "stopped before the end; no video was written", ""};
    render::Frame picture = draw_shots(reels, shots);
    if (options.progress) options.progress(++drawn, frames);
    return picture;
  };
  work.encode = [&](const render::Frame& picture) {
    pixels.add(picture.rgb.data(), picture.rgb.size());
    return writer.add(picture);
  };
  return run_film(frames, work);
}

}  // namespace

Result<ExportOutcome> export_video(const std::vector<recordings::SessionReader*>& sessions, const std::string& path,
                                   const ExportOptions& options) {
  Errors errors = check_options(path, options);
  const Result<std::vector<session::TickRange>> ranges = find_ranges(sessions, options.range);
  if (!ranges) append(errors, ranges.errors());
  const int width = options.size.width / int(sessions.size());
  std::vector<Reel> reels;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    Result<Reel> reel = make_reel(*sessions[i], ranges ? (*ranges)[i] : session::TickRange{}, width, options);
    if (reel)
      reels.push_back(std::move(*reel));
    else
      append(errors, reel.errors());
  }
  if (!errors.empty()) return errors;
  Result<std::unique_ptr<video::VideoWriter>> writer =
      video::VideoWriter::create(path, width * int(sessions.size()), options.size.height, options.fps);
  if (!writer) return writer.errors();

  recordings::ByteHash pixels;
  const Result<StageTimes> times = make_film(reels, **writer, pixels, options);
  if (!times) return times.errors();
  const Result<video::VideoFacts> video = (*writer)->finish();
  if (!video) return video.errors();
  ExportOutcome outcome{*video, {}, *times, recordings::hash_text(pixels.value())};
  std::vector<SidecarSession> shown;
  for (const Reel& reel : reels) {
    outcome.sessions.push_back({reel.film->range(), reel.film->first_different_tick()});
    shown.push_back({reel.film.get(), &reel.look});
  }
  const Result<std::string> sidecar =
      sidecar_text(shown, {*video, *times, outcome.pixels_hash, options.speed, reels[0].renderer->opengl()});
  const Result<Done> written =
      sidecar ? output::write_text_file(sidecar_of(video->path), *sidecar) : Result<Done>(sidecar.errors());
  if (written) return outcome;
  std::error_code ignored;
  std::filesystem::remove_all(video->path, ignored);
  return written.errors();
}

}  // namespace ctpm::film
