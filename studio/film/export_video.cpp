#include "studio/film/export_video.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "recordings/byte_hash.h"
#include "studio/film/captions.h"
#include "studio/film/schedule.h"
#include "studio/film/session_film.h"
#include "studio/film/sidecar.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/render/element_values.h"
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

std::optional<render::OverlayLevel> level_of(const std::string& name) {
  if (name == "none") return render::OverlayLevel::none;
  if (name == "small") return render::OverlayLevel::small;
  if (name == "full") return render::OverlayLevel::full;
  return std::nullopt;
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
  if (!level_of(options.overlay))
    errors.push_back(
        {output::option_name("export.overlay"), "got '" + options.overlay + "', must be none, small or full", ""});
  // A folder must not exist yet, which the writer checks.
  for (const std::string& file : {path, sidecar_of(path)})
    if (!path.ends_with('/'))
      if (const Result<Done> is_new = output::check_new(file, options.overwrite); !is_new)
        append(errors, is_new.errors());
  append(errors, video::VideoWriter::check(path, options.size.width, options.size.height,
                                           is_good_rate ? options.fps : ExportOptions().fps));
  return errors;
}

/// One session of the film with its replay, renderer and overlay.
struct Reel {
  std::unique_ptr<SessionFilm> film;
  views::Look look;
  std::unique_ptr<render::Renderer> renderer;
  std::unique_ptr<render::Overlay> overlay;
  FrameTicks ticks;
  std::vector<Moment> moments;
  std::int64_t told = 0;    ///< ticks for which a moment's words are shown
  double speed = 1;         ///< of the film
  bool shows_pace = false;  ///< where it is not that of the clock
  render::OverlayLevel level = render::OverlayLevel::full;

  /// The shot of a frame. A session that has ended keeps its last State and says so.
  Result<Shot> shoot(std::int64_t frame) const {
    Result<Shot> shot = film->shoot(ticks.tick(frame));
    if (!shot) return shot;
    shot->overlay.level = level;
    shot->overlay.caption = words_at(moments, ticks.tick(frame), told);
    shot->overlay.is_over = frame >= ticks.ended;
    if (shows_pace) shot->overlay.pace = shot->overlay.is_over ? 0 : speed * ticks.share(frame);
    return shot;
  }
};

/// The largest element values of a session [1, rad or N], but for a few, rounded up: the range of their colours. From
/// keyframes of the whole session, so that a part has the colours of the whole.
Result<double> range_of(recordings::SessionReader& session, render::ElementQuantity quantity) {
  constexpr std::size_t kMoments = 12;
  constexpr double kShown = 0.995;  // of the elements of a moment
  const Result<std::vector<std::int64_t>> keyframes = session.keyframe_ticks();
  if (!keyframes) return keyframes.errors();
  const std::size_t every = std::max<std::size_t>(1, keyframes->size() / kMoments);
  double largest = 0;
  std::vector<render::ElementValue> values;
  for (std::size_t i = 0; i < keyframes->size(); i += every) {
    const Result<recordings::Keyframe> keyframe = session.keyframe_at_or_before((*keyframes)[i]);
    if (!keyframe) return keyframe.errors();
    render::measure_elements(session.start().model, keyframe->state, quantity, values);
    if (values.empty()) continue;
    const auto shown = values.begin() + std::ptrdiff_t(kShown * double(values.size() - 1));
    std::nth_element(values.begin(), shown, values.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.value) < std::abs(b.value); });
    largest = std::max(largest, std::abs(shown->value));
  }
  return largest;
}

/// Of all halves the same range of colours, unless one is given.
Result<Done> find_ranges(std::vector<Reel>& reels, const std::vector<recordings::SessionReader*>& sessions) {
  render::DrawOptions& first = reels[0].look.draw;
  if (first.view != render::View::elements || first.full_scale > 0) return Done{};
  double largest = 0;
  for (recordings::SessionReader* session : sessions) {
    const Result<double> found = range_of(*session, first.quantity);
    if (!found) return found.errors();
    largest = std::max(largest, *found);
  }
  // In the legend's unit, so that its numbers are round.
  const double unit = views::unit_of(first.quantity);
  for (Reel& reel : reels)
    if (largest > 0) reel.look.draw.full_scale = unit * render::round_up(largest / unit);
  return Done{};
}

Result<Reel> make_reel(recordings::SessionReader& session, FrameTicks ticks, int width, const ExportOptions& options) {
  Reel reel;
  const Result<std::vector<Moment>> all = all_moments(session);
  if (!all) return all.errors();
  Result<std::unique_ptr<SessionFilm>> film = SessionFilm::create(session, ticks.range, options.allow_diverged);
  if (!film) return film.errors();
  reel.film = std::move(*film);
  const Model& model = reel.film->model();
  render::SceneView view = views::view_of(reel.film->scene(), model);
  const int height = options.size.height;
  // The last keyframe of the session, so that a part is seen as the whole is.
  const Result<recordings::Keyframe> late = session.keyframe_at_or_before(session.tick_count());
  if (!late) return late.errors();
  const Result<views::Look> look =
      views::find_look(options.look, reel.film->scene(), view, double(width) / height, &late->state);
  if (!look) return look.errors();
  reel.look = *look;
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(width, height, std::move(view));
  if (!renderer) return renderer.errors();
  reel.renderer = std::move(*renderer);
  reel.overlay = std::make_unique<render::Overlay>(width, height);
  const std::string title = reel.film->scene().name + ": " + std::filesystem::path(session.path()).stem().string();
  reel.moments = told_moments(*all, title, model.tick),
  reel.told = std::llround(kCaptionSeconds * options.speed / model.tick);
  reel.ticks = std::move(ticks), reel.speed = options.speed,
  reel.shows_pace = options.speed != 1 || !options.matched.empty() || !options.slow_at.empty();
  reel.level = level_of(options.overlay).value_or(reel.level);
  return reel;
}

