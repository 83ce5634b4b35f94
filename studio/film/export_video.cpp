#include "studio/film/export_video.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "core/model/errors.h"
#include "recordings/byte_hash.h"
#include "studio/film/captions.h"
#include "studio/film/reel.h"
#include "studio/film/schedule.h"
#include "studio/film/session_film.h"
#include "studio/film/sidecar.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/render/cut_surface.h"

namespace ctpm::film {
namespace {

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
  if (options.caption.size() > kLongestCaption)
    errors.push_back({output::option_name("export.caption"),
                      "has " + std::to_string(options.caption.size()) + " bytes, at most " +
                          std::to_string(kLongestCaption) + " are shown",
                      "say it in fewer words"});
  // A folder must not exist yet, which the writer checks. What is wrong with both places is said once.
  for (const std::string& file : {path, sidecar_of(path)})
    if (!path.ends_with('/'))
      if (const Result<Done> is_new = output::check_new(file, options.overwrite); !is_new) {
        append(errors, is_new);
        break;
      }
  for (Error& error : video::VideoWriter::check(path, options.size.width, options.size.height,
                                                is_good_rate ? options.fps : ExportOptions().fps))
    if (std::ranges::find(errors, error) == errors.end()) errors.push_back(std::move(error));
  return errors;
}

/// The parts that are shown slower; empty words: none.
Result<std::vector<std::array<double, 2>>> slow_parts_of(const std::vector<recordings::SessionReader*>& sessions,
                                                         const std::string& words) {
  if (words.empty()) return std::vector<std::array<double, 2>>();
  if (sessions.size() > 1)
    return Error{output::option_name("export.slow_at"), "is for one session", "two are slowed down to be matched"};
  const Result<std::vector<Moment>> all = all_moments(*sessions[0], {0, sessions[0]->tick_count()});
  if (!all) return all.errors();
  return slow_parts(*all, words, sessions[0]->start().model.tick);
}

/// What the track says: of a pair, of which half it is true.
std::vector<video::Caption> captions_of_all(const std::vector<Reel>& reels, double fps) {
  std::vector<std::vector<video::Caption>> all;
  for (const Reel& reel : reels)
    all.push_back(reel.caption.empty()
                      ? captions_of(reel.moments, reel.ticks, reel.told, fps)
                      : std::vector{video::Caption{0, double(reel.ticks.frame_count) / fps, reel.caption}});
  if (all.size() == 1) return all[0];
  return captions_of_pair(all[0], all[1], {name_of(reels[0].film->reader()), name_of(reels[1].film->reader())});
}

Result<StageTimes> make_film(std::vector<Reel>& reels, video::VideoWriter& writer, recordings::ByteHash& pixels,
                             double top_force, const ExportOptions& options) {
  const std::int64_t frames = reels[0].ticks.frame_count;
  std::int64_t drawn = 0;
  FilmWork work;
  for (Reel& reel : reels)
    work.shoot.push_back([&reel](std::int64_t frame) {
      Result<Shot> shot = reel.shoot(frame);
      for (render::CutSurface& cut : *reel.renderer->scene().cuts)
        if (shot) cut.follow_ahead(shot->state);
      return shot;
    });
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
  const std::vector<recordings::SessionReader*> in_step = in_step_with(sessions, options);
  const Result<std::vector<std::array<double, 2>>> slow = slow_parts_of(in_step, options.slow_at);
  append(errors, slow);
  Result<std::vector<FrameTicks>> ticks =
      schedule(in_step, {options.range, frame_s, options.matched, slow ? *slow : std::vector<std::array<double, 2>>()});
  append(errors, ticks);
  Result<std::vector<Reel>> made =
      make_reels(sessions, ticks ? std::move(*ticks) : std::vector<FrameTicks>(in_step.size()), options);
  append(errors, made);
  if (!errors.empty()) return errors;
  std::vector<Reel>& reels = *made;
  const int width = options.size.width / int(sessions.size()) * int(sessions.size());
  Result<std::unique_ptr<video::VideoWriter>> writer =
      video::VideoWriter::create(path, width, options.size.height, options.fps);
  if (!writer) return writer.errors();

  recordings::ByteHash pixels;
  const Result<StageTimes> times = make_film(reels, **writer, pixels, largest_force(sessions), options);
  if (!times) return times.errors();
  const Result<video::VideoFacts> video = (*writer)->finish(captions_of_all(reels, options.fps));
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
