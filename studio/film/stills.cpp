#include "studio/film/stills.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studio/film/reel.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::film {
namespace {

constexpr double kLetters = 1.4;  // of captions, times those of a film of that size

FrameTicks ticks_of(const std::vector<std::int64_t>& ticks) {
  const auto count = std::int64_t(ticks.size());
  const std::int64_t first = std::max<std::int64_t>(0, ticks.front() - 1);
  return {{first, ticks.back()},
          count,
          count,
          [ticks](std::int64_t frame) { return ticks[std::size_t(frame)]; },
          [](std::int64_t) { return 1.0; }};
}

/// One for each session, seen alike as in a film of them.
Result<std::vector<Reel>> reels_of(const std::vector<recordings::SessionReader*>& sessions,
                                   const std::vector<StillsRequest>& requests, const ExportOptions& options) {
  std::vector<Reel> reels;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    Result<Reel> reel = make_reel(*sessions[i], ticks_of(requests[i].ticks), options.size, options,
                                  reels.empty() ? nullptr : reels.data(), Between::left_out);
    if (!reel) return reel.errors();
    reels.push_back(std::move(*reel));
  }
  if (const Result<Done> alike = colour_alike(reels, sessions); !alike) return alike.errors();
  return reels;
}

}  // namespace

Result<std::vector<std::vector<render::Frame>>> draw_stills(const std::vector<recordings::SessionReader*>& sessions,
                                                            const std::vector<StillsRequest>& requests,
                                                            const StillCaption& caption, const ExportOptions& options) {
  Result<std::vector<Reel>> reels = reels_of(sessions, requests, options);
  if (!reels) return reels.errors();
  std::int64_t done = 0, total = 0;
  for (const StillsRequest& request : requests) total += std::int64_t(request.ticks.size());
  std::vector<std::vector<render::Frame>> stills(sessions.size());
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    Reel& reel = (*reels)[s];
    reel.overlay = std::make_unique<render::Overlay>(options.size.width, options.size.height, kLetters);
    reel.level = render::OverlayLevel::caption;
    for (std::size_t i = 0; i < requests[s].ticks.size(); ++i) {
      if (options.should_stop && options.should_stop()) return Error{sessions[s]->path(), "stopped before the end", ""};
      Result<Shot> shot = reel.shoot(std::int64_t(i));
      if (!shot) return shot.errors();
      const std::int64_t tick = requests[s].ticks[i];
      shot->overlay.caption =
          caption(tick, requests[s].since.empty() ? "" : words_at(reel.moments, tick, requests[s].since[i] - 1));
      stills[s].push_back(draw_shot(reel, *shot, 0));
      if (options.progress) options.progress(++done, total);
    }
  }
  return stills;
}

Result<Done> write_still(recordings::SessionReader& session, const std::string& path, double at_s,
                         const ExportOptions& options) {
  if (const Result<Done> is_new = output::check_new(path, options.overwrite); !is_new) return is_new.errors();
  const double tick = session.start().model.tick;
  const std::int64_t at = std::llround(at_s / tick);
  if (!(at_s >= 0) || at > session.tick_count())
    return Error{output::option_name("export.at_s"),
                 "got " + output::short_number(at_s) + ", must be in [0, " +
                     output::short_number(double(session.tick_count()) * tick) + "] s, as " + session.path() + " is",
                 ""};
  Result<std::vector<Reel>> reels = reels_of({&session}, {{{at}, {}}}, options);
  if (!reels) return reels.errors();
  Result<Shot> shot = (*reels)[0].shoot(0);
  if (!shot) return shot.errors();

  return render::write_png(path, draw_shot((*reels)[0], *shot, largest_force({&session})));
}

}  // namespace ctpm::film