/// The parts that are shown slower; empty words: none.
Result<std::vector<std::array<double, 2>>> slow_parts_of(const std::vector<recordings::SessionReader*>& sessions,
                                                         const std::string& words) {
  if (words.empty()) return std::vector<std::array<double, 2>>();
  if (sessions.size() > 1)
    return Error{output::option_name("export.slow_at"), "is for one session", "two are slowed down to be matched"};
  const Result<std::vector<Moment>> all = all_moments(*sessions[0]);
  if (!all) return all.errors();
  return slow_parts(*all, words, sessions[0]->start().model.tick);
}

/// Of one scene all halves are seen as the first one is, wherever their wounds are.
void look_alike(std::vector<Reel>& reels) {
  const auto box = [](const Reel& reel) { return render::rest_bounds(reel.renderer->scene()); };
  for (std::size_t i = 1; i < reels.size(); ++i)
    if (box(reels[i]).min == box(reels[0]).min && box(reels[i]).max == box(reels[0]).max) reels[i].look = reels[0].look;
}

render::Frame draw_shot(Reel& reel, Shot& shot, double top_force) {
  const render::DrawOptions draw = reel.look.at(reel.renderer->scene(), shot.moments);
  render::Frame picture = reel.renderer->draw(shot.state, draw);
  shot.overlay.tools = reel.renderer->tool_points(shot.state, draw);
  shot.overlay.legend = render::legend_of(reel.film->model(), draw);
  shot.overlay.least_top_force = std::max(shot.overlay.least_top_force, top_force);
  reel.overlay->draw(picture, shot.overlay);
  return picture;
}

/// All sessions at one moment, side by side; their plots have one scale.
render::Frame draw_shots(std::vector<Reel>& reels, std::vector<Shot>& shots, double top_force) {
  render::Frame picture = draw_shot(reels[0], shots[0], top_force);
  for (std::size_t i = 1; i < reels.size(); ++i)
    picture = render::join_beside(picture, draw_shot(reels[i], shots[i], top_force));
  return picture;
}

/// The largest force of whole sessions: a plot whose axis ends there stands still, whatever part is shown.
Result<double> largest_force(const std::vector<recordings::SessionReader*>& sessions) {
  double largest = 0;
  for (recordings::SessionReader* session : sessions) {
    const Result<recordings::SessionStatistics> statistics = session->statistics();
    if (!statistics) return statistics.errors();
    largest = std::max(largest, statistics->max_force);
  }
  return largest;
}

Result<StageTimes> make_film(std::vector<Reel>& reels, video::VideoWriter& writer, recordings::ByteHash& pixels,
                             double top_force, const ExportOptions& options) {
  const std::int64_t frames = reels[0].ticks.frame_count;
  std::int64_t drawn = 0;
  FilmWork work;
  for (Reel& reel : reels) work.shoot.push_back([&reel](std::int64_t frame) { return reel.shoot(frame); });
  work.draw = [&](std::vector<Shot> shots) -> Result<render::Frame> {
    // Ctrl-C is an error of this export: nothing is left behind.
    if (options.should_stop && options.should_stop())
      return Error{writer.path(), "stopped before the end; no video was written", ""};
    render::Frame picture = draw_shots(reels, shots, top_force);
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
  const double frame_s = errors.empty() ? options.speed / options.fps : 1;
  const Result<std::vector<std::array<double, 2>>> slow = slow_parts_of(sessions, options.slow_at);
  if (!slow) append(errors, slow.errors());
  Result<std::vector<FrameTicks>> ticks = schedule(
      sessions, {options.range, frame_s, options.matched, slow ? *slow : std::vector<std::array<double, 2>>()});
  if (!ticks) append(errors, ticks.errors());
  const Result<double> top_force = largest_force(sessions);
  if (!top_force) append(errors, top_force.errors());
  const int width = options.size.width / int(sessions.size());
  std::vector<Reel> reels;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    Result<Reel> reel = make_reel(*sessions[i], ticks ? std::move((*ticks)[i]) : FrameTicks{}, width, options);
    if (reel)
      reels.push_back(std::move(*reel));
    else
      append(errors, reel.errors());
  }
  if (!errors.empty()) return errors;
  look_alike(reels);
  if (const Result<Done> found = find_ranges(reels, sessions); !found) return found.errors();
  Result<std::unique_ptr<video::VideoWriter>> writer =
      video::VideoWriter::create(path, width * int(sessions.size()), options.size.height, options.fps);
  if (!writer) return writer.errors();

  recordings::ByteHash pixels;
  const Result<StageTimes> times = make_film(reels, **writer, pixels, *top_force, options);
  if (!times) return times.errors();
  // Two halves have their words in the picture; the track tells of the first.
  const Reel& first = reels[0];
  const Result<video::VideoFacts> video =
      (*writer)->finish(captions_of(first.moments, first.ticks, first.told, options.fps));
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
