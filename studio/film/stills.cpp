#include "studio/film/stills.h"

#include <algorithm>
#include <utility>

#include "studio/film/reel.h"
#include "studio/output/files.h"

namespace ctpm::film {
namespace {

constexpr double kLetters = 1.4;  // of captions, times those of a film of that size

FrameTicks ticks_of(const std::vector<std::int64_t>& ticks) {
  const auto count = std::int64_t(ticks.size());
  const std::int64_t first = std::max<std::int64_t>(0, ticks.front() - 1);
  return {{first, ticks.back()},
          count,
          0,
          count,
          [ticks](std::int64_t frame) { return ticks[std::size_t(frame)]; },
          [](std::int64_t) { return 1.0; }};
}

/// The reel of one of the sessions, seen like `first`.
Result<Reel> reel_of(const std::vector<recordings::SessionReader*>& sessions, std::size_t number,
                     const std::vector<std::int64_t>& ticks, const std::optional<Seen>& first,
                     const ExportOptions& options) {
  Result<Reel> reel = make_reel(*sessions[number], ticks_of(ticks), options.size, options, first, Between::left_out);
  if (!reel) return reel;
  if (const Result<Done> alike = colour_alike({&*reel, 1}, sessions); !alike) return alike.errors();
  return reel;
}

}  // namespace

Result<std::vector<std::vector<render::Frame>>> draw_stills(const std::vector<recordings::SessionReader*>& sessions,
                                                            const std::vector<StillsRequest>& requests,
                                                            const StillCaption& caption, const ExportOptions& options) {
  ExportOptions bare = options;  // nothing but a caption stands in a still: no room is made for panels
  bare.overlay = "none";
  std::int64_t done = 0, total = 0;
  for (const StillsRequest& request : requests) total += std::int64_t(request.ticks.size());
  std::vector<std::vector<render::Frame>> stills(sessions.size());
  std::optional<Seen> first;
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    // One after the other, because each takes much memory.
    Result<Reel> made = reel_of(sessions, s, requests[s].ticks, first, bare);
    if (!made) return made.errors();
    Reel& reel = *made;
    if (!first) first = seen_in(reel);
    reel.overlay = std::make_unique<render::Overlay>(options.size.width, options.size.height, kLetters);
    reel.level = render::OverlayLevel::caption;
    for (std::size_t i = 0; i < requests[s].ticks.size(); ++i) {
      if (options.should_stop && options.should_stop()) return Error{sessions[s]->path(), "stopped before the end", ""};
      Result<Shot> shot = reel.shoot(std::int64_t(i));
      if (!shot) return shot.errors();
      const std::int64_t tick = requests[s].ticks[i];
      shot->overlay.caption = caption(
          tick, requests[s].since.empty() ? "" : words_between(reel.moments, tick - requests[s].since[i], tick));
      stills[s].push_back(draw_shot(reel, *shot, 0));
      if (options.progress) options.progress(++done, total);
    }
  }
  return stills;
}

Result<Done> write_still(const std::vector<recordings::SessionReader*>& sessions, const std::string& path, double at_s,
                         const ExportOptions& options) {
  if (const Result<Done> is_new = output::check_new(path, options.overwrite); !is_new) return is_new.errors();
  Result<std::vector<FrameTicks>> ticks = schedule_moment(in_step_with(sessions, options), at_s, options.matched);
  if (!ticks) return ticks.errors();
  Result<std::vector<Reel>> reels = make_reels(sessions, std::move(*ticks), options, Between::left_out);
  if (!reels) return reels.errors();
  std::vector<Shot> shots;
  for (Reel& reel : *reels) {
    Result<Shot> shot = reel.shoot(0);
    if (!shot) return shot.errors();
    shots.push_back(std::move(*shot));
  }
  return render::write_png(path, draw_shots(*reels, shots, largest_force(sessions)));
}

}  // namespace ctpm::film
